//! Friction that varies along the stroke: straightness, preload, wear.

use std::f64::consts::PI;

use super::{About, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;

/// `level += sum_k c_k cos(k pi u)` over the stroke, `u` from 0 to 1: smooth, without a mean, so that
/// it does not compete with `coulomb`.
#[derive(Clone, Copy, Debug)]
pub struct PositionFriction;

/// Number of cosines.
pub const TERMS: usize = 6;

const fn term(name: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, "amplitude of cos(k pi u)", Quantity::Force, 100.0, default)
}

static ABOUT: About = About {
    name: "position-friction",
    title: "friction along the stroke",
    equation: "sum_{k=1..6} c_k cos(k pi u) s, u = (x - start)/(end - start) within 0..1",
    parameters: &[
        term("c_1", 1.0),
        term("c_2", 0.0),
        term("c_3", 0.0),
        term("c_4", 0.0),
        term("c_5", 0.0),
        term("c_6", 0.0),
        Parameter::fixed("start", "begin of the stroke", Quantity::Length, (-10.0, 10.0), 0.0),
        Parameter::fixed("end", "end of the stroke", Quantity::Length, (-10.0, 10.0), 0.3),
    ],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against position",
    reference: "M. R. Popovic, A. A. Goldenberg, IEEE Trans. Robotics and Automation 14, 1998",
};

impl Effect for PositionFriction {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        let lanes = level.len();
        let amplitude: [&[f64]; TERMS] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        let (start, end) = (&p.get(TERMS)[..lanes], &p.get(TERMS + 1)[..lanes]);
        let position = &m.position[..lanes];
        for i in 0..lanes {
            let u = ((position[i] - start[i]) / (end[i] - start[i])).clamp(0.0, 1.0);
            let cos = (PI * u).cos();
            // Chebyshev: cos (k + 1) a = 2 cos a cos k a - cos (k - 1) a.
            let (mut before, mut now, mut sum) = (1.0, cos, 0.0);
            for amplitude in &amplitude {
                sum += amplitude[i] * now;
                (before, now) = (now, 2.0 * cos * now - before);
            }
            level[i] += sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;

    #[test]
    fn it_is_the_sum_of_cosines_over_the_stroke() {
        let p = [1.0, -0.5, 0.3, 0.2, -0.1, 0.05, -0.1, 0.3];
        for x in [-0.1, 0.0, 0.13, 0.3] {
            let u = (x + 0.1) / 0.4;
            let exact: f64 = (1..=TERMS).map(|k| p[k - 1] * (k as f64 * PI * u).cos()).sum();
            assert!((level(&PositionFriction, &p, Point::at(x, 0.1)) - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn beyond_the_stroke_it_keeps_the_value_of_the_end() {
        let p = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3];
        assert_eq!(level(&PositionFriction, &p, Point::at(0.5, 0.1)), -1.0);
        assert_eq!(level(&PositionFriction, &p, Point::at(-0.5, 0.1)), 1.0);
    }

    #[test]
    fn its_mean_over_the_stroke_is_zero() {
        let p = [1.0, -0.5, 0.3, 0.2, -0.1, 0.05, 0.0, 1.0];
        let points = 10_000;
        let sum: f64 = (0..points)
            .map(|k| (f64::from(k) + 0.5) / f64::from(points))
            .map(|x| level(&PositionFriction, &p, Point::at(x, 0.1)))
            .sum();
        assert!((sum / f64::from(points)).abs() < 1e-9);
    }
}
