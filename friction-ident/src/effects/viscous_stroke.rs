//! Viscous friction that varies along the stroke: lubricant that is not spread evenly, a screw that is warm in the middle.

use super::about::STROKE;
use super::c_law::profile;
use super::cosines;
use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;

/// `v sum_k c_k cos(k pi u)` over the stroke, `u` from 0 to 1: smooth, without a mean, so that it does not compete with
/// `viscous`.
#[derive(Clone, Copy, Debug)]
pub struct ViscousStroke;

/// Number of cosines.
const COSINES: usize = 6;

const fn amplitude(name: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, "amplitude of cos(k pi u)", Quantity::Damping, 2000.0, default)
}

static ABOUT: About = About {
    name: "viscous-stroke",
    title: "viscous friction along the stroke",
    equation: "v sum_{k=1..6} c_k cos(k pi u), u = (x - start)/(end - start) within 0..1",
    parameters: &[
        amplitude("c_1", 50.0),
        amplitude("c_2", 0.0),
        amplitude("c_3", 0.0),
        amplitude("c_4", 0.0),
        amplitude("c_5", 0.0),
        amplitude("c_6", 0.0),
        STROKE[0],
        STROKE[1],
    ],
    slots: &[Slot::SmoothForce],
    shows: "(residual / velocity) against position, the same for fast and slow passes",
    reference: "M. R. Popovic, A. A. Goldenberg, IEEE Trans. Robotics and Automation 14, 1998",
};

impl Effect for ViscousStroke {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "force += sum * v;"),
            damping: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "damping += sum;"),
            ..CLaw::NONE
        })
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        cosines::damp(p, COSINES, m.position, m.velocity, out.force, out.damping);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, along_and_simulated, smooth};
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn it_is_the_velocity_times_a_sum_of_cosines_over_the_stroke_and_level_beyond() {
        let p = [30.0, -5.0, 3.0, 2.0, -1.0, 0.5, -0.1, 0.3];
        let sum =
            |u: f64| -> f64 { (0..COSINES).map(|k| p[k] * ((k + 1) as f64 * PI * u).cos()).sum() };
        for (x, u) in [(-0.3, 0.0), (-0.1, 0.0), (0.0, 0.25), (0.13, 0.575), (0.4, 1.0)] {
            for v in [0.2, -0.05] {
                let (force, damping) = smooth(&ViscousStroke, &p, Point::at(x, v));
                assert!((force - v * sum(u)).abs() < 1e-12);
                assert!((damping - sum(u)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("c_1", 40.0), ("c_3", -30.0), ("start", -0.05), ("end", 0.1)];
        let left = along_and_simulated(&[("viscous-stroke", &values)], None);
        assert!(left < 0.02, "{left}");
    }
}
