//! Rising static friction: the longer the rest, the harder the breakaway.

mod ageing;
mod healing;

use super::{
    About, Begun, CLaw, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled, Slot, Taken,
};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::Sampled;
use crate::simd::vectorised;

/// An extra level that grows with the time at rest and fades with speed.
#[derive(Clone, Copy, Debug)]
pub struct RisingStaticFriction;

/// The hump of `stribeck` itself grows back during rest from what the last slide left of it:
/// `bond = a + (1 - a) t / (t + gamma)`, `a = bond share(v)` at the end of the slide.
#[derive(Clone, Copy, Debug)]
struct Bond;

const GAMMA: Parameter =
    Parameter::shape("gamma", "dwell after which half has grown", Quantity::Time, (1e-6, 1e3), 1.0);
const SHOWS: &str = "breakaway peak against the logarithm of the dwell time; nothing while sliding";
const REFERENCE: &str = "S. Kato, N. Sato, T. Matsubayashi, J. Lubrication Technology 94, 1972; B. \
                         Armstrong-Helouvry et al., Automatica 30, 1994";

static ABOUT: About = About {
    name: "rising-static-friction",
    title: "rising static friction",
    equation: "dF t2/(t2 + gamma) / (1 + (v/v_s)^2) s, t2 = dwell time",
    parameters: &[
        Parameter::level("dF", "extra level after a long rest", Quantity::Force, 200.0, 2.0),
        GAMMA,
        Parameter::shape(
            "v_s",
            "velocity at which half is broken",
            Quantity::Velocity,
            (1e-6, 100.0),
            1e-3,
        ),
    ],
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: REFERENCE,
};
static BOND_ABOUT: About = About {
    name: "rising-static-friction:bond",
    title: "rising static friction, of the Stribeck hump",
    equation: "stribeck's dF times b, b = a + (1 - a) t2/(t2 + gamma), a = b / (1 + (v/v_s)^2) at the end of the last slide",
    parameters: &[GAMMA],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: REFERENCE,
};
static BOND: Bond = Bond;
static FORMS: [&dyn Effect; 3] = [&BOND, &ageing::Ageing, &healing::Healing];

impl Effect for RisingStaticFriction {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            level: "level += {dF} * dwell / (dwell + {gamma}) / (1.0 + (w / {v_s}) * (w / {v_s}));",
            ..CLaw::NONE
        })
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        for (i, level) in level.iter_mut().enumerate() {
            let u = m.level_velocity[i] / p.get(2)[i];
            *level += p.get(0)[i] * m.dwell[i] / (m.dwell[i] + p.get(1)[i]) / (1.0 + u * u);
        }
    }

    fn reads_dwell(&self) -> bool {
        true
    }
}

impl Effect for Bond {
    fn about(&self) -> &'static About {
        &BOND_ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 3,
            start: "{s0} = 1.0;\n{s1} = 1.0;\n{s2} = velocity != 0.0 ? 1.0 : 0.0;",
            recall: "m->bond = {s2} > 0.0 ? {s1} : {s0} + (1.0 - {s0}) * m->dwell / (m->dwell + {gamma});",
            remember: "{
    const int was = {s2} > 0.0, is = m->sliding > 0.0;
    const double grown = {s0} + (1.0 - {s0}) * m->dwell / (m->dwell + {gamma});
    {s0} = was && !is ? {s1} * m->hump : {s0};
    {s1} = was ? {s1} : grown;
    {s2} = m->sliding;
}",
            ..CDynamics::NONE
        })
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::NONE)
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }

    fn reads_dwell(&self) -> bool {
        true
    }
}

/// States: what the last slide left, the bond while sliding, 1 while sliding.
impl Memory for Bond {
    fn sampled(&self) -> Option<Sampled> {
        Some(Sampled::Bond)
    }

    fn states(&self) -> usize {
        3
    }

    fn start(&self, _p: &[f64], begun: &Begun, state: &mut [f64]) {
        state.copy_from_slice(&[1.0, 1.0, f64::from(u8::from(begun.velocity != 0.0))]);
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        _past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        let (left, rest) = state.split_at(out.bond.len());
        let (formed, slides) = rest.split_at(out.bond.len());
        recall(p.get(0), m.dwell, left, formed, slides, out.bond);
    }

    fn takes_hump(&self) -> bool {
        true
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        let (left, rest) = state.split_at_mut(taken.sliding.len());
        let (formed, slides) = rest.split_at_mut(taken.sliding.len());
        remember(p.get(0), taken.sliding, taken.dwell, taken.hump, left, formed, slides);
    }
}

vectorised! {
    fn recall(
        gamma: &[f64],
        dwell: &[f64],
        left: &[f64],
        formed: &[f64],
        slides: &[f64],
        bond: &mut [f64],
    ) {
        let n = bond.len();
        let (gamma, dwell, left) = (&gamma[..n], &dwell[..n], &left[..n]);
        let (formed, slides) = (&formed[..n], &slides[..n]);
        for i in 0..n {
            let grown = grown(left[i], dwell[i], gamma[i]);
            bond[i] = if slides[i] > 0.0 { formed[i] } else { grown };
        }
    }

    fn remember(
        gamma: &[f64],
        sliding: &[f64],
        dwell: &[f64],
        hump: &[f64],
        left: &mut [f64],
        formed: &mut [f64],
        slides: &mut [f64],
    ) {
        let n = sliding.len();
        let (gamma, dwell, hump) = (&gamma[..n], &dwell[..n], &hump[..n]);
        let (left, formed, slides) = (&mut left[..n], &mut formed[..n], &mut slides[..n]);
        for i in 0..n {
            let (was, is) = (slides[i] > 0.0, sliding[i] > 0.0);
            let grown = grown(left[i], dwell[i], gamma[i]);
            left[i] = if was && !is { formed[i] * hump[i] } else { left[i] };
            formed[i] = if was { formed[i] } else { grown };
            slides[i] = sliding[i];
        }
    }
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn grown(left: f64, dwell: f64, gamma: f64) -> f64 {
    left + (1.0 - left) * dwell / (dwell + gamma)
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;
    use crate::axis::Axis;
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    #[test]
    fn half_the_extra_level_has_grown_after_gamma_and_it_fades_with_speed() {
        let at = |dwell, v| {
            let point = Point { dwell, ..Point::at(0.0, v) };
            level(&RisingStaticFriction, &[3.0, 2.0, 1e-3], point)
        };
        assert_eq!((at(0.0, 0.0), at(2.0, 0.0), at(2.0, 1e-3)), (0.0, 1.5, 0.75));
        assert!((at(1e9, 0.0) - 3.0).abs() < 1e-6);
    }

    /// Force at which a table breaks away after `dwell` s of rest, following a slide.
    pub(super) fn breakaway(effect: &str, values: &[(&str, f64)], dwell: f64) -> f64 {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
            .and_then(|m| m.with("stribeck", &[("dF", 2.0), ("v_s", 1e-3)]))
            .and_then(|m| m.with(effect, values))
            .unwrap();
        let time: Vec<f64> =
            (0..((dwell + 2.2) * 1e3) as u32).map(|k| f64::from(k) * 1e-3).collect();
        // Slides to a stop within 0.1 s; then a ramp of 10 N/s from 4.9 N begins.
        let ramp = |t: f64| if t < dwell { 0.0 } else { 4.9 + 10.0 * (t - dwell) };
        let force: Vec<f64> = time.iter().map(|t| ramp(*t)).collect();
        let input = Input::new(&time, &force, Hold::Sampled).with_max_step(1e-4);
        let out = simulate(&model, &input, &Start::at(0.0, 0.2)).unwrap();
        let start = (dwell * 1e3) as usize;
        let first = out.velocity.iter().skip(start).position(|v| *v > 0.0).unwrap();
        force[start + first]
    }

    #[test]
    fn the_breakaway_force_follows_the_dwell_law() {
        for dwell in [0.3, 1.0, 5.0] {
            let values = [("dF", 3.0), ("gamma", 0.5), ("v_s", 1e-3)];
            let force = breakaway("rising-static-friction", &values, dwell);
            // Rest begins at about 0.03 s and ends when the force is reached.
            let rest = dwell - 0.03 + (force - 4.9) / 10.0;
            let exact = 7.0 + 3.0 * rest / (rest + 0.5);
            assert!((force - exact).abs() < 0.06, "{dwell} s: {force} against {exact}");
        }
    }

    #[test]
    fn the_bond_of_the_hump_grows_back_during_rest() {
        // A slide that stops leaves the hump as it is at v = 0 (here: in the middle of its last
        // step), and nearly nothing can grow any more.
        let force = breakaway("rising-static-friction:bond", &[("gamma", 0.5)], 1.0);
        assert!((force - 7.0).abs() < 0.1, "{force}");
        let mut state = [1.0, 1.0, 1.0];
        let (p, dwell) = ([0.5], [0.0]);
        let p = Parameters::new(&p, 1);
        let mut taken = Taken {
            duration: &[1e-3],
            displacement: &[0.0],
            sliding: &[0.0],
            dwell: &dwell,
            hump: &[0.2],
        };
        Bond.remember(p, &taken, &mut state);
        assert_eq!(state, [0.2, 1.0, 0.0]);
        taken.dwell = &[0.5];
        Bond.remember(p, &taken, &mut state);
        assert!((state[1] - 0.6).abs() < 1e-12);
    }
}
