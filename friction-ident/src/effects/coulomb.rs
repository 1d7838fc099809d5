//! Coulomb friction: a level that does not depend on speed, with true stick at rest.

use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::simd::add_to;

/// `F_C s`.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb;

static ABOUT: About = About {
    name: "coulomb",
    title: "Coulomb friction",
    equation: "F_C s, any force up to F_C at rest",
    parameters: &[Parameter::level("F_C", "friction level", Quantity::Force, 500.0, 8.0)],
    slots: &[Slot::FrictionLevel],
    shows: "a step of the force with the sign of the velocity",
    reference: "C.-A. de Coulomb, Theorie des machines simples, 1785",
};

impl Effect for Coulomb {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// Whatever slides has it.
    fn is_usual(&self) -> bool {
        true
    }

    fn may_be_overrated(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw { level: "level += {F_C};", ..CLaw::NONE })
    }

    fn friction_level(&self, p: Parameters<'_>, _m: &Motion<'_>, level: &mut [f64]) {
        add_to(level, p.get(0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;

    #[test]
    fn the_level_is_the_same_at_every_speed() {
        for velocity in [-1.0, -1e-6, 0.0, 1e-6, 1.0] {
            assert_eq!(level(&Coulomb, &[4.0], Point::at(0.1, velocity)), 4.0);
        }
    }
}
