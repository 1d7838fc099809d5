//! The family one sample ahead: its terms as plants, the predictor's errors as the engine wants them.

use aep_core::Scale;
use missing_physics::ahead::{Ahead, Trial};
use missing_physics::{Fitted, ModelFamily, Parameter, Recording, Role};

use super::FrictionFamily;
use crate::model::Model;
use crate::predictor::{Predictor, Wave};

/// Effects with a period along the stroke.
const PERIODIC: [&str; 3] = ["ripple", "ripple:direction", "encoder"];
/// Fewest periods in a stroke: fewer are no ripple but a profile.
const LEAST_PERIODS: f64 = 3.0;

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

    /// Shapes of a term to begin with: a fit finds the rest of the way.
    fn few_shapes(&self, term: usize) -> Vec<Vec<f64>> {
        let about = &self.terms[term];
        if PERIODIC.contains(&about.name.as_str()) {
            // A fit moves a period by more than the half of a line that lies between two of these.
            let longest = (self.stroke.1 - self.stroke.0) / LEAST_PERIODS;
            let short = |shape: &Vec<f64>| shape[0] <= longest;
            return self.shapes(term).into_iter().step_by(2).filter(short).collect();
        }
        let shapes: Vec<&Parameter> =
            about.parameters.iter().filter(|p| p.role == Role::Shape).collect();
        let counts: &[usize] = match shapes.len() {
            1 => &[12],
            2 if about.name == "flexible-coupling" => &[12, 1],
            2 => &[6, 3],
            _ => &[5, 3, 2],
        };
        shapes.iter().enumerate().fold(vec![Vec::new()], |points, (k, parameter)| {
            let line = inner(parameter, counts.get(k).copied().unwrap_or(1));
            let each = |point: &Vec<f64>| {
                line.iter().map(|value| [point.as_slice(), &[*value]].concat()).collect::<Vec<_>>()
            };
            points.iter().flat_map(each).collect()
        })
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
        if let Some(trials) = self.two_masses(model, term) {
            return trials;
        }
        let about = &self.terms[term];
        let first = model.values.len();
        let amplitude = |k: &usize| about.parameters[*k].role == Role::Amplitude;
        let free: Vec<usize> = (0..about.parameters.len()).filter(amplitude).collect();
        let trial = |shape: &Vec<f64>| Trial {
            model: model.with(term, &missing_physics::shapes::assemble(about, shape, &[])),
            amplitudes: free.iter().map(|k| (first + k, about.parameters[*k].start)).collect(),
        };
        self.few_shapes(term).iter().map(trial).collect()
    }

    fn columns(&self, setting: usize, term: usize, trials: &[Trial]) -> Option<Vec<Vec<Vec<f64>>>> {
        let name = self.terms[term].name.as_str();
        if !PERIODIC.contains(&name) {
            return None;
        }
        let wave = if name != "encoder" { Wave::Force } else { Wave::Sensor };
        let period = |trial: &Trial| trial.model.values.last().copied().unwrap_or(1.0);
        let periods: Vec<f64> = trials.iter().map(period).collect();
        // The fundamental chooses the period; harmonics follow when it is looked at as it is.
        let responses = self.one_ahead().predictor.responses(setting, wave, &periods);
        Some(responses.into_iter().map(Vec::from).collect())
    }

    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        self.in_flexible_form(model, term)
    }

    fn is_candidate(&self, term: usize) -> bool {
        FrictionFamily::is_candidate(self, term)
    }
}

/// `count` values within the limits, evenly on the parameter's scale; one alone is where a search starts.
fn inner(parameter: &Parameter, count: usize) -> Vec<f64> {
    if count == 1 {
        return vec![parameter.start];
    }
    let (lower, upper) = (parameter.lower, parameter.upper);
    let part = |k: usize| (k as f64 + 0.5) / count as f64;
    let value = |k: usize| match parameter.scale {
        Scale::Log => lower * (upper / lower).powf(part(k)),
        Scale::Linear => lower + (upper - lower) * part(k),
    };
    (0..count).map(value).collect()
}
