//! Rising static friction as the ageing law has it: contacts grow old while they rest and are renewed as they slide.

use crate::axis::Quantity;
use crate::effects::c_dynamics::PAST;
use crate::effects::memory::{BEGIN_OF_STEP, since_begin};
use crate::effects::{
    About, Begun, CDynamics, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled, Slot,
    Taken,
};
use crate::simd::{exp, ln, vectorised};

/// `level += B ln(1 + phi v_c / D_c)` with the age of the contacts `phi' = 1 - phi |v| / D_c`: the level rises with the
/// logarithm of the time at rest, falls with that of the speed, and follows changes of speed over a distance.
#[derive(Clone, Copy, Debug)]
pub struct Ageing;

/// Age of contacts that start at rest, s.
const RESTED: f64 = 1.0;

static ABOUT: About = About {
    name: "rising-static-friction:ageing",
    title: "rising static friction, by the age of the contacts",
    equation: "B ln(1 + phi v_c/D_c) s, phi' = 1 - phi |v|/D_c",
    parameters: &[
        Parameter::level("B", "extra level per e-fold of the age", Quantity::Force, 50.0, 0.5),
        Parameter::shape(
            "D_c",
            "distance over which contacts are renewed",
            Quantity::Length,
            // The size of asperities; over a longer way it would be any memory of a first order.
            (1e-7, 1e-4),
            1e-5,
        ),
        Parameter::shape(
            "v_c",
            "velocity above which hardly anything is left",
            Quantity::Velocity,
            (1e-6, 100.0),
            1e-3,
        ),
    ],
    slots: &[Slot::Memory],
    shows: "breakaway peak against the logarithm of the dwell time; friction against the logarithm of a steady speed; after a \
            change of speed the level follows over the same distance at every speed",
    reference: "J. H. Dieterich, J. Geophysical Research 84, 1979; A. Ruina, J. Geophysical Research 88, 1983",
};

impl Effect for Ageing {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            helpers: &[PAST, AGED],
            slow: "1e-9",
            start: "{s0} = velocity == 0.0 ? 1.0 : {D_c} / fabs(velocity);",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0);
    const double age = aged({s0}, ahead, ahead * fabs(m->predicted) / {D_c});
    m->remembered += {B} * log(1.0 + age * {v_c} / {D_c});
}",
            remember: "if (m->taken > 0.0) {
    {s0} = aged({s0}, m->taken, fabs(m->displacement) / {D_c});
}",
            ..CDynamics::NONE
        })
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

/// Helper: `aged(age, duration, renewed)`.
const AGED: &str = include_str!("../../export/c/aged.c");

/// State: the age of the contacts, s.
impl Memory for Ageing {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        let rested = begun.came.and_then(|came| came.rested).unwrap_or(RESTED);
        state[0] = if begun.velocity == 0.0 { rested } else { p[1] / begun.velocity.abs() };
    }

    fn memory(&self, _p: Parameters<'_>) -> f64 {
        BEGIN_OF_STEP
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        recall(p, past.newest_times(), m.time, m.velocity, state, out.level);
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        remember(p.get(1), taken.duration, taken.displacement, state);
    }
}

/// The age after a piece at a steady speed, of which the share `exp(-renewed)` of the contacts outlasts: exact.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn aged(age: f64, duration: f64, renewed: f64) -> f64 {
    let left = exp(-renewed);
    // (1 - exp(-x)) / x, without the difference of what is nearly equal.
    let mean =
        if renewed < 1e-3 { 1.0 - renewed * (0.5 - renewed / 6.0) } else { (1.0 - left) / renewed };
    age * left + duration * mean
}

vectorised! {
    fn recall(
        p: Parameters<'_>,
        begin: &[f64],
        now: &[f64],
        velocity: &[f64],
        age: &[f64],
        level: &mut [f64],
    ) {
        let n = level.len();
        let (size, distance, speed) = (&p.get(0)[..n], &p.get(1)[..n], &p.get(2)[..n]);
        let (begin, now, velocity, age) = (&begin[..n], &now[..n], &velocity[..n], &age[..n]);
        for i in 0..n {
            let ahead = since_begin(begin[i], now[i]);
            let age = aged(age[i], ahead, ahead * velocity[i].abs() / distance[i]);
            level[i] += size[i] * ln(1.0 + age * speed[i] / distance[i]);
        }
    }

    fn remember(distance: &[f64], duration: &[f64], displacement: &[f64], age: &mut [f64]) {
        let n = age.len();
        let (distance, duration) = (&distance[..n], &duration[..n]);
        let displacement = &displacement[..n];
        for i in 0..n {
            let next = aged(age[i], duration[i], displacement[i].abs() / distance[i]);
            age[i] = if duration[i] > 0.0 { next } else { age[i] };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::breakaway;
    use super::*;
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::effects::testing::along_and_simulated;
    use crate::model::Model;

    const NAME: &str = "rising-static-friction:ageing";
    const VALUES: [(&str, f64); 3] = [("B", 0.5), ("D_c", 1e-5), ("v_c", 1e-3)];

    #[test]
    fn at_a_steady_speed_the_level_falls_with_its_logarithm() {
        let plain = Model::new(Axis::Linear, 1.0).and_then(|m| m.with("coulomb", &[("F_C", 5.0)]));
        let model = plain.and_then(|m| m.with(NAME, &VALUES)).unwrap();
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        // From one speed to another at 1 s.
        let (slow, fast) = (1e-4, 1e-3);
        let velocity: Vec<f64> = time.iter().map(|t| if *t < 1.0 { slow } else { fast }).collect();
        let place = |t: f64| slow * t.min(1.0) + fast * (t - 1.0).max(0.0);
        let position: Vec<f64> = time.iter().map(|t| place(*t)).collect();
        let none = vec![0.0; 2000];
        let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
        let force = force_along(&model, &motion);
        let level = |age: f64| 5.0 + 0.5 * (1.0 + age * 1e-3 / 1e-5).ln();
        assert!((force[990] - level(1e-5 / slow)).abs() < 1e-6, "{}", force[990]);
        // Contacts of the slower speed are renewed over D_c.
        let age = |slid: f64| (1e-5 / fast) + (1e-5 / slow - 1e-5 / fast) * (-slid / 1e-5).exp();
        for k in [1005, 1010, 1020, 1900_usize] {
            let slid = fast * (k as f64 - 999.5) * 1e-3;
            assert!((force[k] - level(age(slid))).abs() < 2e-2, "{k}: {}", force[k]);
        }
    }

    #[test]
    fn the_breakaway_force_rises_with_the_logarithm_of_the_rest() {
        for dwell in [0.3, 1.0, 5.0] {
            let force = breakaway(NAME, &VALUES, dwell);
            // Rest begins at about 0.03 s and ends when the force is reached.
            let rest = dwell - 0.03 + (force - 4.9) / 10.0;
            let exact = 7.0 + 0.5 * (1.0 + rest * 1e-3 / 1e-5).ln();
            assert!((force - exact).abs() < 0.06, "{dwell} s: {force} against {exact}");
        }
    }

    #[test]
    fn the_age_is_exact_at_every_speed() {
        // From 1 s on, for 0.1 s at 0.2 of D_c per second and at next to nothing.
        for speed in [0.2, 1e-2, 1e-9, 0.0] {
            let (mut age, steps) = (1.0, 100_000);
            let h = 0.1 / f64::from(steps);
            for _ in 0..steps {
                let middle = age + 0.5 * h * (1.0 - age * speed);
                age += h * (1.0 - middle * speed);
            }
            let exact = aged(1.0, 0.1, 0.1 * speed);
            assert!((exact - age).abs() < 1e-9, "{speed}: {exact} {age}");
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let left = along_and_simulated(&[(NAME, &VALUES)], None);
        assert!(left < 0.01, "{left}");
    }
}
