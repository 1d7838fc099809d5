//! How well the data determine each parameter: profile likelihood.
//!
//! A parameter is moved away from its estimate, on its own scale and farther each time, and all others
//! are fitted anew. As long as the error grows by no more than chance explains the data allow the
//! value; where that holds up to a bound of the search they do not determine it on that side.
//!
//! How much chance explains follows from the spread of the estimate under errors that may be
//! correlated in any way within blocks of the recording (cluster-robust "sandwich"), against the
//! spread if they were independent: the threshold of the likelihood ratio is scaled by the ratio of
//! the two variances (J. T. Kent, Biometrika 69, 1982).

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::{Free, Identification};
use crate::effects::Scale;

/// Blocks within which errors may be correlated.
const BLOCKS: usize = 20;
/// 97.5 % point of Student's t distribution for `BLOCKS` - 1 degrees of freedom.
const T: f64 = 2.093;
/// A parameter that may be changed by this factor is not determined.
const FACTOR: f64 = 10.0;
/// A mean square error beyond this multiple of the encoder's is one of the model.
const FAILS: f64 = 25.0;
/// Bounds of the first move away from the estimate, as shares of the width of the search.
const FIRST: (f64, f64) = (1e-4, 0.05);
/// Each move is so much longer than the one before.
const LONGER: f64 = 2.0;

/// A 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// False where the data do not determine the value.
    pub identifiable: bool,
}

/// Intervals of the free parameters of `task` around the optimum `x`.
pub fn intervals(task: &Identification<'_>, x: &[f64]) -> Vec<Interval> {
    intervals_over(task, std::slice::from_ref(&x.to_vec()))
}

/// Intervals that cover all optima of `found`, the ends of several searches, that fit as well as the
/// best of them: one valley alone knows nothing of the others.
pub fn intervals_over(task: &Identification<'_>, found: &[Vec<f64>]) -> Vec<Interval> {
    let squares: Vec<f64> =
        task.residuals(found).iter().map(|errors| mean_square(errors)).collect();
    let best = (0..found.len()).min_by(|a, b| squares[*a].total_cmp(&squares[*b]));
    let Some(best) = best else { return Vec::new() };
    let limits = limits(task, &found[best]);
    let mut all = around(task, &found[best], &limits);
    for (x, square) in found.iter().zip(&squares).filter(|(x, _)| **x != found[best]) {
        if limits.iter().all(|(_, limit)| square > limit) {
            continue;
        }
        let others = around(task, x, &limits);
        for (k, (interval, other)) in all.iter_mut().zip(others).enumerate() {
            if *square <= limits[k].1 {
                interval.low = interval.low.min(other.low);
                interval.high = interval.high.max(other.high);
                interval.identifiable &= other.identifiable;
            }
        }
    }
    for (interval, free) in all.iter_mut().zip(task.free()) {
        interval.identifiable &= !wide(free, interval.low, interval.high);
    }
    all
}

fn around(task: &Identification<'_>, x: &[f64], limits: &[(f64, f64)]) -> Vec<Interval> {
    limits
        .par_iter()
        .enumerate()
        .map(|(k, (spread, limit))| interval(task, x, k, *spread, *limit))
        .collect()
}

/// Spread of each parameter around the optimum `x`, and the largest mean square error at which a value
/// still fits.
fn limits(task: &Identification<'_>, x: &[f64]) -> Vec<(f64, f64)> {
    let at_optimum = task.residuals(&[x.to_vec()]).remove(0);
    let spreads = spreads(&jacobian(task, x), &at_optimum);
    let (_, noise) = task.scales();
    let square = mean_square(&at_optimum);
    let samples = at_optimum.len() as f64;
    // Errors far beyond the encoder's are those of the model, and last as long as a block.
    let fails = square > FAILS * noise;
    let limit = |spread: &Spread| {
        let inflation = if fails { samples / BLOCKS as f64 } else { spread.inflation };
        square + square.max(noise) * T * T * inflation / samples
    };
    spreads.iter().map(|spread| (spread.robust, limit(spread))).collect()
}

fn interval(task: &Identification<'_>, x: &[f64], k: usize, spread: f64, limit: f64) -> Interval {
    let free = &task.free()[k];
    let first = if spread.is_finite() { 0.5 * T * spread } else { FIRST.1 };
    let first = first.clamp(FIRST.0, FIRST.1);
    let [low, high] = [-1.0, 1.0].map(|side| reach(task, x, k, side * first, limit));
    let identifiable = spread.is_finite() && !wide(free, low, high);
    Interval { value: x[k], low, high, identifiable }
}

fn wide(free: &Free, low: f64, high: f64) -> bool {
    match free.scale {
        Scale::Log => high > FACTOR * low,
        Scale::Linear => high - low > 0.5 * (free.high - free.low),
    }
}

/// How far parameter `k` can be moved, beginning with the share `first` of its width, with all others
/// fitted anew and the mean square error below `limit`.
fn reach(task: &Identification<'_>, x: &[f64], k: usize, first: f64, limit: f64) -> f64 {
    let free = &task.free()[k];
    let (mut from, mut share) = (x.to_vec(), first);
    // Share and excess of the error of the last point within the limit.
    let mut within = (0.0, 0.0);
    let origin = mean_square(&task.residuals(&[x.to_vec()])[0]);
    loop {
        from[k] = free.moved(x[k], share);
        let ends = from[k] <= free.low || from[k] >= free.high;
        from = task.refine_but(&from, Some(k)).position;
        let square = mean_square(&task.residuals(std::slice::from_ref(&from))[0]);
        if square > limit || square.is_nan() {
            return free.moved(x[k], between(within, (share, square - origin), limit - origin));
        }
        if ends {
            return from[k];
        }
        within = (share, (square - origin).max(0.0));
        share *= LONGER;
    }
}

/// Where the excess reaches `limit` between two points; it grows with the square of the distance.
fn between(within: (f64, f64), beyond: (f64, f64), limit: f64) -> f64 {
    let [a, b, c] = [within.1, beyond.1, limit].map(|excess| excess.max(0.0).sqrt());
    let part = if b.is_finite() && b > a { ((c - a) / (b - a)).clamp(0.0, 1.0) } else { 0.5 };
    within.0 + part * (beyond.0 - within.0)
}

/// Derivatives of the errors by the free parameters, per share of the width of the search.
fn jacobian(task: &Identification<'_>, x: &[f64]) -> DMatrix<f64> {
    let mut candidates = Vec::new();
    for (k, free) in task.free().iter().enumerate() {
        for side in [1.0, -1.0] {
            let mut candidate = x.to_vec();
            candidate[k] = free.moved(x[k], side * DIFFERENCE);
            candidates.push(candidate);
        }
    }
    let errors = task.residuals(&candidates);
    let width = |k: usize| {
        let free = &task.free()[k];
        free.share(candidates[2 * k][k]) - free.share(candidates[2 * k + 1][k])
    };
    let samples = errors.first().map_or(0, Vec::len);
    DMatrix::from_fn(samples, x.len(), |i, k| {
        (errors[2 * k][i] - errors[2 * k + 1][i]) / width(k).max(f64::MIN_POSITIVE)
    })
}

/// Half-width of a difference, as a share of the width of the search.
const DIFFERENCE: f64 = 1e-4;

/// Standard deviation of an estimate, as a share of the width of the search.
struct Spread {
    /// With errors correlated within blocks; infinite where nothing depends on the parameter.
    robust: f64,
    /// Its square over that of independent errors: at least 1, at most the length of a block.
    inflation: f64,
}

fn spreads(jacobian: &DMatrix<f64>, errors: &[f64]) -> Vec<Spread> {
    let (samples, count) = jacobian.shape();
    let block = samples.div_ceil(BLOCKS).max(1);
    let unknown = || Spread { robust: f64::INFINITY, inflation: block as f64 };
    // Columns of length 1, so that the inverse does not depend on units.
    let lengths: Vec<f64> = (0..count).map(|k| jacobian.column(k).norm()).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let scaled = DMatrix::from_fn(samples, count, |i, k| {
        if lengths[k] > 0.0 { jacobian[(i, k)] / lengths[k] } else { 0.0 }
    });
    let normal = scaled.tr_mul(&scaled);
    if !normal.iter().all(|value| value.is_finite()) {
        return (0..count).map(|_| unknown()).collect();
    }
    let Ok(inverse) = normal.pseudo_inverse(1e-9) else {
        return (0..count).map(|_| unknown()).collect();
    };
    let mut middle = DMatrix::zeros(count, count);
    for start in (0..samples).step_by(block) {
        let rows = start..(start + block).min(samples);
        let score = DVector::from_fn(count, |k, _| {
            rows.clone().map(|i| scaled[(i, k)] * errors[i]).sum::<f64>()
        });
        middle += &score * score.transpose();
    }
    let covariance = &inverse * middle * &inverse;
    let square = mean_square(errors);
    (0..count)
        .map(|k| {
            if lengths[k] <= 1e-9 * longest {
                return unknown();
            }
            let robust = covariance[(k, k)].max(0.0);
            let inflation = robust / (square * inverse[(k, k)]).max(f64::MIN_POSITIVE);
            Spread {
                robust: robust.sqrt() / lengths[k],
                inflation: inflation.clamp(1.0, block as f64),
            }
        })
        .collect()
}

fn mean_square(errors: &[f64]) -> f64 {
    errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64
}
