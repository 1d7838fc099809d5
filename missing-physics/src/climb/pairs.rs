//! Which two candidates together explain what no single one does.
//!
//! Two effects that pull in opposite directions hide each other: a hump of friction at low speed and a drag
//! at high speed leave a viscous fit between them, and either one alone makes it worse elsewhere. So each
//! candidate, with the shape that is best for it alone, is joined by every shape of every other one.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::climb::evidence::Evidence;
use crate::climb::screen::{self, Screening, Trial};
use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::statistics::basis::{Basis, constrained, dot, weighed};

/// A candidate with more trials than this (a ripple of hundreds of periods) takes part with the one that is
/// best for it alone.
const MOST_TRIALS: usize = 160;

/// Two candidates with the shapes that were best together.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Indices of the terms.
    pub terms: [usize; 2],
    /// Shape parameters of either.
    pub shapes: [Vec<f64>; 2],
    /// Share of the weighted squared error that they remove together on all data.
    pub gain_all: f64,
    /// Chance that any pair gains as much, for its freedom, on a placebo.
    pub p_value: f64,
}

/// Screens all pairs of the candidates against the residual of `fit`; best first. Where none removes a share
/// of `least`, none is returned and no placebo is looked at.
pub fn screen<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    screening: &Screening<'_>,
    least: f64,
) -> Vec<Pair> {
    let own =
        Basis::of(&fit.jacobian.iter().map(|c| weighed(c, screening.weights)).collect::<Vec<_>>());
    let trials = screen::trials(family, fit, screening, &own);
    let residuals = screen::residuals(fit, screening);
    let falls = screen::falls(&trials, &residuals);
    let joint = Joint::new(&trials, screening.candidates.len());
    let on = |(k, residual): (usize, &Vec<f64>)| {
        let mut rest = residual.clone();
        own.project_out(&mut rest);
        joint.best(&rest, &joint.alone(&falls, k))
    };
    let measured = on((0, &residuals[0]));
    if measured.iter().flatten().all(|best| best.share < least) {
        return Vec::new();
    }
    let mut best: Vec<Vec<Option<Best>>> =
        residuals[1..].par_iter().enumerate().map(|(k, residual)| on((k + 1, residual))).collect();
    best.insert(0, measured);
    let share = |best: &Option<Best>| best.map_or(0.0, |best| best.share);
    let rows: Vec<Vec<f64>> = best.iter().map(|row| row.iter().map(share).collect()).collect();
    let evidence = Evidence::new(&rows[0], &rows[1..]);
    let mut pairs: Vec<Pair> = best[0]
        .iter()
        .enumerate()
        .filter_map(|(k, best)| {
            let best = (*best)?;
            let trials = best.trials.map(|k| &trials[k]);
            Some(Pair {
                terms: trials.map(|trial| screening.candidates[trial.candidate]),
                shapes: trials.map(|trial| trial.shape.clone()),
                gain_all: best.share,
                p_value: evidence.p_value(k),
            })
        })
        .collect();
    pairs.sort_by(|a, b| b.gain_all.total_cmp(&a.gain_all));
    pairs
}

/// The best shapes of a pair on one residual.
#[derive(Clone, Copy)]
struct Best {
    trials: [usize; 2],
    share: f64,
}

/// Scalar products of everything with everything.
struct Joint<'a> {
    trials: &'a [Trial],
    candidates: usize,
    /// Trials of each candidate that take part with all their shapes; none for one with too many.
    profiled: Vec<Vec<usize>>,
    /// Row of the first column of a trial in `gram`, for profiled ones.
    row: Vec<Option<usize>>,
    gram: DMatrix<f64>,
    columns: DMatrix<f64>,
}

impl<'a> Joint<'a> {
    fn new(trials: &'a [Trial], candidates: usize) -> Self {
        let mut profiled: Vec<Vec<usize>> = vec![Vec::new(); candidates];
        for (k, trial) in trials.iter().enumerate() {
            profiled[trial.candidate].push(k);
        }
        profiled.iter_mut().filter(|of| of.len() > MOST_TRIALS).for_each(Vec::clear);
        let mut row = vec![None; trials.len()];
        let mut columns: Vec<&Vec<f64>> = Vec::new();
        for &k in profiled.iter().flatten() {
            row[k] = Some(columns.len());
            columns.extend(&trials[k].columns);
        }
        let points = columns.first().map_or(0, |column| column.len());
        let columns = DMatrix::from_fn(columns.len(), points, |r, i| columns[r][i]);
        let gram = &columns * columns.transpose();
        Self { trials, candidates, profiled, row, gram, columns }
    }

    /// The trial of each candidate that is best alone on residual `k`.
    fn alone(&self, falls: &[Vec<f64>], k: usize) -> Vec<Option<usize>> {
        let mut best: Vec<Option<usize>> = vec![None; self.candidates];
        for (trial, fall) in falls.iter().enumerate() {
            let place = &mut best[self.trials[trial].candidate];
            if place.is_none_or(|other| fall[k] > falls[other][k]) {
                *place = Some(trial);
            }
        }
        best
    }

    /// Scalar products of all profiled columns with another one.
    fn products(&self, column: &[f64]) -> Vec<f64> {
        if self.columns.nrows() == 0 {
            return Vec::new();
        }
        let product = &self.columns * DMatrix::from_column_slice(column.len(), 1, column);
        product.as_slice().to_vec()
    }

    /// The best of every pair on a residual free of the model's own columns, in a fixed order.
    fn best(&self, residual: &[f64], alone: &[Option<usize>]) -> Vec<Option<Best>> {
        let total = dot(residual, residual).max(f64::MIN_POSITIVE);
        let moments = self.products(residual);
        let mut pairs = vec![None; self.candidates * self.candidates.saturating_sub(1) / 2];
        for (a, first) in alone.iter().enumerate() {
            let Some(first) = *first else { continue };
            let own = Own::new(self, first, residual);
            for b in (0..self.candidates).filter(|&b| b != a) {
                let place = &mut pairs[place(a, b)];
                for &second in &self.profiled[b] {
                    let share = own.with(self, second, &moments) / total;
                    if place.is_none_or(|best: Best| share > best.share) {
                        *place = Some(Best { trials: [first, second], share });
                    }
                }
            }
        }
        pairs
    }
}

/// Number of an unordered pair.
fn place(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high - 1) / 2 + low
}

/// A trial that is held while others join it.
struct Own<'a> {
    trial: &'a Trial,
    moment: Vec<f64>,
    /// Scalar products of its columns with all profiled ones.
    cross: Vec<Vec<f64>>,
}

impl<'a> Own<'a> {
    fn new(joint: &Joint<'a>, index: usize, residual: &[f64]) -> Self {
        let trial = &joint.trials[index];
        let cross = match joint.row[index] {
            Some(row) => (row..row + trial.columns.len())
                .map(|r| joint.gram.column(r).iter().copied().collect())
                .collect(),
            None => trial.columns.iter().map(|column| joint.products(column)).collect(),
        };
        let moment = trial.columns.iter().map(|column| dot(column, residual)).collect();
        Self { trial, moment, cross }
    }

    /// Fall of the square with `second` beside it.
    fn with(&self, joint: &Joint<'_>, second: usize, moments: &[f64]) -> f64 {
        let other = &joint.trials[second];
        let row = joint.row[second].unwrap_or_default();
        let (n, m) = (self.trial.columns.len(), other.columns.len());
        let mut gram = vec![vec![0.0; n + m]; n + m];
        for (i, (own, cross)) in self.trial.gram.iter().zip(&self.cross).enumerate() {
            gram[i][..n].copy_from_slice(own);
            for j in 0..m {
                gram[i][n + j] = cross[row + j];
                gram[n + j][i] = cross[row + j];
            }
        }
        for j in 0..m {
            gram[n + j][n..].copy_from_slice(&other.gram[j]);
        }
        let moment = [self.moment.as_slice(), &moments[row..row + m]].concat();
        let positive = [self.trial.positive.as_slice(), &other.positive].concat();
        let beta = constrained(&gram, &moment, &positive);
        dot(&beta, &moment).max(0.0)
    }
}
