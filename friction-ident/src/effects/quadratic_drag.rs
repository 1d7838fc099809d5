//! Drag that grows with the square of the speed: air, churning of the lubricant.

use super::{About, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;

/// `c v |v|`.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticDrag;

static ABOUT: About = About {
    name: "quadratic-drag",
    title: "quadratic drag",
    equation: "c v |v|",
    parameters: &[Parameter::level("c", "drag", Quantity::Drag, 10_000.0, 100.0)],
    slots: &[Slot::SmoothForce],
    shows: "curvature against speed at top speed only; hardly separable from viscous in a narrow speed range",
    reference: "Lord Rayleigh, Phil. Mag. 2, 1876",
};

impl Effect for QuadraticDrag {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let lanes = out.force.len();
        let (drag, velocity) = (&p.get(0)[..lanes], &m.velocity[..lanes]);
        let (force, slope) = (&mut out.force[..lanes], &mut out.damping[..lanes]);
        for i in 0..lanes {
            let speed = velocity[i].abs();
            force[i] += drag[i] * velocity[i] * speed;
            slope[i] += 2.0 * drag[i] * speed;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn it_opposes_the_motion_with_the_square_of_the_speed() {
        assert_eq!(smooth(&QuadraticDrag, &[100.0], Point::at(0.0, 0.5)), (25.0, 100.0));
        assert_eq!(smooth(&QuadraticDrag, &[100.0], Point::at(0.0, -0.5)), (-25.0, 100.0));
    }
}
