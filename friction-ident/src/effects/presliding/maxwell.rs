//! Generalised Maxwell slip: springs in parallel that slip one after the other.

use super::{
    About, Before, Begin, Correction, Effect, Element, Onset, Parameter, Parameters, Quantity,
    Response, SHOWS, STIFFNESS, Slot, Step, as_far,
};
use crate::effects::CDynamics;
use crate::effects::c_dynamics::LIMITED;
use crate::simd::{limited, vectorised};

/// Number of elements.
const ELEMENTS: usize = 4;

/// Four Jenkins elements with a quarter of the level each; each breaks at `spread` times the
/// displacement of the one before. `k_t` is the stiffness of all together before the first breaks.
///
/// Reversals inside reversals close their loops (nonlocal memory), which a single spring does not
/// show.
#[derive(Clone, Copy, Debug)]
pub struct MaxwellSlip;

static ABOUT: About = About {
    name: "presliding:maxwell-slip",
    title: "pre-sliding displacement, generalised Maxwell slip",
    equation: "sum_{i=1..4} f_i instead of level s, f_i' = k_i v, |f_i| <= level/4, k_i ~ spread^-i, sum k_i = k_t",
    parameters: &[
        STIFFNESS,
        Parameter::shape(
            "spread",
            "ratio of successive breakaway distances",
            Quantity::One,
            (1.1, 10.0),
            2.5,
        ),
    ],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "F. Al-Bender, V. Lampaert, J. Swevers, IEEE TAC 50, 2005",
};

impl Effect for MaxwellSlip {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["spread"]
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 4,
            helpers: &[LIMITED],
            load: "{s0} = {s1} = {s2} = {s3} = level * used / 4.0;",
            respond: "{
    const double cap = m->level / 4.0, q = 1.0 / {spread}, sum = 1.0 + q + q * q + q * q * q;
    double share = 1.0;
    int e;
    for (e = 0; e < 4; e++) {
        const double k = {k_t} * share / sum, held = limited((&{s0})[e], cap), trial = held + k * m->displacement;
        m->elements += 0.5 * (held + limited(trial, cap));
        m->stiffness += fabs(trial) <= cap ? 0.5 * k : 0.0;
        share /= {spread};
    }
}",
            commit: "{
    const double cap = m->level / 4.0, q = 1.0 / {spread}, sum = 1.0 + q + q * q + q * q * q;
    double share = 1.0;
    int e;
    for (e = 0; e < 4; e++) {
        const double k = {k_t} * share / sum;
        (&{s0})[e] = limited(limited((&{s0})[e], cap) + k * m->displacement, cap);
        share /= {spread};
    }
}",
            sliding: "fabs({s0} + {s1} + {s2} + {s3}) >= 0.999 * m->level ? 1.0 : 0.0",
            iterations: 5,
            ..CDynamics::NONE
        })
    }

    fn gives(&self, values: &[f64], level: f64) -> Option<f64> {
        Some(level / values[0])
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("presliding:free")
    }

    fn begins_flexible(&self, before: &Before<'_>) -> Begin {
        as_far(before)
    }

    fn few_trials(&self) -> Option<&'static [usize]> {
        Some(&[6, 1])
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

/// Stiffnesses of the elements.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn stiffnesses(total: f64, spread: f64) -> [f64; ELEMENTS] {
    let per = 1.0 / spread;
    let first = total / (1.0 + per * (1.0 + per * (1.0 + per)));
    let second = first * per;
    let third = second * per;
    [first, second, third, third * per]
}

vectorised! {
    fn respond(
        total: &[f64],
        spread: &[f64],
        moved: &[f64],
        level: &[f64],
        state: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let (total, spread, moved) = (&total[..n], &spread[..n], &moved[..n]);
        let (level, slope) = (&level[..n], &mut slope[..n]);
        let state: [&[f64]; ELEMENTS] = std::array::from_fn(|e| &state[e * n..][..n]);
        for i in 0..n {
            let cap = level[i] / ELEMENTS as f64;
            let stiffness = stiffnesses(total[i], spread[i]);
            let (mut sum, mut bends) = (0.0, 0.0);
            for e in 0..ELEMENTS {
                let held = limited(state[e][i], cap);
                let trial = held + stiffness[e] * moved[i];
                sum += 0.5 * (held + limited(trial, cap));
                bends += if trial.abs() <= cap { 0.5 * stiffness[e] } else { 0.0 };
            }
            force[i] += sum;
            slope[i] += bends;
        }
    }

    fn commit(total: &[f64], spread: &[f64], moved: &[f64], level: &[f64], state: &mut [f64]) {
        let n = level.len();
        let (total, spread, moved) = (&total[..n], &spread[..n], &moved[..n]);
        let (first, rest) = state.split_at_mut(n);
        let (second, rest) = rest.split_at_mut(n);
        let (third, fourth) = rest.split_at_mut(n);
        let fourth = &mut fourth[..n];
        for i in 0..n {
            let cap = level[i] / ELEMENTS as f64;
            let stiffness = stiffnesses(total[i], spread[i]);
            let end = |held: f64, e: usize| limited(limited(held, cap) + stiffness[e] * moved[i], cap);
            first[i] = end(first[i], 0);
            second[i] = end(second[i], 1);
            third[i] = end(third[i], 2);
            fourth[i] = end(fourth[i], 3);
        }
    }
}

impl Element for MaxwellSlip {
    fn states(&self) -> usize {
        ELEMENTS
    }

    fn start(&self, _p: &[f64], at: &Onset, state: &mut [f64]) {
        state.fill(at.level * at.used / ELEMENTS as f64);
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let (moved, level) = (step.displacement, step.level);
        respond(p.get(0), p.get(1), moved, level, state, out.force, out.stiffness);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        commit(p.get(0), p.get(1), step.displacement, step.level, state);
    }

    /// Elements that slide go on sliding; those that hold are bent.
    fn correct(&self, p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        let lanes = c.level.len();
        for i in 0..lanes {
            let cap = c.level[i] / ELEMENTS as f64;
            for (e, stiffness) in stiffnesses(p.get(0)[i], p.get(1)[i]).into_iter().enumerate() {
                let held = &mut state[e * lanes + i];
                let bent = limited(*held + stiffness * c.displacement[i], cap);
                *held = if held.abs() < cap { bent } else { *held };
            }
        }
    }

    fn iterations(&self) -> usize {
        // One kink each on either side: Newton needs no more steps than there are pieces.
        ELEMENTS + 1
    }

    fn force(&self, _p: &[f64], state: &[f64]) -> Option<f64> {
        Some(state.iter().sum())
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::walk;
    use super::*;

    #[test]
    fn it_starts_with_the_full_stiffness_and_ends_at_the_level() {
        let force = walk(&MaxwellSlip, &[2e6, 2.0], &[1e-8, 1e-3], 5.0);
        assert!((force[0] - 0.02).abs() < 1e-12);
        assert!((force[1] - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_loop_inside_a_loop_closes_and_leaves_no_trace() {
        let (out, inner) = (vec![1e-7; 60], vec![1e-7; 15]);
        let back: Vec<f64> = inner.iter().map(|x| -x).collect();
        let detour = [out.clone(), back, inner, vec![1e-7; 10]].concat();
        let straight = [out, vec![1e-7; 10]].concat();
        let p = [2e6, 2.0];
        let (a, b) = (walk(&MaxwellSlip, &p, &detour, 5.0), walk(&MaxwellSlip, &p, &straight, 5.0));
        assert!((a.last().unwrap() - b.last().unwrap()).abs() < 1e-9);
    }
}
