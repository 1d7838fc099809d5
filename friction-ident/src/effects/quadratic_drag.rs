//! Drag that grows with the square of the speed: air, churning of the lubricant.

mod power;

use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::vectorised;
use power::Power;

/// `c v |v|`.
#[derive(Clone, Copy, Debug)]
pub struct QuadraticDrag;

static FORMS: [&dyn Effect; 1] = [&Power];

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

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some(power::NAME)
    }

    fn may_be_overrated(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::smooth("force += {c} * v * fabs(v);").damped("damping += {c} * fabs(v);"))
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        drag(p.get(0), m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn drag(drag: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (drag, velocity, slope) = (&drag[..n], &velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let speed = velocity[i].abs();
            force[i] += drag[i] * velocity[i] * speed;
            // The secant through rest, not the tangent: it brakes however far off the prediction is.
            slope[i] += drag[i] * speed;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn it_opposes_the_motion_with_the_square_of_the_speed() {
        assert_eq!(smooth(&QuadraticDrag, &[100.0], Point::at(0.0, 0.5)), (25.0, 50.0));
        assert_eq!(smooth(&QuadraticDrag, &[100.0], Point::at(0.0, -0.5)), (-25.0, 50.0));
    }
}
