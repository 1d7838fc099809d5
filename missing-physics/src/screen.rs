//! Which candidate explains what the model leaves: every term, its shapes profiled, its signs kept,
//! all at once with the parameters that the model already has.

use rayon::prelude::*;

use crate::basis::{Basis, constrained, dot, gram};
use crate::family::{Fitted, ModelFamily};
use crate::fit::Fit;
use crate::placebo;
use crate::shapes::{amplitudes, assemble};
use crate::split::Split;

/// Number of rearranged residuals.
const PLACEBOS: usize = 199;

/// A column whose square falls below this share when the model's own freedom is taken out says
/// nothing that the model does not say.
const NOTHING_NEW: f64 = 1e-6;
/// Of two shapes that remove nearly as much, this close, the one tried first is taken.
const AS_GOOD: f64 = 0.97;

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
    /// Square of the change of the prediction per unit of the first amplitude, after the model's own
    /// parameters have adapted: what turns a share of the error into a size.
    pub leverage: f64,
    /// The change of the prediction on the whole grid.
    pub change: Vec<f64>,
}

/// One term with one shape: its columns, weighted and with the model's own freedom projected out.
struct Trial {
    term: usize,
    shape: Vec<f64>,
    columns: Vec<Vec<f64>>,
    gram: Vec<Vec<f64>>,
    positive: Vec<bool>,
}

impl Trial {
    /// Fall of the squared residual, with the coefficients.
    fn reduction(&self, residual: &[f64]) -> (f64, Vec<f64>) {
        let moment: Vec<f64> = self.columns.iter().map(|column| dot(column, residual)).collect();
        let beta = constrained(&self.gram, &moment, &self.positive);
        // With the exact solution of the active columns the fall is just their moments.
        let fall: f64 = beta.iter().zip(&moment).map(|(b, m)| b * m).sum();
        (fall.max(0.0), beta)
    }
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

/// Screens candidates against the residual of `fit`; best first.
pub fn screen<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
) -> Vec<Screened> {
    let weigh = |column: &[f64]| -> Vec<f64> {
        column.iter().zip(screening.weights).map(|(value, weight)| value * weight).collect()
    };
    let own = Basis::of(&fit.jacobian.iter().map(|column| weigh(column)).collect::<Vec<_>>());
    let residual = weigh(&fit.residual);
    let trials = trials(family, fit, screening, &own);

    let orders =
        placebo::rearrangements(residual.len(), PLACEBOS, screening.motion, screening.seed);
    let null: Vec<Vec<f64>> = orders
        .par_iter()
        .map(|order| {
            let shifted: Vec<f64> = order.iter().map(|&k| residual[k]).collect();
            shares(&shifted, &own, &trials, screening.candidates)
        })
        .collect();
    let measured = shares(&residual, &own, &trials, screening.candidates);
    let evidence = Evidence::new(&measured, &null);

    let mut screened: Vec<Screened> = screening
        .candidates
        .par_iter()
        .enumerate()
        .filter_map(|(k, &term)| {
            let best = best_trial(&trials, term, &residual)?;
            let (_, beta) = best.reduction(&residual);
            let (gain, change) = held_out(family, fit, screening, best, &beta);
            let about = &family.terms()[term];
            let amplitude: &[f64] = if amplitudes(about).is_empty() { &[] } else { &beta };
            Some(Screened {
                term,
                values: assemble(about, &best.shape, amplitude),
                gain,
                gain_all: measured[k],
                p_value: evidence.p_value(k),
                needed: evidence.needed(k),
                leverage: most_visible(&trials, term),
                change,
            })
        })
        .collect();
    screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    screened
}

fn trials<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    own: &Basis,
) -> Vec<Trial> {
    let all: Vec<(usize, Vec<f64>)> = screening
        .candidates
        .iter()
        .flat_map(|&term| family.shapes(term).into_iter().map(move |shape| (term, shape)))
        .collect();
    all.into_par_iter()
        .filter_map(|(term, shape)| {
            let mut columns = family.columns(&fit.model, &fit.prediction, term, &shape);
            for column in &mut columns {
                column.iter_mut().zip(screening.weights).for_each(|(value, w)| *value *= w);
                let before = dot(column, column);
                own.project_out(column);
                // What the model can do already is rounding noise after projection.
                if dot(column, column) < NOTHING_NEW * before {
                    column.fill(0.0);
                }
            }
            let gram = gram(&columns);
            let visible =
                gram.iter().enumerate().any(|(k, row)| row[k] > 0.0 && row[k].is_finite());
            let positive = positive(family, term);
            visible.then_some(Trial { term, shape, columns, gram, positive })
        })
        .collect()
}

/// Which amplitudes of a term cannot be negative.
fn positive<F: ModelFamily + ?Sized>(family: &F, term: usize) -> Vec<bool> {
    let signs: Vec<bool> =
        amplitudes(&family.terms()[term]).iter().map(|p| p.lower >= 0.0).collect();
    if signs.is_empty() { vec![true] } else { signs }
}

/// The largest share of the squared residual that each candidate removes.
fn shares(residual: &[f64], own: &Basis, trials: &[Trial], candidates: &[usize]) -> Vec<f64> {
    let mut rest = residual.to_vec();
    own.project_out(&mut rest);
    let total = dot(&rest, &rest).max(f64::MIN_POSITIVE);
    let mut best = vec![0.0f64; candidates.len()];
    for trial in trials {
        if let Some(k) = candidates.iter().position(|&term| term == trial.term) {
            best[k] = best[k].max(trial.reduction(residual).0 / total);
        }
    }
    best
}

fn best_trial<'a>(trials: &'a [Trial], term: usize, residual: &[f64]) -> Option<&'a Trial> {
    let of_term = || trials.iter().filter(|trial| trial.term == term);
    let most = of_term().map(|trial| trial.reduction(residual).0).fold(0.0, f64::max);
    of_term().find(|trial| trial.reduction(residual).0 >= AS_GOOD * most)
}

/// Largest squared length of a first column over the shapes.
fn most_visible(trials: &[Trial], term: usize) -> f64 {
    trials.iter().filter(|t| t.term == term).map(|t| t.gram[0][0]).fold(0.0, f64::max)
}

/// Share of the held-out squared error removed by coefficients estimated on the fitted blocks only,
/// together with the model's own parameters; and the change of the prediction.
fn held_out<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    trial: &Trial,
    beta_all: &[f64],
) -> (f64, Vec<f64>) {
    let points = fit.residual.len();
    let raw = family.columns(&fit.model, &fit.prediction, trial.term, &trial.shape);
    let mut change = vec![0.0; points];
    for (column, beta) in raw.iter().zip(beta_all) {
        crate::basis::add_scaled(&mut change, *beta, column);
    }
    let fitted = screening.split.fit(points);
    let masked = |column: &[f64], keep: bool| -> Vec<f64> {
        column
            .iter()
            .zip(screening.weights)
            .zip(&fitted)
            .map(|((value, weight), fit)| if *fit == keep { value * weight } else { 0.0 })
            .collect()
    };
    let own: Vec<Vec<f64>> = fit.jacobian.iter().map(|column| masked(column, true)).collect();
    let mut joint = own.clone();
    joint.extend(raw.iter().map(|column| masked(column, true)));
    let target = masked(&fit.residual, true);
    let solve = |columns: &[Vec<f64>], positive: &[bool]| {
        let moment: Vec<f64> = columns.iter().map(|column| dot(column, &target)).collect();
        constrained(&gram(columns), &moment, positive)
    };
    let without = solve(&own, &vec![false; own.len()]);
    let mut positive = vec![false; own.len()];
    positive.extend(&trial.positive);
    let with = solve(&joint, &positive);
    let left = |coefficients: &[f64]| {
        let mut rest = masked(&fit.residual, false);
        for (column, beta) in fit.jacobian.iter().chain(&raw).zip(coefficients) {
            crate::basis::add_scaled(&mut rest, -*beta, &masked(column, false));
        }
        dot(&rest, &rest)
    };
    let before = left(&without);
    let gain = if before > 0.0 { 1.0 - left(&with) / before } else { 0.0 };
    (gain, change)
}

/// Gains measured and on placebos, made comparable between candidates of different freedom by the
/// mean and spread that each has on placebos.
struct Evidence {
    centre: Vec<f64>,
    spread: Vec<f64>,
    measured: Vec<f64>,
    largest: Vec<f64>,
}

impl Evidence {
    fn new(measured: &[f64], null: &[Vec<f64>]) -> Self {
        let count = null.len() as f64;
        let mean = |k: usize| null.iter().map(|row| row[k]).sum::<f64>() / count;
        let centre: Vec<f64> = (0..measured.len()).map(mean).collect();
        let spread: Vec<f64> = (0..measured.len())
            .map(|k| {
                let square: f64 = null.iter().map(|row| (row[k] - centre[k]).powi(2)).sum();
                (square / count).sqrt().max(1e-12)
            })
            .collect();
        let standard = |row: &[f64], k: usize| -> f64 { (row[k] - centre[k]) / spread[k] };
        let largest = null
            .iter()
            .map(|row| (0..row.len()).map(|k| standard(row, k)).fold(f64::MIN, f64::max))
            .collect();
        let measured = (0..measured.len()).map(|k| standard(measured, k)).collect();
        Self { centre, spread, measured, largest }
    }

    fn p_value(&self, k: usize) -> f64 {
        placebo::p_value(self.measured[k], &self.largest)
    }

    /// The share that candidate `k` must remove to be among the largest 5 % of all placebos.
    fn needed(&self, k: usize) -> f64 {
        let mut sorted = self.largest.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let critical = sorted[(sorted.len() * 95 / 100).min(sorted.len() - 1)];
        self.centre[k] + critical * self.spread[k]
    }
}

/// The model with the screened candidate added as it was screened.
pub fn extended(fit: &Fit, candidate: &Screened) -> Fitted {
    fit.model.with(candidate.term, &candidate.values)
}
