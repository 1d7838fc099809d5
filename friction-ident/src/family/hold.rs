//! What the force does between two samples, decided by what predicts better.
//!
//! A command that is held from sample to sample and read as if it were sampled shows half a sample of delay, which
//! is no physics of the drive.

use missing_physics::ahead::fit::Fitter;
use missing_physics::ahead::statistics;
use missing_physics::report::{NamedValue, Refusal, Remark};
use missing_physics::{Fitted, Hold, ModelFamily, Recording, fit, terms};

use super::ahead::View;
use super::{FrictionFamily, Options, PreparationError};

/// Log-likelihood per sample from which the simplest model decides.
const CLEAR: f64 = 0.2;
/// Degrees of freedom of the errors.
const FREEDOM: f64 = 2.0;
/// Samples by which a force that is held comes later than one that was sampled, with what a fit may err.
const HELD: f64 = 0.55;
/// Steps of a fit at each process noise.
const STEPS: usize = 5;

/// What was decided about the force between samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldChoice {
    /// What predicts better.
    pub hold: Hold,
    /// Log-likelihood of the simplest model over that in the other reading, nats.
    pub nats: f64,
    /// Whether that is too little, so that the search decided.
    pub by_search: bool,
}

/// The family of a recording whose hold nobody stated, with the one that predicts better.
pub(super) fn decided(
    recording: &Recording,
    options: &Options,
) -> Result<FrictionFamily, PreparationError> {
    let with =
        |hold: Hold| FrictionFamily::as_recorded(&recording.clone().with_hold(hold), options);
    let (sampled, held) = (with(Hold::Sampled)?, with(Hold::ZeroOrder)?);
    let (a, b) = rayon::join(|| likelihood(&sampled), || likelihood(&held));
    let (Some(a), Some(b)) = (a, b) else { return Ok(sampled) };
    let nats = (a - b).abs();
    let by_search = nats < CLEAR * recording.len() as f64;
    let chosen = |family: FrictionFamily, by_search: bool| {
        let hold = Some(HoldChoice { hold: family.recording.hold(), nats, by_search });
        FrictionFamily { hold, ..family }
    };
    let (family, other) = if b > a { (held, sampled) } else { (sampled, held) };
    // Where the simplest model hardly tells the search itself has to, and only a search comes to the other one.
    let other_hold = Some(Box::new(chosen(other, true)));
    Ok(FrictionFamily { other_hold, ..chosen(family, by_search) })
}

impl HoldChoice {
    /// What was decided about this input.
    pub(super) fn remark(self, input: String) -> Remark {
        let Self { hold, nats, by_search } = self;
        Remark::Read { input, hold, nats, by_search }
    }
}

impl FrictionFamily {
    /// An effect beyond those of a base model that makes the force of the drive late by no more than half a sample, where
    /// nobody stated what the force does between samples: that of a controller which is faster than its recording, or which
    /// holds its command for some of the time, comes as late.
    pub(super) fn within_a_sample(
        &self,
        model: &Fitted,
        base: &Fitted,
    ) -> Option<(usize, Refusal)> {
        self.hold.filter(|choice| choice.hold == Hold::Sampled)?;
        let limit = HELD * self.prepared.interval;
        let mut added = model.terms.iter().enumerate().filter(|(_, t)| !base.terms.contains(t));
        added.find_map(|(place, &term)| {
            let effect = self.effect(term)?;
            let late = self.lateness(model, place)?;
            let refusal = Refusal::NotThatEffect {
                effect: effect.about().name.to_owned(),
                value: NamedValue {
                    name: "lateness".to_owned(),
                    value: late,
                    unit: "s".to_owned(),
                },
                limit,
                meaning: "what the force does between two samples comes as late".to_owned(),
            };
            (late < limit).then_some((term, refusal))
        })
    }
}

/// Log-likelihood of the simplest model at its best process noise, nats, while the axis moves: at rest friction holds
/// whatever the force does. Errors have Student's distribution: what the simple model lacks makes large errors at
/// some moments, whatever the hold, and the many others shall decide.
fn likelihood(family: &FrictionFamily) -> Option<f64> {
    let ahead = family.thinned.as_ref().or(family.ahead.as_ref())?;
    let moving = ahead.predictor.counted_and_moving();
    let view = View::new(family, ahead);
    let usual = family.effects.iter().filter(|effect| effect.is_usual());
    let names: Vec<String> = usual.map(|effect| effect.about().name.to_owned()).collect();
    let terms = terms(family, &names).ok()?;
    let everywhere = vec![1.0; family.target().len()];
    let mut model = fit::identify(family, &terms, &everywhere, 1).fit.model;
    let mut best: Option<f64> = None;
    // From much process noise to little: the valley narrows.
    for setting in (0..ahead.predictor.settings() / 2).rev() {
        let node = Fitter::new(family, &view).fit(model, setting, STEPS);
        let errors: Vec<f64> =
            node.errors.iter().zip(&moving).filter(|(_, moves)| **moves).map(|(e, _)| *e).collect();
        let scale = statistics::spread(&errors);
        let each = errors.iter().map(|e| ((e / scale).powi(2) / FREEDOM).ln_1p());
        let loss = 0.5 * (FREEDOM + 1.0) * each.sum::<f64>() + errors.len() as f64 * scale.ln();
        let nats = -loss / statistics::correlation(&errors);
        if nats.is_finite() {
            best = Some(best.map_or(nats, |best| best.max(nats)));
        }
        model = node.model;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::testing::{family, model};

    #[test]
    fn a_lag_within_half_a_sample_is_how_an_unstated_force_acts_between_samples() {
        let mut family = family();
        let base = model(&family, &["mass", "coulomb"], &[]);
        let mut refused = |hold: Option<Hold>, name: &str, values: &[(&str, f64)]| {
            family.hold = hold.map(|hold| HoldChoice { hold, nats: 1.0, by_search: true });
            let lagging = model(&family, &["mass", "coulomb", name], values);
            family.within_a_sample(&lagging, &base).is_some()
        };
        // A sample takes 1 ms.
        for (late, told) in [(0.2e-3, false), (0.5e-3, false), (0.6e-3, true), (3e-3, true)] {
            let delay = |hold| refused(hold, "input-delay", &[("T_d", late)]);
            let [sampled, held, stated] =
                [Some(Hold::Sampled), Some(Hold::ZeroOrder), None].map(delay);
            assert_eq!((sampled, held, stated), (!told, false, false), "{late}");
            assert_eq!(refused(Some(Hold::Sampled), "actuator-lag", &[("tau", late)]), !told);
            let second = [("tau", late), ("zeta", 0.5)];
            assert_eq!(refused(Some(Hold::Sampled), "actuator-lag:second-order", &second), !told);
        }
        assert!(!refused(Some(Hold::Sampled), "stribeck", &[]));
    }
}
