//! Friction after a reversal that is not yet, or no longer, what it is further on: balls that must reseat, wipers that fold
//! over, grease that was pushed aside.

mod bouc_wen;
mod hysteresis;

use super::memory::{BEGIN_OF_STEP, since_begin};
use super::ripple::LEADS;
use super::{
    About, AsFound, Begun, Came, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled,
    Refused, Slot, Taken,
};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::PAST;
use crate::simd::{exp, sign, vectorised};

/// `level += F_r exp(-|distance since the reversal| / l)`.
#[derive(Clone, Copy, Debug)]
pub struct ReversalDecay;

/// So far from the last reversal that nothing of it is left.
const FAR: f64 = f64::MAX;
static FORMS: [&dyn Effect; 2] = [&hysteresis::Hysteresis, &bouc_wen::BoucWen];

static ABOUT: About = About {
    name: "reversal-decay",
    title: "friction after a reversal",
    equation: "F_r exp(-|d|/l) s, d = distance slid since the last reversal",
    parameters: &[
        Parameter::signed("F_r", "extra level right after a reversal", Quantity::Force, 100.0, 2.0),
        Parameter::shape("l", "distance over which it decays", Quantity::Length, (1e-6, 0.1), 1e-3),
    ],
    slots: &[Slot::Memory],
    shows: "(residual x sign of velocity) against the distance since the last reversal, the same at every speed",
    reference: "empirical, for quadrant glitches of feed drives as in K. Erkorkmaz, Y. Altintas, Int. J. Machine Tools and Manufacture 41, 2001",
};

/// What is over within a count of the position nobody sees: a contact that gives less than that would do as much.
fn within_a_count(found: &AsFound<'_>) -> Option<Refused> {
    found.within((1, "l"), found.count, "it is over within a count of the position")
}

impl Effect for ReversalDecay {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 2,
            helpers: &[PAST],
            slow: "1e-9",
            start: "{s0} = velocity == 0.0 ? 0.0 : DBL_MAX;\n{s1} = sign(velocity);",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0) * fabs(m->predicted);
    const double going = m->predicted == 0.0 ? m->drive : m->predicted;
    const double since = going * {s1} < 0.0 ? ahead : {s0} + ahead;
    m->remembered += {F_r} * exp(-since / {l});
}",
            remember: "if (m->sliding > 0.0 && m->displacement != 0.0) {
    const double way = fabs(m->displacement);
    {s0} = m->displacement * {s1} < 0.0 ? way : {s0} + way;
    {s1} = sign(m->displacement);
}",
            ..CDynamics::NONE
        })
    }

    /// It comes back with each turn of a screw.
    fn drawn_from(&self, parameter: &str) -> Option<&'static [f64]> {
        (parameter == "l").then_some(&LEADS)
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        within_a_count(found)
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

/// States: distance since the last reversal, and the direction since then (0 before the first motion).
impl Memory for ReversalDecay {
    fn states(&self) -> usize {
        2
    }

    fn start(&self, _p: &[f64], begun: &Begun, state: &mut [f64]) {
        let (since, direction) = match begun.came {
            Some(Came { way, .. }) => (way.abs().min(FAR), sign(way)),
            // Whence an axis came that a recording finds at rest nobody knows: most often to an end of its way, where its
            // first motion is a reversal.
            None if begun.velocity == 0.0 => (0.0, 0.0),
            None => (FAR, sign(begun.velocity)),
        };
        state.copy_from_slice(&[since, direction]);
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
        let (distance, direction) = state.split_at(out.level.len());
        let (begin, now) = (past.newest_times(), m.time);
        recall(p, begin, now, m.velocity, m.drive_force, distance, direction, out.level);
    }

    fn remember(&self, _p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        let (distance, direction) = state.split_at_mut(taken.sliding.len());
        for (i, moved) in taken.displacement.iter().enumerate() {
            // What an axis at rest seems to move is noise, or the vibration of its contact.
            if taken.sliding[i] > 0.0 && *moved != 0.0 {
                let turned = moved * direction[i] < 0.0;
                distance[i] = if turned { moved.abs() } else { distance[i] + moved.abs() };
                direction[i] = moved.signum();
            }
        }
    }

    /// The way since the reversal is as long as the estimate says, either way: noise is no reversal.
    fn correct(&self, _p: Parameters<'_>, displacement: &[f64], state: &mut [f64]) {
        let (distance, direction) = state.split_at_mut(displacement.len());
        for (i, dx) in displacement.iter().enumerate() {
            distance[i] = (distance[i] + direction[i] * dx).max(0.0);
        }
    }
}

vectorised! {
    fn recall(
        p: Parameters<'_>,
        begin: &[f64],
        now: &[f64],
        velocity: &[f64],
        drive_force: &[f64],
        distance: &[f64],
        direction: &[f64],
        level: &mut [f64],
    ) {
        let n = level.len();
        let (size, length, begin, now) = (&p.get(0)[..n], &p.get(1)[..n], &begin[..n], &now[..n]);
        let (velocity, drive_force) = (&velocity[..n], &drive_force[..n]);
        let (distance, direction) = (&distance[..n], &direction[..n]);
        for i in 0..n {
            let ahead = since_begin(begin[i], now[i]) * velocity[i].abs();
            // At rest the drive says where it will go: else the level would come a step after the breakaway.
            let going = if velocity[i] == 0.0 { drive_force[i] } else { velocity[i] };
            let turns = going * direction[i] < 0.0;
            let since = ahead + if turns { 0.0 } else { distance[i] };
            level[i] += size[i] * exp(-since / length[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::along_and_simulated;
    use super::*;
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    const VALUES: [(&str, f64); 2] = [("F_r", 3.0), ("l", 0.01)];

    #[test]
    fn there_is_none_before_the_first_reversal_and_then_it_decays_with_the_distance() {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
            .and_then(|m| m.with("reversal-decay", &VALUES))
            .unwrap();
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        // Turns at 0.5 s, between two samples; stops at 1.5 s and goes on.
        let rests = |t: f64| (1.5..1.6).contains(&t);
        let speed = |t: f64| if rests(t) { 0.0 } else { 0.1 };
        let velocity: Vec<f64> =
            time.iter().map(|t| if *t < 0.4995 { 0.1 } else { -speed(*t) }).collect();
        let mut x = 0.0;
        let position: Vec<f64> = velocity
            .iter()
            .map(|v| {
                x += v * 1e-3;
                x
            })
            .collect();
        let none = vec![0.0; 2000];
        let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
        let force = force_along(&model, &motion);
        assert!((force[400] - 5.0).abs() < 1e-12);
        for k in [502, 600, 900, 1700_usize] {
            let since = position[499] - position[k];
            let exact = -5.0 - 3.0 * (-since / 0.01).exp();
            assert!((force[k] - exact).abs() < 1e-9, "{k}: {} {exact}", force[k]);
        }
    }

    #[test]
    fn it_begins_as_the_axis_came_there_and_at_rest_as_at_a_reversal() {
        let state = |velocity: f64, came: Option<Came>| {
            let mut state = [f64::NAN; 2];
            ReversalDecay.start(&[3.0, 0.01], &Begun { velocity, came }, &mut state);
            state
        };
        let came = Came { way: -0.02, rested: Some(0.0) };
        assert_eq!(state(-0.1, Some(came)), [0.02, -1.0]);
        assert_eq!(state(0.0, Some(Came { rested: Some(2.0), ..came })), [0.02, -1.0]);
        assert_eq!(state(0.0, None), [0.0, 0.0]);
        assert_eq!(state(0.1, None), [FAR, 1.0]);
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let left = along_and_simulated(&[("reversal-decay", &VALUES)], None);
        assert!(left < 0.01, "{left}");
    }

    /// Position after three reversals, in steps of at most `step`.
    fn moved(step: f64) -> f64 {
        let model = Model::new(Axis::Linear, 5.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
            .and_then(|m| m.with("reversal-decay", &VALUES))
            .unwrap();
        let time: Vec<f64> = (0..=20).map(|k| f64::from(k) * 0.1).collect();
        let force: Vec<f64> = time.iter().map(|t| 25.0 * (6.0 * t).sin()).collect();
        let input = Input::new(&time, &force, Hold::Sampled).with_max_step(step);
        simulate(&model, &input, &Start::at(0.0, 0.0)).unwrap().position[20]
    }

    #[test]
    fn a_smaller_step_comes_nearer() {
        let exact = moved(1e-5);
        let (coarse, fine) = ((moved(4e-3) - exact).abs(), (moved(2.5e-4) - exact).abs());
        assert!(fine < coarse / 30.0, "{coarse:e} {fine:e}");
    }
}
