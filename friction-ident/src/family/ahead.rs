//! The family one sample ahead: its terms as plants, the predictor's errors as the engine wants them.

use std::sync::{Arc, Mutex};

use aep_core::Scale;
use missing_physics::family::{Ahead, Columns, Own, Rival, Series, Trial, trials};
use missing_physics::report::{Fault, Refusal};
use missing_physics::statistics::periodogram::Periodogram;
use missing_physics::{Fitted, ModelFamily, Recording, Role, TermParameter};

use super::FrictionFamily;
use super::limits::LINE_WIDTH;
use crate::effects::free::{Free, RIVALS};
use crate::effects::{Effect, Periodic, Repeats};
use crate::model::Model;
use crate::predictor::{Predictor, Wave};

/// Samples of a search: more are thinned, and what is found is compared once more on all.
const MOST_SAMPLES: usize = 8_000;
/// So many times as many where a search names nothing on those.
const MORE: usize = 4;
/// Samples on which the trials of a term are ranked.
const RANKED_ON: usize = 3_000;
/// Length of the pieces of a search, s, and of those on which trials are ranked. What a contact holds where a piece begins is
/// known from one motion before it alone, and is wrong until it slides: of pieces of 1 s that is much. To rank, many places count
/// for more.
const LONG: f64 = 2.5;
const SHORT: f64 = 1.0;
/// Starts of a second body that are fitted: its valleys are narrow.
const SECOND_BODIES: usize = 3;
/// Settings whose responses are kept.
const KEPT: usize = 4;
/// Fewest periods in a stroke or a recording: fewer are no wave but a profile. A gain may have fewer: poles can be
/// nearly as long as the stroke, and its profile is no friction and no spring.
const LEAST_PERIODS: f64 = 3.0;
/// Lines that are tried.
const LINES: usize = 5;
/// Largest chance of a line where there is none.
const LINE: f64 = 0.01;
/// Periods to either side of one, a line width apart: of pieces of a recording its frequency is known less well than the
/// phase of all of them asks.
const BESIDE: i32 = 3;

/// The predictor of a recording with the instants that it counts.
#[derive(Clone, Debug)]
pub(super) struct OneAhead {
    pub predictor: Predictor,
    instants: Vec<(f64, usize)>,
    /// What each of them is worth.
    worth: Vec<f64>,
    /// Whether the axis is faster there than at half of them.
    fast: Vec<bool>,
    /// The responses that were asked for last.
    responses: Arc<Mutex<Vec<Responses>>>,
    /// A few pieces of it.
    part: Option<Arc<Self>>,
}

/// What periodic disturbances do at a setting.
#[derive(Clone, Debug)]
struct Responses {
    setting: usize,
    wave: Wave,
    periods: Vec<f64>,
    columns: Columns,
}

impl OneAhead {
    /// Gains for a plant of about `mass` and `damping`; nothing where the recording is too short. Of a long one no samples are
    /// needed that follow each other faster than `apart` s.
    pub fn new(recording: &Recording, mass: f64, damping: f64, apart: f64) -> Option<Self> {
        let all = Predictor::new(recording, mass, damping)?;
        Some(Self::of(all.no_faster(apart, MOST_SAMPLES)))
    }

    /// The same where the recorded force has at least so much noise, N or N m.
    pub fn with_force_noise(&self, noise: f64) -> Self {
        Self::of(self.predictor.clone().with_force_noise(noise))
    }

    /// The same of a part of the recording, where it is long: pieces spread over all of it.
    pub fn thinned(&self) -> Option<Self> {
        self.predictor.thinned(MOST_SAMPLES, LONG).map(Self::of)
    }

    /// More of it, where that names nothing.
    pub fn less_thinned(&self) -> Option<Self> {
        self.predictor.thinned(MORE * MOST_SAMPLES, LONG).map(Self::of)
    }

    fn of(predictor: Predictor) -> Self {
        let part = predictor.thinned(RANKED_ON, SHORT).map(|part| Arc::new(Self::whole(part)));
        Self { part, ..Self::whole(predictor) }
    }

    fn whole(predictor: Predictor) -> Self {
        let (instants, worth) = (predictor.instants(), predictor.worth());
        let fast = predictor.counted_and_fast();
        Self { predictor, instants, worth, fast, responses: Arc::default(), part: None }
    }

    /// Responses to periodic disturbances: they do not depend on the model, so that those of the last settings are
    /// kept.
    fn responses(&self, setting: usize, wave: Wave, periods: Vec<f64>) -> Columns {
        let setting = setting % (self.predictor.settings() / 2);
        let lock = || self.responses.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let same = |kept: &&Responses| {
            (kept.setting, kept.wave) == (setting, wave) && kept.periods == periods
        };
        if let Some(kept) = lock().iter().find(same) {
            return kept.columns.clone();
        }
        let columns = Arc::new(self.predictor.responses(setting, wave, &periods));
        let mut kept = lock();
        if kept.len() >= KEPT {
            kept.remove(0);
        }
        kept.push(Responses { setting, wave, periods, columns: columns.clone() });
        columns
    }
}

/// The family with one of its predictors.
pub(super) struct View<'a> {
    pub family: &'a FrictionFamily,
    pub ahead: &'a OneAhead,
    /// Whether errors are judged by what an autoregression leaves of them.
    pub coloured: bool,
}

impl<'a> View<'a> {
    /// The errors as they are.
    pub fn new(family: &'a FrictionFamily, ahead: &'a OneAhead) -> Self {
        Self { family, ahead, coloured: false }
    }

    /// Periods of a `law` over time at the lines in what a model errs, close beside one another: the trials that are even in
    /// frequency end where there would be too many, a hum of the supply beyond them.
    fn lines(&self, model: &Fitted, law: Periodic) -> impl Iterator<Item = f64> {
        let errors = self.errors(&[(model.clone(), self.settings() / 2)]).pop().unwrap_or_default();
        // A model that is no plant errs by the largest number there is.
        let mut errors = errors.into_iter().take_while(|error| error.abs() < f64::MAX);
        let pieces = self.ahead.instants.chunk_by(|a, b| a.1 == b.1);
        let pieces: Vec<Vec<f64>> =
            pieces.map(|piece| errors.by_ref().take(piece.len()).collect()).collect();
        let spectrum = Periodogram::new(&pieces, self.ahead.predictor.interval());
        let lines: Vec<_> = spectrum.iter().flat_map(|s| s.peaks(LINE)).take(LINES).collect();
        let width = LINE_WIDTH / self.family.extent_of(law);
        let beside = move |f: f64| (-BESIDE..=BESIDE).map(move |k| f + f64::from(k) * width);
        lines.into_iter().flat_map(move |line| beside(line.frequency)).map(f64::recip)
    }
}

impl FrictionFamily {
    /// From how many of a term's trials it is fitted.
    pub(super) fn starts(&self, term: usize) -> usize {
        if self.is_second_body(term) { SECOND_BODIES } else { 1 }
    }

    /// Shapes of a term to begin with: a fit finds the rest of the way.
    pub(super) fn few_shapes(&self, term: usize) -> Vec<Vec<f64>> {
        let about = &self.terms[term];
        if about.parameters.iter().all(|p| p.role == Role::Amplitude) {
            return vec![Vec::new()];
        }
        if let Some(law) = self.periodic(term).filter(|law| law.ranked) {
            // A fit moves a period by more than the half of a line that lies between two of these.
            let longest = self.extent_of(law) / LEAST_PERIODS;
            let short = |shape: &Vec<f64>| law.of == Repeats::Gain || shape[0] <= longest;
            return self.shapes(term).into_iter().step_by(2).filter(short).collect();
        }
        let shapes: Vec<&TermParameter> =
            about.parameters.iter().filter(|p| p.role == Role::Shape).collect();
        let usual: &[usize] = match shapes.len() {
            1 => &[12],
            2 => &[6, 3],
            _ => &[5, 3, 2],
        };
        let counts = self.effect(term).and_then(Effect::few_trials).unwrap_or(usual);
        shapes.iter().enumerate().fold(vec![Vec::new()], |points, (k, parameter)| {
            let line = inner(parameter, counts.get(k).copied().unwrap_or(1));
            let each = |point: &Vec<f64>| {
                line.iter().map(|value| [point.as_slice(), &[*value]].concat()).collect::<Vec<_>>()
            };
            points.iter().flat_map(each).collect()
        })
    }
}

impl Ahead for View<'_> {
    fn settings(&self) -> usize {
        self.ahead.predictor.settings()
    }

    fn expected(&self, setting: usize) -> f64 {
        self.ahead.predictor.expected(setting)
    }

    fn budget(&self) -> f64 {
        self.ahead.predictor.budget()
    }

    fn input_noise(&self, setting: usize) -> Option<f64> {
        Some(self.ahead.predictor.process(setting))
    }

    fn coloured(&self) -> Option<Box<dyn Ahead + '_>> {
        Some(Box::new(Self { coloured: true, ..*self }))
    }

    fn is_coloured(&self) -> bool {
        self.coloured
    }

    fn share(&self) -> f64 {
        let all = self.family.ahead.as_ref().unwrap_or(self.ahead);
        self.ahead.predictor.duration() / all.predictor.duration()
    }

    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        let plants: Result<Vec<(Model, usize)>, _> = models
            .iter()
            .map(|(fitted, setting)| Ok((self.family.model(fitted)?, *setting)))
            .collect();
        let ahead = self.ahead;
        plants.map_or_else(
            // A combination that is no plant predicts nothing.
            |_: crate::model::ModelError| vec![vec![f64::MAX; ahead.instants.len()]; models.len()],
            |plants| ahead.predictor.errors(&plants),
        )
    }

    fn instants(&self) -> &[(f64, usize)] {
        &self.ahead.instants
    }

    fn worth(&self) -> Option<&[f64]> {
        Some(&self.ahead.worth)
    }

    fn in_motion(&self, term: usize) -> Option<&[bool]> {
        self.family.effect(term)?.rings().then_some(&self.ahead.fast)
    }

    fn faults(&self) -> Option<Fault> {
        let share = self.ahead.predictor.stale();
        (share > 0.0).then_some(Fault::Repeated { share })
    }

    fn along(&self) -> Vec<(String, String, Vec<f64>)> {
        let position = self.family.recording.channel("position");
        let values = |channel: &missing_physics::Channel| {
            self.ahead.predictor.counted().map(|k| channel.values[k]).collect()
        };
        position.map(|c| ("position".to_owned(), c.unit.clone(), values(c))).into_iter().collect()
    }

    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        if let Some(trials) = self.family.two_masses(model, term) {
            return trials;
        }
        let mut shapes = self.family.few_shapes(term);
        let law = self.family.periodic(term).filter(|law| law.of == Repeats::ForceOverTime);
        if let Some(law) = law {
            shapes.extend(self.lines(model, law).map(|period| vec![period]));
        }
        trials(self.family, model, term, &shapes)
    }

    fn columns(&self, setting: usize, term: usize, trials: &[Trial]) -> Option<Columns> {
        let law = self.family.periodic(term).filter(|law| law.ranked)?;
        let wave = match law.of {
            Repeats::Force => Wave::Force,
            Repeats::Gain => Wave::Gain,
            Repeats::Sensor => Wave::Sensor,
            Repeats::ForceOverTime => Wave::ForceOverTime,
        };
        let parameters = &self.family.terms[term].parameters;
        let from_end = parameters.iter().rev().position(|p| p.name == law.period)? + 1;
        let period = |trial: &Trial| trial.model.values[trial.model.values.len() - from_end];
        let periods: Vec<f64> = trials.iter().map(period).collect();
        // The fundamental chooses the period; harmonics follow when it is looked at as it is.
        Some(self.ahead.responses(setting, wave, periods))
    }

    fn missing_force(&self, model: &Fitted, setting: usize) -> Option<Series> {
        self.ahead.predictor.missing_force(&self.family.model(model).ok()?, setting)
    }

    fn own(&self, model: &Fitted) -> Vec<Own> {
        self.family.own(model)
    }

    fn with_own(&self, model: &Fitted, values: &[f64]) -> Fitted {
        self.family.with_own(model, values)
    }

    fn part(&self) -> Option<Box<dyn Ahead + '_>> {
        let ahead = self.ahead.part.as_deref()?;
        Some(Box::new(Self { ahead, ..*self }))
    }

    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        self.family.in_flexible_form(model, term)
    }

    fn variations(&self, model: &Fitted) -> Vec<Fitted> {
        self.family.beside(model)
    }

    fn relatives(&self, model: &Fitted) -> Vec<Fitted> {
        let mut related = self.family.related_second_bodies(model);
        related.extend(self.family.other_forms_of_companion(model));
        related.extend(self.family.other_lateness(model));
        related.extend(self.family.what_draws_back(model));
        related
    }

    fn rivals(&self) -> Vec<Rival> {
        rivals(self.family)
    }

    fn vanishes(&self, model: &Fitted, base: &Fitted) -> Option<(usize, Refusal)> {
        self.family.vanishes(model, base)
    }

    fn is_unseen(&self, model: &Fitted, base: &Fitted) -> bool {
        self.family.gives_unseen(model, base)
    }

    fn may_be_unseen(&self) -> Option<usize> {
        self.family.contact()
    }

    fn of_reading(&self, model: &Fitted, base: &Fitted) -> Option<(usize, Refusal)> {
        self.family.within_a_sample(model, base)
    }

    fn starts(&self, term: usize) -> usize {
        self.family.starts(term)
    }

    fn is_candidate(&self, term: usize) -> bool {
        self.family.is_candidate(term)
    }
}

/// What stands for no effect: see [`crate::effects::free`].
pub(super) fn rivals(family: &FrictionFamily) -> Vec<Rival> {
    let term = |name: &str| family.terms.iter().position(|term| term.name == name);
    let rival = |free: &Free| {
        let effects = family.effects.iter().enumerate();
        let kin =
            effects.filter(|(_, effect)| (free.is_kin)(**effect)).map(|(k, _)| k + 1).collect();
        Some(Rival { term: term(free.effect.about().name)?, title: free.title, kin })
    };
    let shows = |free: &&Free| family.given.is_none() || free.effect.shows_beside_given_force();
    RIVALS.iter().filter(shows).filter_map(rival).collect()
}

/// `count` values within the limits, evenly on the parameter's scale; one alone is where a search starts.
fn inner(parameter: &TermParameter, count: usize) -> Vec<f64> {
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
