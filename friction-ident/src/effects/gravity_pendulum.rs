//! Weight of a pendulum on a rotary axis.

use std::f64::consts::TAU;

use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth, Trials};
use crate::axis::{Axis, Quantity};
use crate::simd::{sin_cos_of_turns, vectorised};

/// `M sin(q - q_0)`; `M` is mass times gravity times the distance of the centre of mass.
#[derive(Clone, Copy, Debug)]
pub struct GravityPendulum;

static ABOUT: About = About {
    name: "gravity-pendulum",
    title: "weight of a pendulum",
    equation: "M sin(q - q_0), M = m g l",
    parameters: &[
        Parameter::level("M", "torque at 90 degrees", Quantity::Force, 500.0, 25.0),
        Parameter {
            low: -3.2,
            high: 3.2,
            ..Parameter::shape(
                "q_0",
                "angle at which it hangs down",
                Quantity::Angle,
                (0.0, 1.0),
                0.0,
            )
            .linear()
        },
    ],
    slots: &[Slot::SmoothForce],
    shows: "a sine of the angle, the same for both directions and at rest",
    reference: "C. Huygens, Horologium oscillatorium, 1673",
};

impl Effect for GravityPendulum {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn is_of_place(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw { smooth: "force += {M} * sin(x - {q_0});", ..CLaw::NONE })
    }

    /// Most pendulums hang at the zero of their encoder; a coarse grid passes it by.
    fn trials(&self, _parameter: &str) -> Option<Trials> {
        Some(Trials::Turn(32))
    }

    fn suits(&self, axis: Axis) -> bool {
        axis == Axis::Rotary
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        hang(p.get(0), p.get(1), m.position, out.force);
    }
}

vectorised! {
    fn hang(torque: &[f64], zero: &[f64], angle: &[f64], force: &mut [f64]) {
        let n = force.len();
        let (torque, zero, angle) = (&torque[..n], &zero[..n], &angle[..n]);
        for i in 0..n {
            force[i] += torque[i] * sin_cos_of_turns((angle[i] - zero[i]) / TAU).0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_torque_is_full_at_90_degrees_and_gone_hanging_down() {
        let full = smooth(&GravityPendulum, &[0.5, 0.1], Point::at(0.1 + FRAC_PI_2, 0.0));
        assert!((full.0 - 0.5).abs() < 1e-15);
        assert_eq!(smooth(&GravityPendulum, &[0.5, 0.1], Point::at(0.1, 0.0)).0, 0.0);
    }
}
