//! Rising static friction that wears off over a way: junctions that grow at rest up to a limit and are sheared as they slide.

use crate::axis::Quantity;
use crate::effects::c_dynamics::PAST;
use crate::effects::memory::{BEGIN_OF_STEP, since_begin};
use crate::effects::{
    About, Begun, CDynamics, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled, Slot,
    Taken,
};
use crate::simd::{exp, vectorised};

/// `level += dF h`: at rest `h' = (1 - h)/gamma`, while it slides `h' = -h |v|/D_c`. It rises as `1 - exp(-t/gamma)` and is
/// gone after a few `D_c`, however fast.
#[derive(Clone, Copy, Debug)]
pub struct Healing;

static ABOUT: About = About {
    name: "rising-static-friction:healing",
    title: "rising static friction that wears off over a way",
    equation: "dF h s, h' = (1 - h)/gamma at rest, -h |v|/D_c while it slides",
    parameters: &[
        Parameter::level("dF", "extra level after a long rest", Quantity::Force, 200.0, 2.0),
        Parameter::shape(
            "gamma",
            "time at rest in which it comes, but for 1/e",
            Quantity::Time,
            (1e-3, 1e3),
            0.3,
        ),
        Parameter::shape(
            "D_c",
            "way over which it wears off, but for 1/e",
            Quantity::Length,
            (1e-7, 0.1),
            3e-5,
        ),
        Parameter::shape(
            "h_0",
            "how much of it has come where a recording begins at rest",
            Quantity::One,
            (0.0, 1.0),
            1.0,
        )
        .linear(),
    ],
    slots: &[Slot::Memory],
    shows: "breakaway peak against the dwell time, up to a limit; behind it the level falls over the same way at every speed",
    reference: "C.-L. Lee, A. A. Polycarpou, J. Tribology 129, 2007 (static friction and dwell time); A. Ruina, J. Geophysical \
                Research 88, 1983 (state that evolves with slip)",
};

impl Effect for Healing {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            helpers: &[PAST],
            slow: "1e-9",
            start: "{s0} = velocity == 0.0 ? 1.0 - {h_0} : 1.0;",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0);
    const double rested = m->predicted == 0.0 ? ahead / {gamma} : 0.0;
    m->remembered += {dF} * (1.0 - {s0} * exp(-rested)) * exp(-ahead * fabs(m->predicted) / {D_c});
}",
            remember: "{
    const double moved = m->sliding > 0.0 ? fabs(m->displacement) / {D_c} : 0.0;
    const double rested = m->sliding > 0.0 ? 0.0 : m->taken / {gamma};
    {s0} = 1.0 - (1.0 - {s0} * exp(-rested)) * exp(-moved);
}",
            ..CDynamics::NONE
        })
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }

    /// How long it had rested before belongs to the recording.
    fn whatever(&self) -> &'static [&'static str] {
        &["h_0"]
    }

    fn few_trials(&self) -> Option<&'static [usize]> {
        Some(&[5, 4, 2])
    }
}

/// State: `1 - h`, what has not grown.
impl Memory for Healing {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        let rested = begun.came.and_then(|came| came.rested);
        let lacks = rested.map_or(1.0 - p[3], |time| (-time / p[1]).exp());
        state[0] = if begun.velocity == 0.0 { lacks } else { 1.0 };
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
        remember(p, taken.duration, taken.displacement, taken.sliding, state);
    }
}

/// What has not grown after a piece at rest or of a slide, `rested` in units of `gamma`, `worn` of `D_c`.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn lacking(lacks: f64, rested: f64, worn: f64) -> f64 {
    1.0 - (1.0 - lacks * exp(-rested)) * exp(-worn)
}

vectorised! {
    fn recall(
        p: Parameters<'_>,
        begin: &[f64],
        now: &[f64],
        velocity: &[f64],
        lacks: &[f64],
        level: &mut [f64],
    ) {
        let n = level.len();
        let (size, gamma, way) = (&p.get(0)[..n], &p.get(1)[..n], &p.get(2)[..n]);
        let (begin, now, velocity, lacks) = (&begin[..n], &now[..n], &velocity[..n], &lacks[..n]);
        for i in 0..n {
            let ahead = since_begin(begin[i], now[i]);
            let rested = if velocity[i] == 0.0 { ahead / gamma[i] } else { 0.0 };
            level[i] += size[i] * (1.0 - lacking(lacks[i], rested, ahead * velocity[i].abs() / way[i]));
        }
    }

    fn remember(
        p: Parameters<'_>,
        duration: &[f64],
        displacement: &[f64],
        sliding: &[f64],
        lacks: &mut [f64],
    ) {
        let n = lacks.len();
        let (gamma, way) = (&p.get(1)[..n], &p.get(2)[..n]);
        let (duration, displacement) = (&duration[..n], &displacement[..n]);
        let sliding = &sliding[..n];
        for i in 0..n {
            // What an axis at rest seems to move is noise, or the vibration of its contact.
            let slides = sliding[i] > 0.0;
            let rested = if slides { 0.0 } else { duration[i] / gamma[i] };
            let worn = if slides { displacement[i].abs() / way[i] } else { 0.0 };
            lacks[i] = lacking(lacks[i], rested, worn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::breakaway;
    use super::*;
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::effects::Came;
    use crate::effects::testing::along_and_simulated;
    use crate::model::Model;

    const NAME: &str = "rising-static-friction:healing";
    const VALUES: [(&str, f64); 3] = [("dF", 3.0), ("gamma", 0.4), ("D_c", 5e-5)];

    #[test]
    fn it_comes_back_at_rest_and_wears_off_over_the_same_way_at_every_speed() {
        let plain = Model::new(Axis::Linear, 1.0).and_then(|m| m.with("coulomb", &[("F_C", 5.0)]));
        let model = plain.and_then(|m| m.with(NAME, &VALUES)).unwrap();
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        for speed in [0.1, 1.0] {
            // At rest for 1 s, behind a long time at rest.
            let velocity: Vec<f64> =
                time.iter().map(|t| if *t < 1.0 { 0.0 } else { 1e-2 * speed }).collect();
            let place = |t: f64| 1e-2 * speed * (t - 1.0).max(0.0);
            let position: Vec<f64> = time.iter().map(|t| place(*t)).collect();
            let none = vec![0.0; 2000];
            let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
            let force = force_along(&model, &motion);
            for k in [1010, 1050, 1500_usize] {
                let slid = 1e-2 * speed * (k as f64 - 999.5) * 1e-3;
                let exact = 5.0 + 3.0 * (-slid / 5e-5).exp();
                // The slide begins between two samples.
                assert!((force[k] - exact).abs() < 4e-2, "{speed} {k}: {} {exact}", force[k]);
            }
        }
    }

    #[test]
    fn it_begins_with_the_rest_so_far_or_with_what_is_said_of_the_recording() {
        let lacks = |velocity: f64, came: Option<Came>| {
            let mut state = [f64::NAN];
            Healing.start(&[3.0, 0.4, 5e-5, 0.7], &Begun { velocity, came }, &mut state);
            state[0]
        };
        let rested = |rested| Some(Came { way: 0.1, rested });
        assert!((lacks(0.0, rested(Some(0.4))) - (-1.0f64).exp()).abs() < 1e-12);
        assert!((lacks(0.0, rested(None)) - 0.3).abs() < 1e-12);
        assert!((lacks(0.0, None) - 0.3).abs() < 1e-12);
        assert!((lacks(0.1, None) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_breakaway_force_rises_to_a_limit() {
        for dwell in [0.3, 1.0, 5.0] {
            let force = breakaway(NAME, &VALUES, dwell);
            // Rest begins at about 0.03 s and ends when the force is reached.
            let rest = dwell - 0.03 + (force - 4.9) / 10.0;
            let exact = 7.0 + 3.0 * (1.0 - (-rest / 0.4).exp());
            assert!((force - exact).abs() < 0.1, "{dwell} s: {force} against {exact}");
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let left = along_and_simulated(&[(NAME, &VALUES)], None);
        // Within one sample at a breakaway most of it is gone.
        assert!(left < 0.03, "{left}");
    }
}
