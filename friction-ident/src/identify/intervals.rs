//! How well the data determine each parameter.
//!
//! Two answers are combined. Near the optimum, the covariance of the least-squares estimate with
//! errors that may be correlated in any way within a block of the recording (cluster-robust
//! "sandwich"). Far from it, a scan: how far can a parameter be moved alone before the error grows
//! beyond its uncertainty? Where it can be moved to its bound, the data do not determine it on that
//! side.

use nalgebra::{DMatrix, DVector};

use super::Identification;
use crate::effects::Scale;

/// Blocks within which errors may be correlated.
const BLOCKS: usize = 20;
/// Points of a scan on either side.
const POINTS: usize = 8;
/// 97.5 % point of Student's t distribution for `BLOCKS` - 1 degrees of freedom.
const T: f64 = 2.093;
/// A parameter that may be changed by this factor is not determined.
const FACTOR: f64 = 10.0;

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
    let at_optimum = task.residuals(&[x.to_vec()]).remove(0);
    let jacobian = jacobian(task, x);
    let spread = spread(&jacobian, &at_optimum);
    let (_, noise) = task.scales();
    let square = mean_square(&at_optimum);
    // An increase that the errors of as many independent blocks could hide.
    let limit = square + (square.max(noise)) * T * T / BLOCKS as f64;
    (0..x.len()).map(|k| interval(task, x, k, spread[k], limit)).collect()
}

fn interval(task: &Identification<'_>, x: &[f64], k: usize, spread: f64, limit: f64) -> Interval {
    let free = &task.free()[k];
    let ends = [free.low, free.high].map(|end| reach(task, x, k, end, limit));
    let near = |sign: f64| moved(x[k], sign * T * spread, free.scale).clamp(free.low, free.high);
    let low = if ends[0] <= free.low { free.low } else { near(-1.0) };
    let high = if ends[1] >= free.high { free.high } else { near(1.0) };
    let wide = match free.scale {
        Scale::Log => high > FACTOR * low,
        Scale::Linear => high - low > 0.5 * (free.high - free.low),
    };
    Interval { value: x[k], low, high, identifiable: spread.is_finite() && !wide }
}

/// How far parameter `k` can be moved towards `end` with the error below `limit`.
fn reach(task: &Identification<'_>, x: &[f64], k: usize, end: f64, limit: f64) -> f64 {
    let scale = task.free()[k].scale;
    let at = |j: usize| {
        let share = j as f64 / POINTS as f64;
        match scale {
            Scale::Linear => x[k] + share * (end - x[k]),
            Scale::Log => x[k] * (end / x[k]).powf(share),
        }
    };
    let candidates: Vec<Vec<f64>> = (1..=POINTS)
        .map(|j| {
            let mut candidate = x.to_vec();
            candidate[k] = at(j);
            candidate
        })
        .collect();
    let errors = task.residuals(&candidates);
    let within = errors.iter().take_while(|errors| mean_square(errors) <= limit).count();
    at(within)
}

/// Derivatives of the errors by the free parameters, by central differences on their scales.
fn jacobian(task: &Identification<'_>, x: &[f64]) -> DMatrix<f64> {
    let steps: Vec<f64> = task
        .free()
        .iter()
        .map(|free| match free.scale {
            Scale::Log => 1e-3,
            Scale::Linear => 1e-4 * (free.high - free.low),
        })
        .collect();
    let mut candidates = Vec::new();
    for (k, step) in steps.iter().enumerate() {
        for sign in [1.0, -1.0] {
            let mut candidate = x.to_vec();
            candidate[k] = moved(x[k], sign * step, task.free()[k].scale);
            candidates.push(candidate);
        }
    }
    let errors = task.residuals(&candidates);
    let samples = errors.first().map_or(0, Vec::len);
    DMatrix::from_fn(samples, x.len(), |i, k| {
        (errors[2 * k][i] - errors[2 * k + 1][i]) / (2.0 * steps[k])
    })
}

fn moved(value: f64, by: f64, scale: Scale) -> f64 {
    match scale {
        Scale::Log => value * by.exp(),
        Scale::Linear => value + by,
    }
}

/// Standard deviation of each parameter on its scale; infinite where nothing depends on it.
fn spread(jacobian: &DMatrix<f64>, errors: &[f64]) -> Vec<f64> {
    let (samples, count) = jacobian.shape();
    // Columns of length 1, so that the inverse does not depend on units.
    let lengths: Vec<f64> = (0..count).map(|k| jacobian.column(k).norm()).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let scaled = DMatrix::from_fn(samples, count, |i, k| {
        if lengths[k] > 0.0 { jacobian[(i, k)] / lengths[k] } else { 0.0 }
    });
    let Ok(inverse) = (scaled.tr_mul(&scaled)).pseudo_inverse(1e-9) else {
        return vec![f64::INFINITY; count];
    };
    let mut middle = DMatrix::zeros(count, count);
    let block = samples.div_ceil(BLOCKS).max(1);
    for start in (0..samples).step_by(block) {
        let rows = start..(start + block).min(samples);
        let score = DVector::from_fn(count, |k, _| {
            rows.clone().map(|i| scaled[(i, k)] * errors[i]).sum::<f64>()
        });
        middle += &score * score.transpose();
    }
    let covariance = &inverse * middle * &inverse;
    (0..count)
        .map(|k| {
            let used = lengths[k] > 1e-9 * longest;
            if used { covariance[(k, k)].max(0.0).sqrt() / lengths[k] } else { f64::INFINITY }
        })
        .collect()
}

fn mean_square(errors: &[f64]) -> f64 {
    errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64
}
