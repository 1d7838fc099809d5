//! The seam between the engine and a subject: what a model is made of and what it predicts.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::ahead::Ahead;
use super::columns::columns;
use super::coordinate::{ComparedQuantity, Coordinate, Regime};
use super::fitted::Fitted;
use super::full_rate::FullRate;
use super::generic::Generic;
use super::other_reading::OtherReading;
use super::shapes;
use super::sizes::sizes;
use super::term::Term;
use crate::report::{Course, NamedError, Plot, Remark};
use crate::statistics::split::Split;

/// A recording seen through a kind of model: what the model should predict on a grid of instants,
/// and what it predicts with given terms and parameters.
///
/// Four methods are required: [`terms`](Self::terms), [`time`](Self::time), [`target`](Self::target) and
/// [`predict`](Self::predict). All others say more of the subject and have defaults. Where a closure can predict,
/// [`FnFamily`](super::FnFamily) is the shorter way.
///
/// ```
/// use missing_physics::{Fitted, ModelFamily, Settings, Term, discover};
///
/// /// A signal of a slope and, perhaps, of a wave.
/// struct Signal {
///     terms: Vec<Term>,
///     time: Vec<f64>,
///     measured: Vec<f64>,
/// }
///
/// impl ModelFamily for Signal {
///     fn terms(&self) -> &[Term] {
///         &self.terms
///     }
///     fn time(&self) -> &[f64] {
///         &self.time
///     }
///     fn target(&self) -> &[f64] {
///         &self.measured
///     }
///     fn predict(&self, model: &Fitted, out: &mut [f64]) {
///         out.fill(0.0);
///         for (position, &term) in model.terms.iter().enumerate() {
///             let values = &model.values[model.range(self, position)];
///             for (out, t) in out.iter_mut().zip(&self.time) {
///                 *out += values[0] * if term == 0 { *t } else { (values[1] * t).sin() };
///             }
///         }
///     }
/// }
///
/// let terms = vec![
///     Term::new("slope", "a slope", "a t").amplitude("a", "V/s", (-5.0, 5.0), 1.0).always(),
///     Term::new("wave", "a wave", "b sin(w t)")
///         .amplitude("b", "V", (-5.0, 5.0), 1.0)
///         .shape("w", "rad/s", (1.0, 20.0), 5.0),
/// ];
/// let time: Vec<f64> = (0..400).map(|k| 0.02 * f64::from(k)).collect();
/// let noise = |k: usize| 0.02 * ((k * k) as f64).sin();
/// let measured = time.iter().enumerate().map(|(k, t)| 0.7 * t + 0.4 * (6.0 * t).sin() + noise(k));
/// let measured = measured.collect();
/// let found = discover(&Signal { terms, time, measured }, &Settings::default(), &mut ())?;
/// assert_eq!(found.added, ["wave"]);
/// # Ok::<(), missing_physics::DiscoverError>(())
/// ```
pub trait ModelFamily: Sync {
    /// Every term, those of each model first.
    fn terms(&self) -> &[Term];

    /// What is predicted.
    fn quantity(&self) -> ComparedQuantity {
        ComparedQuantity { name: "output".into(), unit: "1".into() }
    }

    /// Instants of the grid, s.
    fn time(&self) -> &[f64];

    /// What the prediction is compared with, one value per grid point.
    fn target(&self) -> &[f64];

    /// How far the target or the regressors may be off because of the way they were measured or
    /// smoothed (standard deviation in units of the target, one per grid point). Points with large
    /// values count less where effects are screened. Empty where every point is as good as any other.
    fn doubt(&self) -> &[f64] {
        &[]
    }

    /// The prediction, one value per grid point.
    fn predict(&self, model: &Fitted, out: &mut [f64]);

    /// Shape parameters of a term to try in a screening, one vector (all shapes of the term, in
    /// order) per trial. Terms without shapes have one empty vector.
    fn shapes(&self, term: usize) -> Vec<Vec<f64>> {
        shapes::grid(&self.terms()[term])
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
        columns(self, model, prediction, term, shape)
    }

    /// The recording one sample ahead, where the family can predict so; else its residuals are
    /// [whitened](crate::ahead::Residuals).
    fn ahead(&self) -> Option<Box<dyn Ahead + '_>> {
        None
    }

    /// The same recording read in the other way (an input held between samples or sampled); nothing where it was stated.
    fn other_reading(&self) -> Option<OtherReading<'_>> {
        None
    }

    /// The same recording with noise of its input smoothed away, without a delay; more of it the larger the number, from 0.
    fn without_noise(&self, _more: usize) -> Option<&dyn ModelFamily> {
        None
    }

    /// A model without effects that make the input late: they smooth its noise, too.
    fn without_lateness(&self, model: &Fitted) -> Fitted {
        model.clone()
    }

    /// How the recording was read: what nobody stated, what was left out.
    fn reading(&self) -> Vec<Remark> {
        Vec::new()
    }

    /// The same family on a part of a long recording, near whose base model that of all of it is looked for; nothing where
    /// the whole is short enough.
    fn in_part(&self) -> Option<&dyn ModelFamily> {
        None
    }

    /// Parts of a long recording one sample ahead, for a search; nothing where the whole is short enough.
    fn ahead_in_part(&self) -> Option<Box<dyn Ahead + '_>> {
        None
    }

    /// More of it, for a search that named nothing on those parts; nothing where all of it is not much more.
    fn ahead_in_longer_part(&self) -> Option<Box<dyn Ahead + '_>> {
        None
    }

    /// Whether practically every system of this kind has the term. Where a base model lacks such terms, they are named
    /// in the place of an effect that does no more than they do.
    fn is_usual(&self, _term: usize) -> bool {
        false
    }

    /// Whether a parameter of a term makes it what it is, so that the data must tell its value where the term is named: a
    /// length whose limit is another law. A damping that may as well be none does not, and of what a family does not speak
    /// of nobody knows.
    fn needs(&self, _term: usize, _parameter: &str) -> bool {
        false
    }

    /// Whether an amplitude of a term may be 0, and leaves it the effect that it is.
    fn may_be_none(&self, _term: usize, _parameter: &str) -> bool {
        false
    }

    /// The limits beyond which a parameter of a term makes no sense in a model: those of its search, unless others of the
    /// model's parameters say less.
    fn limits(&self, _model: &Fitted, term: usize, parameter: usize) -> (f64, f64) {
        let parameter = &self.terms()[term].parameters[parameter];
        (parameter.lower, parameter.upper)
    }

    /// The usual term that this one is another law of, if any: where it leaves nothing of that one it is no effect that is
    /// missing, but how that one is in this system.
    fn law_of(&self, _term: usize) -> Option<usize> {
        None
    }

    /// The term that this one is another form of, if any. A form stands for its effect only where it is
    /// clearly better than the main one.
    fn form_of(&self, _term: usize) -> Option<usize> {
        None
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

    /// The same as people are shown it, where that is compared otherwise than what is searched. It has the same terms.
    fn shown(&self) -> Option<&dyn ModelFamily> {
        None
    }

    /// What the residual may depend on.
    fn coordinates(&self) -> &[Coordinate] {
        &[]
    }

    /// Signals that tell whether two instants are the same experiment (a velocity and its sign):
    /// shifting a residual along them must not map the experiment onto itself.
    fn motion(&self) -> Vec<Vec<f64>> {
        Vec::new()
    }

    /// The experiment that would tell these terms apart, a sentence of the subject; nothing where it knows none.
    fn experiment(&self, _terms: &[String]) -> Option<String> {
        None
    }

    /// A term, as text that a user can add to a model, that describes structure of this shape along a
    /// coordinate without explaining it; nothing where the family has none.
    fn generic_term(&self, _coordinate: &Coordinate, _shape: &Generic) -> Option<String> {
        None
    }

    /// Regimes of the experiment, exclusive and complete.
    fn regimes(&self) -> &[Regime] {
        &[]
    }

    /// Blocks that belong together when data are held out; empty where the family has no wish.
    /// Grid points `blocks[i]` form the i-th one.
    fn blocks(&self) -> Vec<Range<usize>> {
        Vec::new()
    }

    /// Errors of the model in other views than the prediction.
    fn views(&self, _model: &Fitted, _split: &Split) -> Vec<NamedError> {
        Vec::new()
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

    /// What is known of the noise from the measurement itself, by quantity and unit (`level_m`): that of
    /// [`target`](Self::target) says how much a model may leave where residuals decide.
    fn noise(&self) -> BTreeMap<String, f64> {
        BTreeMap::new()
    }

    /// What a term that varies freely was found to be.
    fn course(&self, term: usize, values: &[f64]) -> Course {
        Course::Values { values: sizes(&self.terms()[term], values) }
    }

    /// Curves for the report: measurement, prediction, what the term looks like.
    fn plots(&self, _base: &Fitted, _last: &Fitted) -> Vec<Plot> {
        Vec::new()
    }
}

/// What people are shown of `family`.
pub(crate) fn on_view(family: &dyn ModelFamily) -> &dyn ModelFamily {
    family.shown().unwrap_or(family)
}
