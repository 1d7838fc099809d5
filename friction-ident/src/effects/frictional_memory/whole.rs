//! Frictional memory of the whole friction curve: the viscous part follows, too.

use super::{LAGGED, SHOWS, TIME};
use crate::axis::Quantity;
use crate::effects::{
    About, Begun, CDynamics, CLaw, Effect, Memory, Motion, Parameter, Parameters, Past, Recalled,
    Slot, Taken,
};
use crate::simd::vectorised;

/// As [`super::Lagged`], and a viscous friction `F_w w` follows the speed with the level, against the motion as it is: what a
/// film of oil does that must build up first. Without a hump beside it the viscous friction alone follows. None of it is
/// negative: that is a body which is dragged along behind a damper.
#[derive(Clone, Copy, Debug)]
pub struct Whole;

static ABOUT: About = About {
    name: "frictional-memory:whole",
    title: "frictional memory of level and viscous friction",
    equation: "the friction level follows w with tau_L w' + w = |v|; F_w w s beside it",
    parameters: &[
        Parameter { high: 1.0, ..TIME },
        Parameter::level("F_w", "viscous friction that follows", Quantity::Damping, 5000.0, 200.0),
    ],
    slots: &[Slot::Memory],
    shows: SHOWS,
    reference: "D. P. Hess, A. Soom, J. Tribology 112, 1990 (a delay there)",
};

impl Effect for Whole {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            recall: "m->level_velocity = {s0};
m->remembered += {F_w} * {s0};",
            ..LAGGED.c_dynamics()?
        })
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::NONE)
    }

    /// None of it may follow.
    fn whatever(&self) -> &'static [&'static str] {
        &["F_w"]
    }

    /// By itself it gains beside a delay that leaves nothing, too.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn memory(&self) -> Option<&dyn Memory> {
        Some(self)
    }
}

/// The state of [`super::Lagged`].
impl Memory for Whole {
    fn states(&self) -> usize {
        LAGGED.states()
    }

    fn start(&self, p: &[f64], begun: &Begun, state: &mut [f64]) {
        LAGGED.start(p, begun, state);
    }

    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    ) {
        LAGGED.recall(p, m, past, state, out);
        recall(p.get(1), state, out.level);
    }

    fn remember(&self, p: Parameters<'_>, taken: &Taken<'_>, state: &mut [f64]) {
        LAGGED.remember(p, taken, state);
    }
}

vectorised! {
    fn recall(damping: &[f64], state: &[f64], level: &mut [f64]) {
        let n = level.len();
        let (damping, state) = (&damping[..n], &state[..n]);
        for i in 0..n {
            level[i] += damping[i] * state[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::effects::testing::along_and_simulated;
    use crate::model::Model;

    #[test]
    fn both_follow_a_ramp_with_the_same_delay_in_the_end() {
        let model = Model::new(Axis::Linear, 1.0)
            .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 5e-3)]))
            .and_then(|m| m.with("frictional-memory:whole", &[("tau_L", 0.02), ("F_w", 300.0)]))
            .unwrap();
        let time: Vec<f64> = (0..300).map(|k| f64::from(k) * 1e-3).collect();
        let velocity: Vec<f64> = time.iter().map(|t| 0.1 * t).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.05 * t * t).collect();
        let none = vec![0.0; 300];
        let motion = MeasuredMotion::new(&time, &position, &velocity, &none).unwrap();
        for (t, force) in time.iter().zip(force_along(&model, &motion)).skip(1) {
            let seen = 0.1 * (t - 0.02 * (1.0 - (-t / 0.02).exp()));
            let exact = 4.0 / (1.0 + (seen / 5e-3).powi(2)) + 300.0 * seen;
            assert!((force - exact).abs() < 0.03, "{t}: {force} {exact}");
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("tau_L", 0.01), ("F_w", 20.0)];
        let left = along_and_simulated(&[("frictional-memory:whole", &values)], None);
        assert!(left < 0.05, "{left}");
    }
}
