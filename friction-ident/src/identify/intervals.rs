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
//!
//! That holds for errors of the measurement. Where the model errs by more than the encoder, its own
//! simulation may be why: motion that sticks and slips carries any small difference on, and a search finds
//! parameters that make up for it. Then every value is allowed at which the error is no larger than what
//! a finer step of integration changes, and no velocity below one count a sample has a lower limit.

use aep_core::Scale;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::{Free, Identification};
use crate::axis::Quantity;

/// Blocks within which errors may be correlated.
const BLOCKS: usize = 20;
/// 97.5 % point of Student's t distribution for `BLOCKS` - 1 degrees of freedom.
const T: f64 = 2.093;
/// A parameter that may be changed by this factor is not determined.
const FACTOR: f64 = 10.0;
/// A mean square error beyond this multiple of the encoder's is one of the model.
const FAILS: f64 = 25.0;
/// Parts that every step is divided into, to see what the integration adds.
const PARTS: [usize; 2] = [2, 3];
/// Counts of an encoder per standard deviation of its error.
const COUNTS: f64 = 3.464_101_615;
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
    let fails = squares[best] > FAILS * task.scales().1;
    // The best optimum may be the one that happens to bear the step well.
    let step =
        if fails { found.iter().map(|x| step_error(task, x)).fold(0.0, f64::max) } else { 0.0 };
    let limits = limits(task, &found[best], fails, step);
    let mut all = around(task, &found[best], &limits, fails);
    for (x, square) in found.iter().zip(&squares).filter(|(x, _)| **x != found[best]) {
        if limits.iter().all(|(_, limit)| square > limit) {
            continue;
        }
        let others = around(task, x, &limits, fails);
        for (k, (interval, other)) in all.iter_mut().zip(others).enumerate() {
            if *square <= limits[k].1 {
                interval.low = interval.low.min(other.low);
                interval.high = interval.high.max(other.high);
                interval.identifiable &= other.identifiable;
            }
        }
    }
    for (interval, free) in all.iter_mut().zip(task.free()) {
        if fails && unresolved(task, free, interval.high) {
            interval.low = free.low;
            interval.identifiable = false;
        }
        interval.identifiable &= !wide(free, interval.low, interval.high);
    }
    all
}

fn around(
    task: &Identification<'_>,
    x: &[f64],
    limits: &[(f64, f64)],
    fails: bool,
) -> Vec<Interval> {
    limits
        .par_iter()
        .enumerate()
        .map(|(k, (spread, limit))| interval(task, x, k, *spread, Limit { square: *limit, fails }))
        .collect()
}

/// What the integration adds to the mean square error at `x`, m^2 or rad^2.
fn step_error(task: &Identification<'_>, x: &[f64]) -> f64 {
    PARTS.iter().map(|parts| task.step_error(x, *parts)).fold(0.0, f64::max)
}

/// Whether `value` is a velocity below one count a sample.
fn unresolved(task: &Identification<'_>, free: &Free, value: f64) -> bool {
    let velocity =
        task.model.parameter(&free.address).is_some_and(|p| p.quantity == Quantity::Velocity);
    velocity && value < COUNTS * task.scales().1.sqrt() / task.sample_time()
}

/// Where a value no longer fits.
#[derive(Clone, Copy)]
struct Limit {
    /// Largest mean square error, m^2 or rad^2.
    square: f64,
    /// Whether the model errs by more than the encoder.
    fails: bool,
}

impl Limit {
    /// Whether `x` with this mean square error fits.
    fn allows(self, task: &Identification<'_>, x: &[f64], square: f64) -> bool {
        square <= self.square || (self.fails && square <= step_error(task, x))
    }
}

/// Spread of each parameter around the optimum `x`, and the largest mean square error at which a value
/// still fits; `step` is what the integration adds.
fn limits(task: &Identification<'_>, x: &[f64], fails: bool, step: f64) -> Vec<(f64, f64)> {
    let at_optimum = task.residuals(&[x.to_vec()]).remove(0);
    let spreads = spreads(&jacobian(task, x), &at_optimum);
    let (_, noise) = task.scales();
    let square = mean_square(&at_optimum);
    let samples = at_optimum.len() as f64;
    // Errors far beyond the encoder's are those of the model, and last as long as a block.
    let limit = |spread: &Spread| {
        let inflation = if fails { samples / BLOCKS as f64 } else { spread.inflation };
        square + step.max(square.max(noise) * T * T * inflation / samples)
    };
    spreads.iter().map(|spread| (spread.robust, limit(spread))).collect()
}

fn interval(task: &Identification<'_>, x: &[f64], k: usize, spread: f64, limit: Limit) -> Interval {
    let free = &task.free()[k];
    let first = if spread.is_finite() { 0.5 * T * spread } else { FIRST.1 };
    let first = first.clamp(FIRST.0, FIRST.1);
    let [low, high] = [-1.0, 1.0].map(|side| reach(task, x, k, side * first, limit));
    let identifiable = spread.is_finite() && !wide(free, low, high);
    Interval { value: x[k], low, high, identifiable }
}

fn wide(free: &Free, low: f64, high: f64) -> bool {
    if low <= free.low && high >= free.high {
        return true;
    }
    match free.scale {
        Scale::Log => high > FACTOR * low,
        Scale::Linear => high - low > 0.5 * (free.high - free.low),
    }
}

/// How far parameter `k` can be moved, beginning with the share `first` of its width, with all others
/// fitted anew and the mean square error below `limit`.
fn reach(task: &Identification<'_>, x: &[f64], k: usize, first: f64, limit: Limit) -> f64 {
    let free = &task.free()[k];
    let (mut from, mut share) = (x.to_vec(), first);
    // Share and excess of the error of the last point within the limit.
    let mut within = (0.0, 0.0);
    let origin = mean_square(&task.residuals(&[x.to_vec()])[0]);
    loop {
        from[k] = task.domain.shifted(k, x[k], share);
        let ends = from[k] <= free.low || from[k] >= free.high;
        from = task.refine_but(&from, k).position;
        let square = mean_square(&task.residuals(std::slice::from_ref(&from))[0]);
        if !limit.allows(task, &from, square) {
            if fits_at_bound(task, x, k, first, limit) {
                return if first > 0.0 { free.high } else { free.low };
            }
            let excess = limit.square - origin;
            return task.domain.shifted(k, x[k], between(within, (share, square - origin), excess));
        }
        if ends {
            return from[k];
        }
        within = (share, (square - origin).max(0.0));
        share *= LONGER;
    }
}

/// Whether the bound on this side fits although values before it do not: stick and slip make many
/// valleys, so this is asked where the model errs by more than the encoder.
fn fits_at_bound(task: &Identification<'_>, x: &[f64], k: usize, side: f64, limit: Limit) -> bool {
    if !limit.fails {
        return false;
    }
    let free = &task.free()[k];
    let mut at = x.to_vec();
    at[k] = if side > 0.0 { free.high } else { free.low };
    let at = task.refine_but(&at, k).position;
    let square = mean_square(&task.residuals(std::slice::from_ref(&at))[0]);
    limit.allows(task, &at, square)
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
    for k in 0..x.len() {
        for side in [1.0, -1.0] {
            let mut candidate = x.to_vec();
            candidate[k] = task.domain.shifted(k, x[k], side * DIFFERENCE);
            candidates.push(candidate);
        }
    }
    let errors = task.residuals(&candidates);
    let width = |k: usize| {
        let share = |candidate: usize| task.domain.share(k, candidates[candidate][k]);
        share(2 * k) - share(2 * k + 1)
    };
    let samples = errors.first().map_or(0, Vec::len);
    DMatrix::from_fn(samples, x.len(), |i, k| {
        (errors[2 * k][i] - errors[2 * k + 1][i]) / width(k).max(f64::MIN_POSITIVE)
    })
}

/// Half-width of a difference, as a share of the width of the search.
const DIFFERENCE: f64 = 1e-4;

/// Share of the largest curvature up to which there is none.
const SAME: f64 = 1e-6;
/// Share of the largest move along such a direction from which a parameter takes part in it.
const PART: f64 = 1e-2;

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
    let Ok(inverse) = normal.clone().pseudo_inverse(1e-9) else {
        return (0..count).map(|_| unknown()).collect();
    };
    let undetermined = undetermined(&normal, &lengths);
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
            if lengths[k] <= 1e-9 * longest || undetermined[k] {
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

/// Which parameters change along a direction that changes no error: together they are not determined,
/// however much each of them does alone.
fn undetermined(normal: &DMatrix<f64>, lengths: &[f64]) -> Vec<bool> {
    let eigen = normal.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let mut found = vec![false; lengths.len()];
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > SAME * largest {
            continue;
        }
        let moves: Vec<f64> =
            vector.iter().zip(lengths).map(|(v, length)| v.abs() / length).collect();
        let most = moves.iter().copied().filter(|m| m.is_finite()).fold(0.0, f64::max);
        found.iter_mut().zip(&moves).for_each(|(found, m)| *found |= *m > PART * most);
    }
    found
}

fn mean_square(errors: &[f64]) -> f64 {
    errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64
}
