//! The seam between the engine and a subject: what a model is made of and what it predicts.

use std::collections::BTreeMap;
use std::ops::Range;

use aep_core::Scale;
use rayon::prelude::*;

use crate::generic::Generic;
use crate::report::{Plot, SplitError};
use crate::spectrum::FullRate;
use crate::split::Split;

/// What a parameter does to the prediction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// The prediction is (nearly) linear in it and the term is absent at 0.
    Amplitude,
    /// Everything else: a characteristic velocity, a period, a time constant.
    Shape,
}

/// One parameter of a term. Its sign is physics: `lower = 0` says that it cannot be negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, e.g. `level`.
    pub name: String,
    /// SI unit, e.g. `N`.
    pub unit: String,
    /// Amplitude or shape.
    pub role: Role,
    /// Lower limit.
    pub lower: f64,
    /// Upper limit.
    pub upper: f64,
    /// Scale on which it is searched.
    pub scale: Scale,
    /// Where a search starts; for an amplitude also its typical size.
    pub start: f64,
}

/// One term that a model may have.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Identifier used in files and commands.
    pub name: String,
    /// The term in words.
    pub title: String,
    /// Its equation as text.
    pub equation: String,
    /// Its parameters, in the order in which values are given.
    pub parameters: Vec<Parameter>,
    /// True where every model has it and it is no candidate (an inertia).
    pub always: bool,
}

impl Term {
    /// The key of a parameter in reports: `term.parameter`, or just the name where both are equal.
    pub fn key(&self, parameter: &Parameter) -> String {
        if self.name == parameter.name {
            return self.name.clone();
        }
        format!("{}.{}", self.name, parameter.name)
    }
}

/// A model with its values: terms by their index in [`ModelFamily::terms`], parameters one term
/// after the other.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Fitted {
    /// Indices of the terms.
    pub terms: Vec<usize>,
    /// Values of all parameters.
    pub values: Vec<f64>,
}

impl Fitted {
    /// This model with one term more.
    #[must_use]
    pub fn with(&self, term: usize, values: &[f64]) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more.values.extend_from_slice(values);
        more
    }

    /// This model without one of its terms.
    #[must_use]
    pub fn without<F: ModelFamily + ?Sized>(&self, family: &F, term: usize) -> Self {
        let mut less = Self::default();
        for (position, &index) in self.terms.iter().enumerate() {
            if index != term {
                less.terms.push(index);
                less.values.extend_from_slice(&self.values[self.range(family, position)]);
            }
        }
        less
    }

    /// Where in `values` the parameters of the term at `position` stand.
    pub fn range<F: ModelFamily + ?Sized>(&self, family: &F, position: usize) -> Range<usize> {
        let count = |index: &usize| family.terms()[*index].parameters.len();
        let start = self.terms[..position].iter().map(count).sum();
        start..start + count(&self.terms[position])
    }

    /// All parameters with the term they belong to, in the order of `values`.
    pub fn parameters<'a, F: ModelFamily + ?Sized>(
        &'a self,
        family: &'a F,
    ) -> impl Iterator<Item = (&'a Term, &'a Parameter)> {
        self.terms.iter().flat_map(|&index| {
            let term = &family.terms()[index];
            term.parameters.iter().map(move |parameter| (term, parameter))
        })
    }
}

/// What is compared: the predicted quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name, e.g. `force`.
    pub name: String,
    /// SI unit, e.g. `N`.
    pub unit: String,
}

/// Something that the residual may depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    /// Name, e.g. `position`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// One value per grid point.
    pub values: Vec<f64>,
    /// Where given, the residual is multiplied by it before it is looked at: +1 and -1 for the
    /// direction of motion show what opposes motion.
    pub parity: Option<Vec<f64>>,
    /// True where it is part of the state that the physics depends on (a position, a velocity; not
    /// the time): the noise floor compares instants of nearly the same state.
    pub state: bool,
}

/// A regime of the experiment. The regimes of a family do not overlap and cover every grid point.
#[derive(Clone, Debug, PartialEq)]
pub struct Regime {
    /// Name, e.g. `reversal`.
    pub name: String,
    /// Whether a grid point belongs to it.
    pub member: Vec<bool>,
}

/// A recording seen through a kind of model: what the model should predict on a grid of instants,
/// and what it predicts with given terms and parameters.
pub trait ModelFamily: Sync {
    /// Every term, those of each model first.
    fn terms(&self) -> &[Term];

    /// What is predicted.
    fn quantity(&self) -> Quantity;

    /// Instants of the grid, s.
    fn time(&self) -> &[f64];

    /// What the prediction is compared with, one value per grid point.
    fn target(&self) -> &[f64];

    /// How far the target or the regressors may be off because of the way they were measured or
    /// smoothed (standard deviation in units of the target, one per grid point). Points with large
    /// values count less where effects are screened.
    fn doubt(&self) -> &[f64];

    /// The prediction, one value per grid point.
    fn predict(&self, model: &Fitted, out: &mut [f64]);

    /// Shape parameters of a term to try in a screening, one vector (all shapes of the term, in
    /// order) per trial. Terms without shapes have one empty vector.
    fn shapes(&self, term: usize) -> Vec<Vec<f64>> {
        crate::shapes::grid(&self.terms()[term])
    }

    /// What a term with these shape parameters would add to the prediction of `model`, per unit of
    /// each amplitude. A term without amplitude has one column: all that it changes.
    /// `prediction` is that of `model`.
    fn columns(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shape: &[f64],
    ) -> Vec<Vec<f64>> {
        crate::shapes::columns(self, model, prediction, term, shape)
    }

    /// The recording one sample ahead, where the family can predict so.
    fn ahead(&self) -> Option<Box<dyn crate::ahead::Ahead + '_>> {
        None
    }

    /// The same recording read in the other way that its data hardly tell from this one (an input held between samples
    /// or sampled), and by how many nats the simplest model prefers this one; nothing where the data do tell, or where it
    /// was stated.
    fn other_reading(&self) -> Option<(&Self, f64)> {
        None
    }

    /// How the recording was read where nobody stated it, in words.
    fn reading(&self) -> Option<String> {
        None
    }

    /// Parts of a long recording one sample ahead, for a search; nothing where the whole is short enough.
    fn ahead_in_part(&self) -> Option<Box<dyn crate::ahead::Ahead + '_>> {
        None
    }

    /// The term that this one is another form of, if any. A form stands for its effect only where it is
    /// clearly better than the main one.
    fn form_of(&self, _term: usize) -> Option<usize> {
        None
    }

    /// Whether the term acts on what the sensor shows, not on the plant: it is then only added where it lowers
    /// the error in every view, as what is shown shows in all of them.
    fn is_of_sensor(&self, _term: usize) -> bool {
        false
    }

    /// Whether the term can be added to the model.
    fn joins(&self, model: &Fitted, term: usize) -> bool {
        !model.terms.contains(&term)
    }

    /// [`ModelFamily::columns`] for many shapes of a term, in their order. A family that can do so
    /// cheaper than one by one says how.
    fn columns_of_shapes(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shapes: &[Vec<f64>],
    ) -> Vec<Vec<Vec<f64>>> {
        shapes.par_iter().map(|shape| self.columns(model, prediction, term, shape)).collect()
    }

    /// What the residual may depend on.
    fn coordinates(&self) -> &[Coordinate];

    /// Signals that tell whether two instants are the same experiment (a velocity and its sign):
    /// shifting a residual along them must not map the experiment onto itself.
    fn motion(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// The experiment that would tell these terms apart, in words.
    fn experiment(&self, terms: &[String]) -> String {
        format!(
            "repeat the experiment with more varied motion to separate {}.",
            terms.join(" and ")
        )
    }

    /// A term, as text that a user can add to a model, that describes structure of this shape along a
    /// coordinate without explaining it; nothing where the family has none.
    fn generic_term(&self, _coordinate: &Coordinate, _shape: &Generic) -> Option<String> {
        None
    }

    /// Regimes of the experiment, exclusive and complete.
    fn regimes(&self) -> &[Regime];

    /// Blocks that belong together when data are held out; empty where the family has no wish.
    /// Grid points `blocks[i]` form the i-th one.
    fn blocks(&self) -> Vec<Range<usize>> {
        Vec::new()
    }

    /// Errors of the model in other views than the prediction, by the name of the error.
    fn views(&self, _model: &Fitted, _split: &Split) -> BTreeMap<String, SplitError> {
        BTreeMap::new()
    }

    /// The error in a view up to which it may be the noise of the measurement alone, by the name of the error.
    /// Where a model leaves no more, an effect is only added if it lowers that error too: a force that is
    /// too small and too quick to be seen in the motion may be the sensor's own (the counts of an encoder,
    /// differentiated twice, are a force that depends on the position).
    fn view_noise(&self) -> BTreeMap<String, f64> {
        BTreeMap::new()
    }

    /// The residual of the model at the full rate of the recording, for spectra; nothing where the grid
    /// has all there is.
    fn full_rate(&self, _model: &Fitted) -> Option<FullRate> {
        None
    }

    /// Autocorrelation at lag 1, 2, ... of the grid that white noise in the data has after the family's
    /// own smoothing; empty where it stays white.
    fn colour(&self) -> Vec<f64> {
        Vec::new()
    }

    /// What is known of the noise from the measurement itself, by quantity.
    fn noise(&self) -> BTreeMap<String, f64> {
        BTreeMap::new()
    }

    /// The size of a term in words an engineer would use.
    fn describe(&self, term: usize, values: &[f64]) -> String {
        let words: Vec<String> = self.terms()[term]
            .parameters
            .iter()
            .zip(values)
            .map(|(parameter, value)| format!("{} {value:.4} {}", parameter.name, parameter.unit))
            .collect();
        words.join(", ")
    }

    /// Curves for the report: measurement, prediction, what the term looks like.
    fn plots(&self, _base: &Fitted, _last: &Fitted) -> Vec<Plot> {
        Vec::new()
    }
}
