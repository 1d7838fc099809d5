//! Drift: friction relaxes with time while the machine warms up.

mod linear;

use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{exp, vectorised};
use linear::Linear;

/// `(dF_C + dF_v |v|) exp(-t/tau) s`: what is there at the start beyond the final friction.
#[derive(Clone, Copy, Debug)]
pub struct Drift;

static FORMS: [&dyn Effect; 1] = [&Linear];

static ABOUT: About = About {
    name: "drift",
    title: "warm-up drift",
    equation: "(dF_C + dF_v |v|) exp(-t/tau) s",
    parameters: &[
        Parameter::signed(
            "dF_C",
            "friction level at the start beyond the final one",
            Quantity::Force,
            100.0,
            1.0,
        ),
        Parameter::signed(
            "dF_v",
            "damping at the start beyond the final one",
            Quantity::Damping,
            1000.0,
            30.0,
        ),
        Parameter::shape("tau", "time constant", Quantity::Time, (1.0, 1e4), 100.0),
    ],
    slots: &[Slot::FrictionLevel, Slot::SmoothForce],
    shows: "block means of the residual drift with time",
    reference: "L. Simoni et al., IFAC PapersOnLine 50, 2017 (temperature in friction models)",
};

impl Effect for Drift {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["tau"]
    }

    fn is_course_of_time(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "force += {dF_v} * exp(-t / {tau}) * v;",
            damping: "damping += {dF_v} * exp(-t / {tau});",
            level: "level += {dF_C} * exp(-t / {tau});",
            ..CLaw::NONE
        })
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some("its time is that of the recording")
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        fade_level(p.get(0), p.get(2), m.time, level);
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        fade_damping(p.get(1), p.get(2), m.time, m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn fade_level(start: &[f64], tau: &[f64], time: &[f64], level: &mut [f64]) {
        let n = level.len();
        let (start, tau, time) = (&start[..n], &tau[..n], &time[..n]);
        for i in 0..n {
            level[i] += start[i] * exp(-time[i] / tau[i]);
        }
    }

    fn fade_damping(
        start: &[f64],
        tau: &[f64],
        time: &[f64],
        velocity: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let (start, tau, time) = (&start[..n], &tau[..n], &time[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let damping = start[i] * exp(-time[i] / tau[i]);
            force[i] += damping * velocity[i];
            slope[i] += damping;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level, smooth};
    use super::*;

    #[test]
    fn both_parts_relax_with_the_time_constant() {
        let p = [2.0, 30.0, 50.0];
        let point = Point { time: 50.0, ..Point::at(0.0, 0.1) };
        let left = (-1.0f64).exp();
        assert!((level(&Drift, &p, point) - 2.0 * left).abs() < 1e-12);
        assert!((smooth(&Drift, &p, point).0 - 3.0 * left).abs() < 1e-12);
        assert_eq!(level(&Drift, &p, Point::at(0.0, -0.1)), 2.0);
    }
}
