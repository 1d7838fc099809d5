//! Which candidate explains what the model leaves: every term, its shapes profiled, its signs kept,
//! all at once with the parameters that the model already has.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::climb::evidence::Evidence;
use crate::family::ModelFamily;
use crate::family::shapes::{amplitudes, assemble};
use crate::fit::Fit;
use crate::statistics::basis::{Basis, add_scaled, constrained, dot, gram, solve, weighed};
use crate::statistics::placebo;
use crate::statistics::split::Split;

/// Number of rearranged residuals.
const PLACEBOS: usize = 199;
/// A column whose square falls below this share when the model's own freedom is taken out says
/// nothing that the model does not say.
const NOTHING_NEW: f64 = 1e-6;
/// Of two shapes that remove nearly as much, this close, the one tried first is taken.
const AS_GOOD: f64 = 0.97;
/// Trials per matrix product.
const CHUNK: usize = 64;

/// A candidate with the best shape that was tried.
#[derive(Clone, Debug)]
pub struct Screened {
    /// Index of the term.
    pub term: usize,
    /// Values of all its parameters.
    pub values: Vec<f64>,
    /// Share of the held-out squared error that it removes.
    pub gain: f64,
    /// Share of the weighted squared error that it removes on all data.
    pub gain_all: f64,
    /// Chance that any candidate gains as much, for its freedom, on a placebo.
    pub p_value: f64,
    /// Share of the squared error that this candidate would have to remove to be found at 5 %.
    pub needed: f64,
    /// Square of the change of the prediction on the fitted blocks per unit of the first amplitude,
    /// after the model's own parameters have adapted: what turns a share of the error into a size.
    pub leverage: f64,
}

/// What is screened, and how.
pub struct Screening<'a> {
    /// Terms to try.
    pub candidates: &'a [usize],
    /// One weight per grid point, multiplying the residual.
    pub weights: &'a [f64],
    /// What is fitted and what is held out.
    pub split: &'a Split,
    /// Signals whose self-similarity makes a shift useless as a placebo.
    pub motion: &'a [Vec<f64>],
    /// Seed of the placebos.
    pub seed: u64,
}

/// One term with one shape: its columns, weighted and with the model's own freedom projected out.
pub(crate) struct Trial {
    /// Place of the term among the candidates.
    pub(crate) candidate: usize,
    pub(crate) shape: Vec<f64>,
    pub(crate) columns: Vec<Vec<f64>>,
    pub(crate) gram: Vec<Vec<f64>>,
    pub(crate) positive: Vec<bool>,
    /// True where the columns have been made orthonormal: signs are free, and the fall of the error
    /// is the sum of the squared moments.
    orthonormal: bool,
}

impl Trial {
    fn new(candidate: usize, shape: Vec<f64>, columns: Vec<Vec<f64>>, positive: Vec<bool>) -> Self {
        let orthonormal = !positive.contains(&true);
        let columns = if orthonormal { Basis::of(&columns).columns().to_vec() } else { columns };
        let gram = gram(&columns);
        Self { candidate, shape, columns, gram, positive, orthonormal }
    }

    /// Fall of the square of a residual that has these scalar products with the columns.
    fn fall(&self, moment: &[f64]) -> f64 {
        if self.orthonormal {
            return moment.iter().map(|m| m * m).sum();
        }
        if let ([m], [row]) = (moment, self.gram.as_slice()) {
            return if row[0] > 0.0 { m.max(0.0).powi(2) / row[0] } else { 0.0 };
        }
        let beta = constrained(&self.gram, moment, &self.positive);
        // With the exact solution of the active columns the fall is just their moments.
        beta.iter().zip(moment).map(|(b, m)| b * m).sum::<f64>().max(0.0)
    }
}

/// Screens candidates against the residual of `fit`; best first.
pub fn screen<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
) -> Vec<Screened> {
    let weigh = |column: &[f64]| weighed(column, screening.weights);
    let own = Basis::of(&fit.jacobian.iter().map(|column| weigh(column)).collect::<Vec<_>>());
    let trials = trials(family, fit, screening, &own);
    let residuals = residuals(fit, screening);
    let falls = falls(&trials, &residuals);
    let shares = shares(&residuals, &own, &trials, &falls, screening.candidates.len());
    let evidence = Evidence::new(&shares[0], &shares[1..]);

    let mut screened: Vec<Screened> = screening
        .candidates
        .par_iter()
        .enumerate()
        .filter_map(|(k, &term)| {
            let best = best_trial(&trials, &falls, k)?;
            let held_out = held_out(family, fit, screening, best);
            let about = &family.terms()[term];
            let amplitude: &[f64] =
                if amplitudes(about).is_empty() { &[] } else { &held_out.amplitude };
            Some(Screened {
                term,
                values: assemble(about, &best.shape, amplitude),
                gain: held_out.gain,
                gain_all: shares[0][k],
                p_value: evidence.p_value(k),
                needed: evidence.needed(k),
                leverage: held_out.leverage,
            })
        })
        .collect();
    screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    screened
}

/// The best shape of one term, by its gain on all data, with its amplitudes from the fitted blocks; no
/// p-value is asked for. Nothing where the term changes nothing.
pub fn best_values<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    term: usize,
) -> Option<Vec<f64>> {
    let one = Screening { candidates: &[term], ..*screening };
    let weigh = |column: &[f64]| weighed(column, one.weights);
    let own = Basis::of(&fit.jacobian.iter().map(|column| weigh(column)).collect::<Vec<_>>());
    let trials = trials(family, fit, &one, &own);
    let falls = falls(&trials, &[weigh(&fit.residual)]);
    let best = best_trial(&trials, &falls, 0)?;
    let about = &family.terms()[term];
    let amplitude = held_out(family, fit, &one, best).amplitude;
    let amplitude: &[f64] = if amplitudes(about).is_empty() { &[] } else { &amplitude };
    Some(assemble(about, &best.shape, amplitude))
}

/// The weighted residual first, then its placebos.
pub(crate) fn residuals(fit: &Fit, screening: &Screening<'_>) -> Vec<Vec<f64>> {
    let residual = weighed(&fit.residual, screening.weights);
    let orders =
        placebo::rearrangements(residual.len(), PLACEBOS, screening.motion, screening.seed);
    let placebos = orders.iter().map(|order| order.iter().map(|&k| residual[k]).collect());
    std::iter::once(residual.clone()).chain(placebos).collect()
}

pub(crate) fn trials<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    own: &Basis,
) -> Vec<Trial> {
    let mut trials = Vec::new();
    for (candidate, &term) in screening.candidates.iter().enumerate() {
        let shapes = family.shapes(term);
        let columns = family.columns_of_shapes(&fit.model, &fit.prediction, term, &shapes);
        let of_term: Vec<Option<Trial>> = shapes
            .into_par_iter()
            .zip(columns)
            .map(|(shape, mut columns)| {
                for column in &mut columns {
                    free_of(column, screening.weights, own);
                }
                let visible = columns.iter().flatten().any(|value| *value != 0.0);
                let finite = columns.iter().flatten().all(|value| value.is_finite());
                let positive = positive(family, term);
                (visible && finite).then(|| Trial::new(candidate, shape, columns, positive))
            })
            .collect();
        trials.extend(of_term.into_iter().flatten());
    }
    trials
}

/// Weighs a column and takes the model's own freedom out of it; what is only rounding noise then
/// becomes exactly nothing.
fn free_of(column: &mut [f64], weights: &[f64], own: &Basis) {
    column.iter_mut().zip(weights).for_each(|(value, weight)| *value *= weight);
    let before = dot(column, column);
    own.project_out(column);
    if dot(column, column) < NOTHING_NEW * before {
        column.fill(0.0);
    }
}

/// Which amplitudes of a term cannot be negative.
fn positive<F: ModelFamily + ?Sized>(family: &F, term: usize) -> Vec<bool> {
    let signs: Vec<bool> =
        amplitudes(&family.terms()[term]).iter().map(|p| p.lower >= 0.0).collect();
    if signs.is_empty() { vec![true] } else { signs }
}

/// Fall of each residual's square by each trial: `falls[trial][residual]`. Matrix products, as there
/// are some thousand columns and two hundred residuals.
pub(crate) fn falls(trials: &[Trial], residuals: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let points = residuals[0].len();
    let right = DMatrix::from_fn(points, residuals.len(), |i, k| residuals[k][i]);
    let chunks: Vec<Vec<Vec<f64>>> = trials
        .par_chunks(CHUNK)
        .map(|chunk| {
            let rows: Vec<&Vec<f64>> = chunk.iter().flat_map(|trial| &trial.columns).collect();
            let left = DMatrix::from_fn(rows.len(), points, |row, i| rows[row][i]);
            let moments = left * &right;
            let mut next = 0;
            let mut of_trial = |trial: &Trial| -> Vec<f64> {
                let mine = next..next + trial.columns.len();
                next = mine.end;
                let moment =
                    |k: usize| -> Vec<f64> { mine.clone().map(|row| moments[(row, k)]).collect() };
                (0..residuals.len()).map(|k| trial.fall(&moment(k))).collect()
            };
            chunk.iter().map(&mut of_trial).collect()
        })
        .collect();
    chunks.into_iter().flatten().collect()
}

/// For each residual and candidate the largest share of the square that a trial removes.
fn shares(
    residuals: &[Vec<f64>],
    own: &Basis,
    trials: &[Trial],
    falls: &[Vec<f64>],
    candidates: usize,
) -> Vec<Vec<f64>> {
    residuals
        .par_iter()
        .enumerate()
        .map(|(k, residual)| {
            let mut rest = residual.clone();
            own.project_out(&mut rest);
            let total = dot(&rest, &rest).max(f64::MIN_POSITIVE);
            let mut best = vec![0.0f64; candidates];
            for (trial, falls) in trials.iter().zip(falls) {
                best[trial.candidate] = best[trial.candidate].max(falls[k] / total);
            }
            best
        })
        .collect()
}

fn best_trial<'a>(trials: &'a [Trial], falls: &[Vec<f64>], candidate: usize) -> Option<&'a Trial> {
    let of_term = || trials.iter().zip(falls).filter(|(trial, _)| trial.candidate == candidate);
    let most = of_term().map(|(_, falls)| falls[0]).fold(0.0, f64::max);
    of_term().find(|(_, falls)| falls[0] >= AS_GOOD * most).map(|(trial, _)| trial)
}

/// A trial on data that its coefficients were not estimated on.
struct HeldOut {
    /// Share of the held-out squared error that it removes.
    gain: f64,
    /// Amplitudes from the fitted blocks.
    amplitude: Vec<f64>,
    /// See [`Screened::leverage`].
    leverage: f64,
}

/// Estimates the coefficients of a trial on the fitted blocks, together with the model's own
/// parameters, and applies them to the held-out ones.
fn held_out<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    trial: &Trial,
) -> HeldOut {
    let term = screening.candidates[trial.candidate];
    let raw = family.columns(&fit.model, &fit.prediction, term, &trial.shape);
    let fitted = screening.split.fit(fit.residual.len());
    let part = |column: &[f64], keep: bool| -> Vec<f64> {
        column
            .iter()
            .zip(screening.weights)
            .zip(&fitted)
            .map(|((value, weight), fit)| if *fit == keep { value * weight } else { 0.0 })
            .collect()
    };
    let moment = |columns: &[Vec<f64>], target: &[f64]| -> Vec<f64> {
        columns.iter().map(|column| dot(column, target)).collect()
    };
    let own: Vec<Vec<f64>> = fit.jacobian.iter().map(|column| part(column, true)).collect();
    let basis = Basis::of(&own);
    let mut columns: Vec<Vec<f64>> = raw.iter().map(|column| part(column, true)).collect();
    for column in &mut columns {
        free_of(column, &vec![1.0; fitted.len()], &basis);
    }
    let target = part(&fit.residual, true);
    let products = gram(&columns);
    let mut amplitude = constrained(&products, &moment(&columns, &target), &trial.positive);
    if amplitudes(&family.terms()[term]).is_empty() {
        // The column is the whole effect: there is not more of it, however little the fitted blocks show.
        for amplitude in &mut amplitude {
            *amplitude = amplitude.min(1.0);
        }
    }
    // The model's own parameters adapt to what is left, with and without the trial.
    let own_gram = gram(&own);
    let all: Vec<usize> = (0..own.len()).collect();
    let left = |amplitude: &[f64]| {
        let (mut inside, mut outside) = (target.clone(), part(&fit.residual, false));
        for (column, beta) in raw.iter().zip(amplitude) {
            add_scaled(&mut inside, -*beta, &part(column, true));
            add_scaled(&mut outside, -*beta, &part(column, false));
        }
        let adapted = solve(&own_gram, &moment(&own, &inside), &all);
        for (column, beta) in fit.jacobian.iter().zip(&adapted) {
            add_scaled(&mut outside, -*beta, &part(column, false));
        }
        dot(&outside, &outside)
    };
    let before = left(&vec![0.0; raw.len()]);
    let gain = if before > 0.0 { 1.0 - left(&amplitude) / before } else { 0.0 };
    HeldOut { gain, amplitude, leverage: products[0][0] }
}
