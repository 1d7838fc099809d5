//! Viscous friction: the shear of a lubricant film.

use super::own::Own;
use super::{About, Apart, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::vectorised;

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

    /// Whatever is greased has it.
    fn is_usual(&self) -> bool {
        true
    }

    fn may_be_overrated(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::smooth("force += {F_v} * v;").damped("damping += {F_v};"))
    }

    fn told_apart(&self) -> &'static [Apart] {
        &[Apart {
            from: &["quadratic-drag", "shear-thinning"],
            experiment: "run constant speeds over a factor of ten, up to the highest the axis allows",
        }]
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        let Own::Shear(factor) = own else { return None };
        Some(vec![factor * values[0]])
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        damp(p.get(0), m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn damp(damping: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (damping, velocity, slope) = (&damping[..n], &velocity[..n], &mut slope[..n]);
        for i in 0..n {
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
