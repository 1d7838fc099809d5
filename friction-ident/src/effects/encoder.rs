//! The encoder: whole counts, and an error within each period of its grating.

use std::f64::consts::TAU;

use super::{About, Effect, Parameter, Slot};
use crate::axis::Quantity;

/// `q = step round((x + a sin(2 pi x/p) + b cos(2 pi x/p)) / step)`.
#[derive(Clone, Copy, Debug)]
pub struct Encoder;

static ABOUT: About = About {
    name: "encoder",
    title: "encoder: resolution and sub-division error",
    equation: "x + a sin(2 pi x/p) + b cos(2 pi x/p), rounded to whole q",
    parameters: &[
        Parameter::fixed("q", "resolution", Quantity::Length, (0.0, 1e-3), 1e-6),
        Parameter::signed(
            "a",
            "sine amplitude of the sub-division error",
            Quantity::Length,
            1e-4,
            0.0,
        ),
        Parameter::signed(
            "b",
            "cosine amplitude of the sub-division error",
            Quantity::Length,
            1e-4,
            0.0,
        ),
        Parameter::shape("p", "period of the grating", Quantity::Length, (1e-6, 1e-2), 2e-5),
    ],
    slots: &[Slot::Sensor],
    shows: "a residual whose size does not depend on the motion; with sub-division error a line whose frequency is speed/p",
    reference: "P. L. M. Heydemann, Applied Optics 20, 1981 (sub-division); IEEE Std 1057 (quantisation)",
};

impl Effect for Encoder {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn show(&self, p: &[f64], position: &mut [f64]) {
        let [step, a, b, period] = [p[0], p[1], p[2], p[3]];
        for position in position {
            let (sin, cos) = (TAU * *position / period).sin_cos();
            let shown = *position + a * sin + b * cos;
            *position = if step > 0.0 { (shown / step).round() * step } else { shown };
        }
    }

    fn shows_in_force(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_whole_counts() {
        let mut position = [0.4e-6, 0.6e-6, -1.6e-6];
        Encoder.show(&[1e-6, 0.0, 0.0, 2e-5], &mut position);
        assert_eq!(position, [0.0, 1e-6, -2e-6]);
    }

    #[test]
    fn the_sub_division_error_repeats_with_the_grating() {
        let at = |x: f64| {
            let mut position = [x];
            Encoder.show(&[0.0, 2e-7, 1e-7, 2e-5], &mut position);
            position[0] - x
        };
        assert!((at(5e-6) - 2e-7).abs() < 1e-15 && (at(0.0) - 1e-7).abs() < 1e-15);
        assert!((at(3.3e-6) - at(2.33e-5)).abs() < 1e-15);
    }
}
