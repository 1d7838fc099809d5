//! Viscous friction: the shear of a lubricant film.

use super::{About, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;

/// `F_v v`.
#[derive(Clone, Copy, Debug)]
pub struct Viscous;

static ABOUT: About = About {
    name: "viscous",
    title: "viscous friction",
    equation: "F_v v",
    parameters: &[Parameter::level("F_v", "damping", Quantity::Damping, 5000.0, 200.0)],
    slots: &[Slot::SmoothForce],
    shows: "a residual proportional to the velocity",
    reference: "O. Reynolds, Phil. Trans. R. Soc. 177, 1886",
};

impl Effect for Viscous {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let lanes = out.force.len();
        let (damping, velocity) = (&p.get(0)[..lanes], &m.velocity[..lanes]);
        let (force, slope) = (&mut out.force[..lanes], &mut out.damping[..lanes]);
        for i in 0..lanes {
            force[i] += damping[i] * velocity[i];
            slope[i] += damping[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn the_force_is_proportional_to_the_velocity() {
        assert_eq!(smooth(&Viscous, &[200.0], Point::at(0.0, 0.1)), (20.0, 200.0));
        assert_eq!(smooth(&Viscous, &[200.0], Point::at(0.0, -0.1)), (-20.0, 200.0));
    }
}
