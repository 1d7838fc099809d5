//! Force ripple: periodic along the stroke, the same for both directions (screw, cogging).

use std::f64::consts::TAU;

use super::{About, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;

/// Two harmonics of period `l`.
#[derive(Clone, Copy, Debug)]
pub struct Ripple;

const A1: &str = "sine amplitude of the period";
const B1: &str = "cosine amplitude of the period";
const A2: &str = "sine amplitude of half the period";
const B2: &str = "cosine amplitude of half the period";

static ABOUT: About = About {
    name: "ripple",
    title: "force ripple along the stroke",
    equation: "sum_{k=1,2} a_k sin(2 pi k x/l) + b_k cos(2 pi k x/l)",
    parameters: &[
        Parameter::signed("a_1", A1, Quantity::Force, 50.0, 1.0),
        Parameter::signed("b_1", B1, Quantity::Force, 50.0, 0.0),
        Parameter::signed("a_2", A2, Quantity::Force, 50.0, 0.0),
        Parameter::signed("b_2", B2, Quantity::Force, 50.0, 0.0),
        Parameter::shape(
            "l",
            "period: screw lead, pole pitch",
            Quantity::Length,
            (2e-4, 0.2),
            5e-3,
        ),
    ],
    slots: &[Slot::SmoothForce],
    shows: "a line at 1/l in the residual's spectrum over position",
    reference: "G. Otten et al., IEEE/ASME Trans. Mechatronics 2, 1997 (cogging)",
};

impl Effect for Ripple {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let lanes = out.force.len();
        let [a1, b1, a2, b2, period] = [0, 1, 2, 3, 4].map(|k| &p.get(k)[..lanes]);
        let (position, force) = (&m.position[..lanes], &mut out.force[..lanes]);
        for i in 0..lanes {
            let (sin, cos) = (TAU * (position[i] / period[i])).sin_cos();
            // sin 2a = 2 sin a cos a, cos 2a = 1 - 2 sin^2 a.
            let second = 2.0 * a2[i] * sin * cos + b2[i] * (1.0 - 2.0 * sin * sin);
            force[i] += a1[i] * sin + b1[i] * cos + second;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn both_harmonics_have_their_period() {
        let p = [1.0, 0.5, 0.3, -0.2, 5e-3];
        for x in [0.0, 0.37e-3, 1.9e-3] {
            let (force, _) = smooth(&Ripple, &p, Point::at(x, 0.1));
            let a = TAU * x / 5e-3;
            let exact = a.sin() + 0.5 * a.cos() + 0.3 * (2.0 * a).sin() - 0.2 * (2.0 * a).cos();
            assert!((force - exact).abs() < 1e-12);
            let (later, _) = smooth(&Ripple, &p, Point::at(x + 5e-3, -0.1));
            assert!((force - later).abs() < 1e-12);
        }
    }
}
