//! Dahl's and `LuGre`'s contact: a bristle whose force approaches the friction level smoothly.

use super::{
    About, Before, Begin, Correction, Effect, Element, Onset, Parameter, Parameters, Quantity,
    Response, SHOWS, STIFFNESS, Slot, Step, as_far,
};
use crate::effects::CDynamics;
use crate::effects::Leg;
use crate::effects::c_dynamics::LIMITED;
use crate::simd::{exp, limited, vectorised};

/// `f' = k_t v (1 - f s / level)`, with `LuGre` and a damping `sigma_1 z'` of the bristle.
///
/// With the `stribeck` effect in the level this is the `LuGre` model; its viscous term is the effect
/// `viscous`.
#[derive(Clone, Copy, Debug)]
pub struct Bristle {
    damped: bool,
}

pub static DAHL: Bristle = Bristle { damped: false };
pub static LUGRE: Bristle = Bristle { damped: true };

static DAHL_ABOUT: About = About {
    name: "presliding:dahl",
    title: "pre-sliding displacement, Dahl",
    equation: "F instead of level s, F' = k_t v (1 - F s/level)",
    parameters: &[STIFFNESS],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "P. R. Dahl, AIAA J. 14, 1976",
};
static LUGRE_ABOUT: About = About {
    name: "presliding:lugre",
    title: "pre-sliding displacement, LuGre",
    equation: "k_t z + sigma_1 z' instead of level s, z' = v (1 - k_t z s/level)",
    parameters: &[
        STIFFNESS,
        Parameter::shape("sigma_1", "damping of the bristle", Quantity::Damping, (1.0, 1e5), 1e3),
    ],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "C. Canudas de Wit, H. Olsson, K. J. Astrom, P. Lischinsky, IEEE TAC 40, 1995",
};

/// Helper functions in C.
const BRISTLE_IN_C: &str = include_str!("../../export/c/bristle.c");

/// A bristle, whose own damping is `$damping`.
macro_rules! bristle {
    ($damping:literal) => {
        CDynamics {
            states: 1,
            helpers: &[LIMITED, BRISTLE_IN_C],
            load: "{s0} = level * used;",
            respond: concat!(
                "{
    const double held = limited({s0}, m->level);
    double slope;
    const double end = bristle(held, m->displacement, {k_t}, m->level, &slope);
    const double rate = ",
                $damping,
                " / ({k_t} * fmax(m->left, DBL_MIN));
    m->elements += 0.5 * (held + end) + rate * (end - held);
    m->stiffness += (0.5 + rate) * slope;
}"
            ),
            commit: "{
    double slope;
    {s0} = bristle({s0}, m->displacement, {k_t}, m->level, &slope);
}",
            sliding: "fabs({s0}) >= 0.999 * m->level ? 1.0 : 0.0",
            iterations: 5,
            ..CDynamics::NONE
        }
    };
}

impl Effect for Bristle {
    fn about(&self) -> &'static About {
        if self.damped { &LUGRE_ABOUT } else { &DAHL_ABOUT }
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(if self.damped { bristle!("{sigma_1}") } else { bristle!("0.0") })
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["sigma_1"]
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

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

impl Bristle {
    fn damping(self, p: Parameters<'_>, i: usize) -> f64 {
        if self.damped { p.get(1)[i] } else { 0.0 }
    }
}

vectorised! {
    fn respond(
        stiffness: &[f64],
        damping: &[f64],
        damped: f64,
        duration: &[f64],
        moved: &[f64],
        level: &[f64],
        state: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = state.len();
        let (stiffness, damping, duration) = (&stiffness[..n], &damping[..n], &duration[..n]);
        let (moved, level) = (&moved[..n], &level[..n]);
        let (force, slope) = (&mut force[..n], &mut slope[..n]);
        for i in 0..n {
            let held = limited(state[i], level[i]);
            let (end, bends) = bent(held, moved[i], stiffness[i], level[i]);
            // The bristle's own velocity is its deflection over the step.
            let rate = damped * damping[i] / (stiffness[i] * duration[i].max(f64::MIN_POSITIVE));
            force[i] += 0.5 * (held + end) + rate * (end - held);
            slope[i] += (0.5 + rate) * bends;
        }
    }

    fn commit(stiffness: &[f64], moved: &[f64], level: &[f64], state: &mut [f64]) {
        let n = state.len();
        let (stiffness, moved, level) = (&stiffness[..n], &moved[..n], &level[..n]);
        for i in 0..n {
            state[i] = bent(state[i], moved[i], stiffness[i], level[i]).0;
        }
    }
}

/// Force after a displacement, exact at constant level, and its slope.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn bent(held: f64, moved: f64, stiffness: f64, level: f64) -> (f64, f64) {
    let level = level.max(f64::MIN_POSITIVE);
    let held = limited(held, level);
    let limit = level.copysign(moved);
    let left = exp(-stiffness * moved.abs() / level);
    (limit + (held - limit) * left, stiffness * (1.0 - held * moved.signum() / level) * left)
}

impl Element for Bristle {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, _p: &[f64], at: &Onset, state: &mut [f64]) {
        state[0] = at.level * at.used;
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let (damping, damped) = if self.damped { (p.get(1), 1.0) } else { (p.get(0), 0.0) };
        let (time, moved, level) = (step.duration, step.displacement, step.level);
        respond(p.get(0), damping, damped, time, moved, level, state, out.force, out.stiffness);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        commit(p.get(0), step.displacement, step.level, state);
    }

    /// Bent by the share that does not slide already. Fed through the contact as if the mass had moved, noise of
    /// alternating sign would unload a sliding contact twice as fast as it loads it again.
    fn correct(&self, p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        for (i, state) in state.iter_mut().enumerate() {
            let level = c.level[i];
            let held = limited(*state, level);
            let used = held / level.max(f64::MIN_POSITIVE);
            *state = limited(held + p.get(0)[i] * c.displacement[i] * (1.0 - used * used), level);
        }
    }

    fn iterations(&self) -> usize {
        // Smooth on either side of no displacement: Newton is quadratic there.
        5
    }

    fn force(&self, _p: &[f64], state: &[f64]) -> Option<f64> {
        Some(state[0])
    }

    fn along(&self, p: &[f64], path: &[Leg], state: &mut [f64], force: &mut [f64]) {
        for (leg, force) in path.iter().zip(force) {
            let before = limited(state[0], leg.level);
            state[0] = bent(before, leg.displacement, p[0], leg.level).0;
            let rate = if leg.duration > 0.0 { (state[0] - before) / leg.duration } else { 0.0 };
            *force = state[0] + self.damping(Parameters::new(p, 1), 0) / p[0] * rate;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{mean, walk};
    use super::*;

    #[test]
    fn the_force_approaches_the_level_exponentially_from_the_stiffness() {
        let force = walk(&DAHL, &[2e6], &[1e-6; 20], 5.0);
        for (k, force) in force.iter().enumerate() {
            let exact = 5.0 * (1.0 - (-2e6 * 1e-6 * (k + 1) as f64 / 5.0).exp());
            assert!((force - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn the_slope_of_the_response_is_its_derivative() {
        let mean = |moved: f64| mean(&LUGRE, &[2e6, 3e3], &[1.5], moved);
        for moved in [-3e-6, -1e-7, 1e-7, 2e-6] {
            let numeric = (mean(moved + 1e-10).0 - mean(moved - 1e-10).0) / 2e-10;
            assert!((mean(moved).1 / numeric - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn the_bristle_damping_adds_to_a_fast_deflection_alone() {
        let p = [2e6, 3e3];
        let force = walk(&LUGRE, &p, &[1e-7, 1e-3], 5.0);
        let elastic = walk(&DAHL, &p[..1], &[1e-7, 1e-3], 5.0);
        let expected = elastic[0] + 3e3 / 2e6 * elastic[0] / 1e-3;
        assert!((force[0] - expected).abs() < 1e-12);
    }
}
