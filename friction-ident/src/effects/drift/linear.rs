//! Friction that changes at the same rate from the begin of a recording to its end.

use crate::axis::Quantity;
use crate::effects::free::{BEGIN, END};
use crate::effects::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::simd::vectorised;

/// `(dF_C + dF_v |v|) u s`, `u` from 0 at the begin of the recording to 1 at its end.
///
/// An exponential that is far from its end is this line, but then what it ends at lies far below what the recording shows: of
/// friction that falls to less than half, below nothing, where no friction level can be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear;

static ABOUT: About = About {
    name: "drift:linear",
    title: "drift at a constant rate",
    equation: "(dF_C + dF_v |v|) u s, u = (t - begin)/(finish - begin)",
    parameters: &[
        BEGIN,
        END,
        Parameter::signed(
            "dF_C",
            "change of the friction level from the begin to the end",
            Quantity::Force,
            100.0,
            -1.0,
        ),
        Parameter::signed(
            "dF_v",
            "change of the damping from the begin to the end",
            Quantity::Damping,
            1000.0,
            -30.0,
        ),
    ],
    slots: &[Slot::FrictionLevel, Slot::SmoothForce],
    shows: "block means of the residual drift with time, along a straight line",
    reference: "L. Simoni et al., IFAC PapersOnLine 50, 2017 (temperature in friction models)",
};

impl Effect for Linear {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn is_course_of_time(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "force += {dF_v} * ((t - {begin}) / ({finish} - {begin})) * v;",
            damping: "damping += {dF_v} * ((t - {begin}) / ({finish} - {begin}));",
            level: "level += {dF_C} * ((t - {begin}) / ({finish} - {begin}));",
            ..CLaw::NONE
        })
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some("its time is that of the recording")
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        change_level(p.get(0), p.get(1), p.get(2), m.time, level);
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        change_damping([p.get(0), p.get(1), p.get(3)], m.time, m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn change_level(begin: &[f64], end: &[f64], change: &[f64], time: &[f64], level: &mut [f64]) {
        let n = level.len();
        let (begin, end, change, time) = (&begin[..n], &end[..n], &change[..n], &time[..n]);
        for i in 0..n {
            level[i] += change[i] * ((time[i] - begin[i]) / (end[i] - begin[i]));
        }
    }

    fn change_damping(
        parameters: [&[f64]; 3],
        time: &[f64],
        velocity: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let [begin, end, change] = parameters.map(|p| &p[..n]);
        let (time, velocity, slope) = (&time[..n], &velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let damping = change[i] * ((time[i] - begin[i]) / (end[i] - begin[i]));
            force[i] += damping * velocity[i];
            slope[i] += damping;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, along_and_simulated, level, smooth};

    #[test]
    fn both_parts_change_at_a_constant_rate_over_the_recording() {
        let p = [10.0, 60.0, 2.0, -30.0];
        for (time, share) in [(10.0, 0.0), (35.0, 0.5), (60.0, 1.0)] {
            let point = Point { time, ..Point::at(0.0, 0.1) };
            assert!((level(&Linear, &p, point) - 2.0 * share).abs() < 1e-12);
            assert!((smooth(&Linear, &p, point).0 + 3.0 * share).abs() < 1e-12);
            assert!((smooth(&Linear, &p, point).1 + 30.0 * share).abs() < 1e-12);
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("dF_C", -3.0), ("dF_v", -10.0), ("begin", 0.0), ("finish", 4.0)];
        let left = along_and_simulated(&[("drift:linear", &values)], None);
        assert!(left < 0.02, "{left}");
    }
}
