//! The family one sample ahead: its terms as plants, the predictor's errors as the engine wants them.

use missing_physics::ahead::{Ahead, Trial, trials};
use missing_physics::{Fitted, ModelFamily, Recording};

use super::FrictionFamily;
use crate::model::Model;
use crate::predictor::Predictor;

/// The predictor of a recording with the instants that it counts.
#[derive(Clone, Debug)]
pub(super) struct OneAhead {
    pub predictor: Predictor,
    instants: Vec<(f64, usize)>,
}

impl OneAhead {
    /// Gains for a plant of about `mass` and `damping`; nothing where the recording is too short.
    pub fn new(recording: &Recording, mass: f64, damping: f64) -> Option<Self> {
        let predictor = Predictor::new(recording, mass, damping)?;
        let piece = |k: usize| recording.segments().partition_point(|s| s.end <= k);
        let instants =
            predictor.counted().iter().map(|&k| (recording.time()[k], piece(k))).collect();
        Some(Self { predictor, instants })
    }
}

impl FrictionFamily {
    fn one_ahead(&self) -> &OneAhead {
        match &self.ahead {
            Some(ahead) => ahead,
            None => unreachable!("asked only where there is one"),
        }
    }

    fn flexible_form(&self, term: usize) -> Option<usize> {
        let name = match self.terms[term].name.as_str() {
            "stribeck" | "stribeck:gaussian" | "stribeck:exponential" => "stribeck:free",
            "presliding" | "presliding:dahl" | "presliding:maxwell-slip" => "presliding:free",
            "position-friction" => "position-friction:fine",
            "ripple" => "ripple:harmonics",
            _ => return None,
        };
        self.terms.iter().position(|term| term.name == name)
    }
}

impl Ahead for FrictionFamily {
    fn settings(&self) -> usize {
        self.one_ahead().predictor.settings()
    }

    fn expected(&self, setting: usize) -> f64 {
        self.one_ahead().predictor.expected(setting)
    }

    fn budget(&self) -> f64 {
        self.one_ahead().predictor.budget()
    }

    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        let plants: Result<Vec<(Model, usize)>, _> =
            models.iter().map(|(fitted, setting)| Ok((self.model(fitted)?, *setting))).collect();
        let ahead = self.one_ahead();
        plants.map_or_else(
            // A combination that is no plant predicts nothing.
            |_: crate::model::ModelError| vec![vec![f64::MAX; ahead.instants.len()]; models.len()],
            |plants| ahead.predictor.errors(&plants),
        )
    }

    fn instants(&self) -> &[(f64, usize)] {
        &self.one_ahead().instants
    }

    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        trials(self, model, term)
    }

    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        let to = self.flexible_form(term)?;
        let values: Vec<f64> = self.terms[to].parameters.iter().map(|p| p.start).collect();
        Some(model.without(self, term).with(to, &values))
    }
}
