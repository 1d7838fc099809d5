//! A gain that varies along the stroke: the force constant of a linear motor over its magnets and at their ends.

use crate::axis::Quantity;
use crate::effects::about::STROKE;
use crate::effects::c_law::profile;
use crate::effects::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth, cosines};

/// `F = u (1 + sum_k c_k cos(k pi u))` over the stroke, as the force that is missing: without a mean, which all other
/// parameters scale with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke;

/// Number of cosines.
const COSINES: usize = 6;

const fn amplitude(name: &'static str, default: f64) -> Parameter {
    Parameter::signed(
        name,
        "amplitude of cos(k pi u), of the mean gain",
        Quantity::One,
        0.9,
        default,
    )
}

static ABOUT: About = About {
    name: "motor-gain:stroke",
    title: "gain along the stroke",
    equation: "F (1 + sum_{k=1..6} c_k cos(k pi u)), u = (x - start)/(end - start) within 0..1",
    parameters: &[
        amplitude("c_1", 0.05),
        amplitude("c_2", 0.0),
        amplitude("c_3", 0.0),
        amplitude("c_4", 0.0),
        amplitude("c_5", 0.0),
        amplitude("c_6", 0.0),
        STROKE[0],
        STROKE[1],
    ],
    slots: &[Slot::SmoothForce],
    shows: "(residual / force) against position, the same for large and small forces of either sign",
    reference: "C. Rohrig, A. Jochheim, American Control Conference 2001 (force ripple of linear motors)",
};

impl Effect for Stroke {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some("it needs the force of the drive")
    }

    fn c_law(&self) -> Option<CLaw> {
        let smooth =
            profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "force -= sum * drive;");
        Some(CLaw::smooth(smooth))
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        cosines::take(p, COSINES, m.position, m.drive_force, out.force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, along_and_simulated, smooth};
    use std::f64::consts::PI;

    #[test]
    fn it_is_the_force_of_the_drive_times_a_sum_of_cosines_over_the_stroke() {
        let p = [0.3, -0.05, 0.03, 0.02, -0.01, 0.005, -0.1, 0.3];
        let sum =
            |u: f64| -> f64 { (0..COSINES).map(|k| p[k] * ((k + 1) as f64 * PI * u).cos()).sum() };
        for (x, u) in [(-0.3, 0.0), (0.0, 0.25), (0.13, 0.575), (0.4, 1.0)] {
            for drive_force in [20.0, -5.0] {
                let point = Point { drive_force, ..Point::at(x, 0.1) };
                let (force, damping) = smooth(&Stroke, &p, point);
                assert!((force + drive_force * sum(u)).abs() < 1e-12);
                assert_eq!(damping, 0.0);
            }
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("c_1", 0.2), ("c_3", -0.1), ("start", -0.05), ("end", 0.1)];
        let left = along_and_simulated(&[("motor-gain:stroke", &values)], None);
        assert!(left < 0.02, "{left}");
    }
}
