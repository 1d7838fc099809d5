//! A recording seen one sample ahead: the seam between the deciding part and a subject.

use super::fitted::Fitted;
use super::own::Own;
use super::series::Series;
use crate::report::{Fault, NoCause, Refusal, Remains};

/// A recording seen one sample ahead.
pub trait Ahead: Sync {
    /// Number of settings of the process noise.
    fn settings(&self) -> usize;

    /// Standard deviation of the prediction error that a true model would have at a setting.
    fn expected(&self, setting: usize) -> f64;

    /// Standard deviation of the prediction error that the sensors alone make.
    fn budget(&self) -> f64;

    /// Standard deviation, from sample to sample, of the noise of the input that a setting stands for; nothing where it stands for
    /// something else. [`expected`](Self::expected) is the error that it makes.
    fn input_noise(&self, _setting: usize) -> Option<f64> {
        None
    }

    /// Prediction errors of models of the same terms, each at its own setting: one value per instant that
    /// counts.
    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>>;

    /// Prediction errors of models of any terms as the filter of `model` sees them: what they change is linear in what they
    /// predict. The same as their own errors unless a filter is found for each model.
    fn errors_beside(&self, _model: &Fitted, setting: usize, others: &[Fitted]) -> Vec<Vec<f64>> {
        self.errors(&others.iter().map(|other| (other.clone(), setting)).collect::<Vec<_>>())
    }

    /// Instants of the prediction errors, s, and the piece of the recording that each belongs to.
    fn instants(&self) -> &[(f64, usize)];

    /// What each error is worth where models are compared, at most 1: less where a sensor says the same again. All are worth
    /// 1 where nothing is said.
    fn worth(&self) -> Option<&[f64]> {
        None
    }

    /// The errors of the half in which the system moves faster, for a term that rings wherever it moves: by them alone it gains
    /// what a term must, or it holds at rest and is something else; and by what the errors do not foretell themselves, or it is
    /// a noise. Nothing for other terms.
    fn in_motion(&self, _term: usize) -> Option<&[bool]> {
        None
    }

    /// Share of the recording's errors that these are: where only a part of it is searched an effect gains as much less.
    fn share(&self) -> f64 {
        1.0
    }

    /// Share of what an effect must gain that these errors are asked for: few errors can gain no more.
    fn asked(&self) -> f64 {
        1.0
    }

    /// What a model leaves that its errors one sample ahead do not show: with it no model is complete, which may err
    /// `complete` times as much as the sensors make it.
    fn remains(&self, _model: &Fitted, _complete: f64) -> Option<Remains> {
        None
    }

    /// Why effects that one model has beyond another are not the cause of what that one lacks: something that is no effect does
    /// more, or most of what was there is still there.
    fn is_no_cause(&self, _base: &Fitted, _last: &Fitted) -> Option<NoCause> {
        None
    }

    /// Whether effects explain as much of what is missing as they take away of what errs beyond the budget: not of residuals from
    /// which an autoregression has taken what is slow.
    fn has_shares(&self) -> bool {
        true
    }

    /// What is wrong with the recording itself: with it no model is complete.
    fn faults(&self) -> Option<Fault> {
        None
    }

    /// The same recording, its prediction errors judged by what an autoregression leaves of them.
    fn coloured(&self) -> Option<Box<dyn Ahead + '_>> {
        None
    }

    /// Whether errors are judged so.
    fn is_coloured(&self) -> bool {
        false
    }

    /// Along what the errors may be uneven, beside time: name, unit and a value for each instant.
    fn along(&self) -> Vec<(String, String, Vec<f64>)> {
        Vec::new()
    }

    /// Ways to begin with a term beside a model.
    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial>;

    /// Models beside this one in which the term that was added last may lie in a lower valley; few, and none where
    /// its valley is wide.
    fn variations(&self, _model: &Fitted) -> Vec<Fitted> {
        Vec::new()
    }

    /// The same model with the term that was added last in the place of a related effect, as near to it as that can be:
    /// where one of the two fits well the other one begins there.
    fn relatives(&self, _model: &Fitted) -> Vec<Fitted> {
        Vec::new()
    }

    /// What stands for no effect, but may predict as well as effects that are not there.
    fn rivals(&self) -> Vec<Rival> {
        Vec::new()
    }

    /// A term that a model has beyond `base` and that is no such effect as it was fitted (a gap of no width), and why.
    fn vanishes(&self, _model: &Fitted, _base: &Fitted) -> Option<(usize, Refusal)> {
        None
    }

    /// Whether that term is one that every system has to some extent, and this one too little for anyone to see (friction
    /// that gives less than a count before it slides): nothing is missing without it, but it may do what effects that are
    /// not there would.
    fn is_unseen(&self, _model: &Fitted, _base: &Fitted) -> bool {
        false
    }

    /// The term that [`Ahead::is_unseen`] is about, in the form that it is asked in.
    fn may_be_unseen(&self) -> Option<usize> {
        None
    }

    /// A term that a model has beyond `base` and that does no more than another way to read the recording would, and why.
    fn of_reading(&self, _model: &Fitted, _base: &Fitted) -> Option<(usize, Refusal)> {
        None
    }

    /// From how many of a term's trials it is fitted, the best ones first.
    fn starts(&self, _term: usize) -> usize {
        1
    }

    /// Whether a term is tried by itself, not only as another form of one that is there.
    fn is_candidate(&self, _term: usize) -> bool {
        true
    }

    /// Changes of the errors by amplitudes of each of `trials`, to first order, where the family has a way that is
    /// much cheaper than errors of the trials: the few best of them are then looked at as they are. Single
    /// precision is enough to choose by.
    fn columns(&self, _setting: usize, _term: usize, _trials: &[Trial]) -> Option<Columns> {
        None
    }

    /// The force beside a model that would make it follow the recording, by its prediction errors at a setting.
    fn missing_force(&self, _model: &Fitted, _setting: usize) -> Option<Series> {
        None
    }

    /// What of a model belongs to the recording.
    fn own(&self, _model: &Fitted) -> Vec<Own> {
        Vec::new()
    }

    /// The model with other values of what [`Ahead::own`] lists, in its order.
    fn with_own(&self, model: &Fitted, _values: &[f64]) -> Fitted {
        model.clone()
    }

    /// A few pieces of the recording, on which the trials of a term are ranked at a fraction of the cost; nothing where
    /// it is short. Its settings are those of the whole.
    fn part(&self) -> Option<Box<dyn Ahead + '_>> {
        None
    }

    /// The same model with a term in a more flexible form, to begin with; nothing where there is none.
    fn flexible(&self, _model: &Fitted, _term: usize) -> Option<Fitted> {
        None
    }
}

/// A term that stands for no effect (a friction level that varies freely with time): where it predicts as well as the
/// effects that were found the recording does not show them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rival {
    /// The term. Its values are amplitudes, 0 where there is nothing.
    pub term: usize,
    /// What it is: `a friction level that varies freely with time`.
    pub title: &'static str,
    /// The effects that are shapes of it.
    pub kin: Vec<usize>,
}

/// A few columns for each of many trials.
pub type Columns = std::sync::Arc<Vec<[Vec<f32>; 2]>>;

/// A place to begin with a term.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The model with the term.
    pub model: Fitted,
    /// Indices of the values that are free and the size that each is tried at (they are 0 in the model); empty
    /// where only the whole change can be looked at.
    pub amplitudes: Vec<(usize, f64)>,
}
