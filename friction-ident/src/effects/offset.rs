//! A constant force: weight of an inclined axis, pre-tension, zero error of the current sensor.

use super::{About, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::add_to;

/// `F_0`.
#[derive(Clone, Copy, Debug)]
pub struct Offset;

static ABOUT: About = About {
    name: "offset",
    title: "constant force",
    equation: "F_0",
    parameters: &[Parameter::signed(
        "F_0",
        "force that resists motion in +x",
        Quantity::Force,
        200.0,
        1.0,
    )],
    slots: &[Slot::SmoothForce],
    shows: "the same residual at both signs of the velocity and at rest; asymmetric viscosity mimics it",
    reference: "M. Gautier, Dynamic identification of robots with power model, ICRA 1997",
};

impl Effect for Offset {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn smooth_force(&self, p: Parameters<'_>, _m: &Motion<'_>, out: &mut Smooth<'_>) {
        add_to(out.force, p.get(0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn the_force_does_not_depend_on_the_motion() {
        for velocity in [-1.0, 0.0, 1.0] {
            assert_eq!(smooth(&Offset, &[-3.0], Point::at(0.2, velocity)), (-3.0, 0.0));
        }
    }
}
