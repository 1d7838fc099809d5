//! Frictional memory: the friction follows the velocity with a delay.

mod whole;

use super::{
    About, Before, Begin, Begun, CLaw, Effect, Memory, Motion, Parameter, Parameters, Past,
    Recalled, Slot, Taken,
};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::Sampled;
use crate::effects::c_dynamics::PAST;
use crate::simd::{exp, vectorised};

/// The level sees `v(t - tau_L)` instead of `v(t)`.
#[derive(Clone, Copy, Debug)]
pub struct FrictionalMemory;

/// The level sees the speed through a first-order lag, as a film of oil or the age of contacts follows it.
#[derive(Clone, Copy, Debug)]
struct Lagged;

/// What both forms are where the viscous friction follows, too.
const WHOLE: &str = "frictional-memory:whole";
const TIME: Parameter =
    Parameter::shape("tau_L", "delay of the friction", Quantity::Time, (1e-4, 0.2), 0.01);
const SHOWS: &str = "a loop in the residual against velocity that widens with |dv/dt|; not separable \
                     from stribeck at constant speed";

static ABOUT: About = About {
    name: "frictional-memory",
    title: "frictional memory",
    equation: "the friction level follows v(t - tau_L)",
    parameters: &[TIME],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: "D. P. Hess, A. Soom, J. Tribology 112, 1990",
};
static LAGGED_ABOUT: About = About {
    name: "frictional-memory:lag",
    title: "frictional memory, first order",
    equation: "the friction level follows w with tau_L w' + w = |v|",
    parameters: &[TIME],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: "A. Ruina, J. Geophysical Research 88, 1983 (state-variable friction)",
};
static LAGGED: Lagged = Lagged;
static FORMS: [&dyn Effect; 2] = [&LAGGED, &whole::Whole];

impl Effect for FrictionalMemory {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            helpers: &[PAST],
            slow: "{tau_L}",
            recall: "{
    const double then = m->when - {tau_L};
    const double newest = m->slow.time[m->slow.end - 1], last = m->slow.value[m->slow.end - 1];
    m->level_velocity = then > newest
        ? last + (then - newest) / (m->when - newest) * (m->predicted - last)
        : past_at(&m->slow, then);
}",
            ..CDynamics::NONE
        })
    }

    /// It delays what a Stribeck hump does.
    fn companion(&self) -> Option<&'static str> {
        Some("stribeck")
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::NONE)
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some(WHOLE)
    }

    /// With nothing of the viscous friction.
    fn begins_flexible(&self, _before: &Before<'_>) -> Begin {
        Begin::at([("F_w", 0.0)])
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

impl Memory for FrictionalMemory {
    fn sampled(&self) -> Option<Sampled> {
        Some(Sampled::Delay)
    }

    fn memory(&self, p: Parameters<'_>) -> f64 {
        p.get(0).iter().fold(0.0, |longest, delay| delay.max(longest))
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        past: &Past,
        _state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        for (i, seen) in out.level_velocity.iter_mut().enumerate() {
            let then = m.time[i] - p.get(0)[i];
            let (newest, last) = past.newest(i);
            *seen = if then > newest {
                // Within the step that is being taken.
                let share = (then - newest) / (m.time[i] - newest);
                last + share * (m.velocity[i] - last)
            } else {
                past.at(i, then)
            };
        }
    }
}

impl Effect for Lagged {
    fn about(&self) -> &'static About {
        &LAGGED_ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 1,
            start: "{s0} = fabs(velocity);",
            recall: "m->level_velocity = {s0};",
            remember: "if (m->taken > 0.0) {
    const double mean = fabs(m->displacement) / m->taken;
    {s0} = mean + ({s0} - mean) * exp(-m->taken / {tau_L});
}",
            ..CDynamics::NONE
        })
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::NONE)
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some(WHOLE)
    }

    /// With nothing of the viscous friction.
    fn begins_flexible(&self, _before: &Before<'_>) -> Begin {
        Begin::at([("F_w", 0.0)])
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

impl Memory for Lagged {
    fn sampled(&self) -> Option<Sampled> {
        Some(Sampled::Lag)
    }

    fn states(&self) -> usize {
        1
    }

    fn start(&self, _p: &[f64], begun: &Begun, state: &mut [f64]) {
        state[0] = begun.velocity.abs();
    }

    fn recall(
        &self,
        _p: Parameters<'_>,
        _m: &Motion<'_>,
        _past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        out.level_velocity.copy_from_slice(state);
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        follow(p.get(0), taken.duration, taken.displacement, state);
    }
}

vectorised! {
    /// Exact for the mean speed of a piece, which goes one way.
    fn follow(tau: &[f64], duration: &[f64], displacement: &[f64], state: &mut [f64]) {
        let n = state.len();
        let (tau, duration, displacement) = (&tau[..n], &duration[..n], &displacement[..n]);
        for i in 0..n {
            let goes = duration[i] > 0.0;
            let mean = displacement[i].abs() / if goes { duration[i] } else { 1.0 };
            let next = mean + (state[i] - mean) * exp(-duration[i] / tau[i]);
            state[i] = if goes { next } else { state[i] };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::breaks_away;
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::model::Model;

    /// Friction along a velocity ramp of 0.1 m/s^2 from rest, Stribeck hump of 4 N at 5 mm/s.
    fn ramp(memory: &str) -> Vec<f64> {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 5e-3)]))
            .and_then(|m| m.with(memory, &[("tau_L", 0.02)]))
            .unwrap();
        let time: Vec<f64> = (0..300).map(|k| f64::from(k) * 1e-3).collect();
        let velocity: Vec<f64> = time.iter().map(|t| 0.1 * t).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.05 * t * t).collect();
        let none = vec![0.0; 300];
        force_along(&model, &MeasuredMotion::new(&time, &position, &velocity, &none).unwrap())
    }

    fn hump(v: f64) -> f64 {
        4.0 / (1.0 + (v / 5e-3).powi(2))
    }

    #[test]
    fn the_hump_is_that_of_the_velocity_a_delay_ago() {
        for (k, force) in ramp("frictional-memory").iter().enumerate().skip(1) {
            let then = (0.1 * (k as f64 * 1e-3 - 0.02)).max(0.0);
            assert!((force - hump(then)).abs() < 1e-9, "sample {k}: {force}");
        }
    }

    #[test]
    fn the_first_order_form_follows_a_ramp_with_the_same_delay_in_the_end() {
        for (k, force) in ramp("frictional-memory:lag").iter().enumerate().skip(1) {
            let t = k as f64 * 1e-3;
            let seen = 0.1 * (t - 0.02 * (1.0 - (-t / 0.02).exp()));
            assert!((force - hump(seen)).abs() < 5e-3, "sample {k}: {force} {}", hump(seen));
        }
    }

    #[test]
    fn the_first_order_form_remembers_the_speed_through_a_reversal() {
        // As much hump at 0.1 m/s either way, and none of it comes back within a reversal far faster than the lag.
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 5e-3)]))
            .and_then(|m| m.with("frictional-memory:lag", &[("tau_L", 0.02)]))
            .unwrap();
        let time: Vec<f64> = (0..300).map(|k| f64::from(k) * 1e-4).collect();
        let velocity: Vec<f64> = time.iter().map(|t| if *t < 0.015 { 0.1 } else { -0.1 }).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.0015 - 0.1 * (t - 0.015).abs()).collect();
        let none = vec![0.0; 300];
        let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
        for (force, velocity) in force_along(&model, &motion).iter().zip(velocity) {
            assert!((force - hump(0.1) * velocity.signum()).abs() < 1e-3, "{force}");
        }
    }

    #[test]
    fn at_rest_the_hump_comes_back() {
        let model = Model::new(Axis::Linear, 2.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 3.0)]))
            .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 5e-3)]));
        for memory in ["frictional-memory", "frictional-memory:lag"] {
            let model = model.clone().and_then(|m| m.with(memory, &[("tau_L", 0.02)])).unwrap();
            let force = breaks_away(&model);
            assert!((force - 7.0).abs() < 0.02, "{memory}: {force}");
        }
    }
}
