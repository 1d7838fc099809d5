//! What the friction level remembers: the velocity a while ago, and how much of the static hump the
//! last slide has left.

use crate::effects::{Parameters, Sampled};
use crate::model::ModelEffect;

use super::delay::Delay;
use super::state::MotionState;

/// Time of the first memory of this kind among `terms`, s.
fn time_of(kind: Sampled, terms: &[ModelEffect]) -> Option<f64> {
    let is_of_kind = |term: &&ModelEffect| {
        term.effect().memory().is_some_and(|memory| memory.sampled() == Some(kind))
    };
    terms.iter().find(is_of_kind).map(|term| term.values()[0])
}

/// The velocity that the friction level follows.
#[derive(Clone, Debug)]
pub(super) struct Follower {
    delay: Option<Delay>,
    /// What is left of the past after a sample, and the state.
    lag: Option<(f64, f64)>,
}

impl Follower {
    /// As the memories among `terms` say, sampled every `sample_time` s, from rest.
    pub fn new(terms: &[ModelEffect], sample_time: f64) -> Self {
        Self {
            delay: time_of(Sampled::Delay, terms).map(|delay| Delay::new(delay / sample_time)),
            lag: time_of(Sampled::Lag, terms).map(|lag| ((-sample_time / lag).exp(), 0.0)),
        }
    }

    /// The delay line, if there is one.
    pub fn delay(&self) -> Option<&Delay> {
        self.delay.as_ref()
    }

    /// What is left of the past after a sample, where there is a lag.
    pub fn decay(&self) -> Option<f64> {
        self.lag.map(|(decay, _)| decay)
    }

    /// Takes the newest velocity and gives what the level follows, m/s or rad/s.
    pub fn follow(&mut self, velocity: f64) -> f64 {
        if let Some(delay) = &mut self.delay {
            return delay.pass(velocity);
        }
        if let Some((decay, state)) = &mut self.lag {
            let speed = velocity.abs();
            *state = speed + (*state - speed) * *decay;
            return *state;
        }
        velocity
    }
}

/// How much of the static hump there is, 0..1: `F_sb / F_s,inf` of the paper.
#[derive(Clone, Debug)]
pub(super) struct Bond {
    gamma: f64,
    /// What the last slide has left, `F_sa / F_s,inf`.
    left: f64,
    formed: f64,
    slipped: bool,
}

impl Bond {
    /// The memory of the hump among `terms`, after a long rest.
    pub fn new(terms: &[ModelEffect]) -> Option<Self> {
        let gamma = time_of(Sampled::Bond, terms)?;
        Some(Self { gamma, left: 1.0, formed: 1.0, slipped: false })
    }

    /// Dwell after which half has grown, s.
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Takes the state of the motion; `share` is what the velocity leaves of the hump. Gives the bond.
    pub fn see(&mut self, state: &MotionState, share: f64) -> f64 {
        if self.slipped && !state.slips() {
            self.left = self.formed * share;
        }
        if !(self.slipped && state.slips()) {
            let dwell = state.dwell();
            self.formed = self.left + (1.0 - self.left) * (dwell / (dwell + self.gamma));
        }
        self.slipped = state.slips();
        self.formed
    }
}

/// Share of the static hump that is left at the velocity that the level follows.
pub(super) fn hump(terms: &[ModelEffect], level_velocity: f64) -> f64 {
    let mut share = [1.0];
    for term in terms {
        term.effect().hump(Parameters::new(term.values(), 1), &[level_velocity], &mut share);
    }
    share[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::model::Model;

    #[test]
    fn the_hump_grows_back_from_what_the_slide_left() {
        let model = Model::new(Axis::Linear, 1.0)
            .unwrap()
            .with("rising-static-friction:bond", &[("gamma", 0.01)])
            .unwrap();
        let mut bond = Bond::new(model.terms()).unwrap();
        let mut state = MotionState::new(1e-3, 5e-3);
        let mut seen = Vec::new();
        for velocity in [0.0, 0.1, 0.1, 0.0, 0.0, 0.0, 0.1] {
            state.see(velocity);
            seen.push(bond.see(&state, 0.2));
        }
        // Full at first; a fifth is left by the slide; half of the rest is back after gamma.
        let exact = [1.0, 1.0, 1.0, 0.2, 0.2 + 0.8 / 3.0, 0.6, 0.6];
        for (seen, exact) in seen.iter().zip(exact) {
            assert!((seen - exact).abs() < 1e-12, "{seen} {exact}");
        }
    }

    #[test]
    fn the_lag_follows_a_step_exponentially() {
        let model = Model::new(Axis::Linear, 1.0)
            .unwrap()
            .with("frictional-memory:lag", &[("tau_L", 0.02)])
            .unwrap();
        let mut follower = Follower::new(model.terms(), 5e-3);
        for k in 1..20 {
            let exact = 1.0 - (-f64::from(k) * 0.25).exp();
            assert!((follower.follow(1.0) - exact).abs() < 1e-12);
        }
    }
}
