//! Viscous friction that varies along the stroke: lubricant that is not spread evenly, a screw that is warm in the middle.

use super::about::STROKE;
use super::c_law::profile;
use super::cosines;
use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;

/// `v sum_k c_k cos(k pi u)` over the stroke, `u` from 0 to 1: smooth, without a mean, so that it does not compete with
/// `viscous`. In detail it follows a brake that is engaged on a part of the stroke.
#[derive(Clone, Copy, Debug)]
pub struct ViscousStroke<const COSINES: usize>;

const MAIN: usize = 6;
const DETAILED: usize = 20;
/// The default form: a sixth of the stroke is the shortest half wave.
pub static VISCOUS_STROKE: ViscousStroke<MAIN> = ViscousStroke;
static FINE: ViscousStroke<DETAILED> = ViscousStroke;
static FORMS: [&dyn Effect; 1] = [&FINE];

const COSINE: Parameter =
    Parameter::signed("c_1", "amplitude of cos(k pi u)", Quantity::Damping, 2000.0, 50.0);
const SHOWS: &str = "(residual / velocity) against position, the same for fast and slow passes";
const REFERENCE: &str =
    "M. R. Popovic, A. A. Goldenberg, IEEE Trans. Robotics and Automation 14, 1998";

static ABOUT: About = About {
    name: "viscous-stroke",
    title: "viscous friction along the stroke",
    equation: "v sum_{k=1..6} c_k cos(k pi u), u = (x - start)/(end - start) within 0..1",
    parameters: &cosines::parameters::<2, { MAIN + 2 }>(COSINE, STROKE),
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: REFERENCE,
};
static FINE_ABOUT: About = About {
    name: "viscous-stroke:fine",
    title: "viscous friction along the stroke, in detail",
    equation: "v sum_{k=1..20} c_k cos(k pi u), u = (x - start)/(end - start) within 0..1",
    parameters: &cosines::parameters::<2, { DETAILED + 2 }>(COSINE, STROKE),
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: REFERENCE,
};

/// The C of either form.
macro_rules! c_law {
    ($count:literal, $amplitudes:literal) => {
        CLaw {
            smooth: profile!($count, $amplitudes, "force += sum * v;"),
            damping: profile!($count, $amplitudes, "damping += sum;"),
            ..CLaw::NONE
        }
    };
}

impl<const COSINES: usize> Effect for ViscousStroke<COSINES> {
    fn about(&self) -> &'static About {
        if COSINES == MAIN { &ABOUT } else { &FINE_ABOUT }
    }

    fn flexible_form(&self) -> Option<&'static str> {
        (COSINES == MAIN).then_some("viscous-stroke:fine")
    }

    /// In detail it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        COSINES == DETAILED
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if COSINES == MAIN { &FORMS } else { &[] }
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(if COSINES == MAIN {
            c_law!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}")
        } else {
            c_law!(
                "20",
                "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}, {c_7}, {c_8}, {c_9}, {c_10},
        {c_11}, {c_12}, {c_13}, {c_14}, {c_15}, {c_16}, {c_17}, {c_18}, {c_19}, {c_20}"
            )
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
        let main = vec![30.0, -5.0, 3.0, 2.0, -1.0, 0.5, -0.1, 0.3];
        let mut fine: Vec<f64> = (1..=DETAILED).map(|k| (k as f64).sin() / k as f64).collect();
        fine.extend([-0.1, 0.3]);
        let forms: [(&dyn Effect, &[f64]); 2] = [(&VISCOUS_STROKE, &main), (&FINE, &fine)];
        for (form, p) in forms {
            let cosines = p.len() - 2;
            let sum = |u: f64| -> f64 {
                (0..cosines).map(|k| p[k] * ((k + 1) as f64 * PI * u).cos()).sum()
            };
            for (x, u) in [(-0.3, 0.0), (-0.1, 0.0), (0.0, 0.25), (0.13, 0.575), (0.4, 1.0)] {
                for v in [0.2, -0.05] {
                    let (force, damping) = smooth(form, p, Point::at(x, v));
                    assert!((force - v * sum(u)).abs() < 1e-12);
                    assert!((damping - sum(u)).abs() < 1e-12);
                }
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
