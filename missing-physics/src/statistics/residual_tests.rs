//! Is what remains noise? Two tests of a residual: whether it resembles itself some steps later, and
//! whether it follows an input.
//!
//! # Whiteness
//! The statistic of Ljung and Box (Biometrika 65, 1978), generalised in two ways. The comparison's own
//! smoothing correlates neighbouring points of even white noise: its autocorrelation is the expected
//! one, and the covariance of the estimates around it is Bartlett's. And noise whose size changes with
//! the motion scatters the estimates more than steady noise: their variances are scaled up
//! accordingly (Lobato, Nankervis and Savin, International Economic Review 42, 2001). Degrees of
//! freedom are lags, less one for each past output that the model was fitted to predict from; a model
//! that sees only inputs loses none.
//!
//! # Independence of the input
//! The cross-correlation with an input scatters by the autocorrelation of *both*; the bound
//! `1.96 / sqrt(n)` that is often drawn holds for white ones alone. Here bound and p-value come from the
//! residual shifted against the motion, which keeps both.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::report::{Independence, Whiteness};
use crate::statistics::autocorrelation::{autocorrelation, centred, interval, lagged, pieces};
use crate::statistics::basis::dot;
use crate::statistics::placebo;

/// Lags to either side over which the residual is correlated with an input.
const LAGS: isize = 24;
/// Number of rearranged residuals.
const PLACEBOS: usize = 199;
/// Half-width of a 95 % band in standard deviations.
const BAND: f64 = 1.96;
/// Fewest points of a test.
const LEAST: usize = 50;

/// Tests `residual` on a grid of `time`. `colour` is the autocorrelation at lag 1, 2, ... that the
/// comparison gives to white noise, `past_outputs` the number of past outputs the model was fitted to
/// predict from. Nothing where there are too few points or nothing varies.
pub fn whiteness(
    residual: &[f64],
    time: &[f64],
    colour: &[f64],
    past_outputs: usize,
) -> Option<Whiteness> {
    let points = residual.len();
    if points < LEAST {
        return None;
    }
    let lags = ((10.0 * (points as f64).log10()) as usize).min(points / 5).max(1);
    let pieces = pieces(time);
    let found = autocorrelation(residual, &pieces, lags);
    if found[0] == 0.0 {
        return None;
    }
    let expected = |lag: isize| match lag.unsigned_abs() {
        0 => 1.0,
        lag => colour.get(lag - 1).copied().unwrap_or(0.0),
    };
    let centred = centred(residual);
    let squares: Vec<f64> = centred.iter().map(|value| value * value).collect();
    let variance = squares.iter().sum::<f64>() / points as f64;
    let mut scale = Vec::with_capacity(lags);
    let mut deviation = DVector::zeros(lags);
    for lag in 1..=lags {
        let (sum, pairs) = lagged(&squares, &squares, &pieces, lag as isize);
        let pairs = pairs.max(1) as f64;
        let rho = expected(lag as isize);
        let steady = variance * variance * (1.0 + 2.0 * rho * rho);
        scale.push((sum / pairs / steady).max(1.0).sqrt());
        // Ljung and Box: a lag has fewer pairs than there are points.
        let full = points as f64 / pairs;
        deviation[lag - 1] = (found[lag] * full - rho) * (pairs / points as f64).sqrt();
    }
    let covariance = DMatrix::from_fn(lags, lags, |i, j| {
        let weight = |i: isize, k: isize| {
            expected(i + k) + expected(i - k) - 2.0 * expected(i) * expected(k)
        };
        let (k, l) = (i as isize + 1, j as isize + 1);
        let sum: f64 =
            (1..=(lags + colour.len()) as isize).map(|i| weight(i, k) * weight(i, l)).sum();
        sum * scale[i] * scale[j] / points as f64
    });
    let ridge = DMatrix::identity(lags, lags) * (1e-6 / points as f64);
    let statistic = (covariance.clone() + ridge)
        .cholesky()
        .map(|cholesky| deviation.dot(&cholesky.solve(&deviation)))?;
    let degrees_of_freedom = lags.saturating_sub(past_outputs).max(1);
    let p_value = ChiSquared::new(degrees_of_freedom as f64).ok()?.sf(statistic);
    let bound: Vec<f64> = (0..lags).map(|k| BAND * covariance[(k, k)].sqrt()).collect();
    let expected: Vec<f64> = (1..=lags as isize).map(expected).collect();
    let autocorrelation = found[1..].to_vec();
    let inside = |k: &usize| (autocorrelation[*k] - expected[*k]).abs() <= bound[*k];
    let interval_s = interval(time);
    let memory_s = (0..lags).find(inside).map(|k| interval_s * k as f64);
    Some(Whiteness {
        interval_s,
        autocorrelation,
        expected,
        bound,
        statistic,
        degrees_of_freedom,
        p_value,
        memory_s,
    })
}

/// Correlates `residual` on a grid of `time` with `input`. `motion` holds signals whose self-similarity
/// makes a shift useless as a placebo. Nothing where there are too few points or nothing varies.
pub fn independence(
    name: &str,
    input: &[f64],
    residual: &[f64],
    time: &[f64],
    motion: &[Vec<f64>],
    seed: u64,
) -> Option<Independence> {
    let points = residual.len();
    if points < LEAST.max(4 * LAGS as usize) {
        return None;
    }
    let pieces = pieces(time);
    let (input, residual) = (centred(input), centred(residual));
    let size = (dot(&input, &input) * dot(&residual, &residual)).sqrt();
    if size.is_nan() || size <= 0.0 {
        return None;
    }
    let correlate = |residual: &[f64]| -> Vec<f64> {
        (-LAGS..=LAGS).map(|lag| lagged(&input, residual, &pieces, lag).0 / size).collect()
    };
    let correlation = correlate(&residual);
    let placebos: Vec<Vec<f64>> = placebo::rearrangements(points, PLACEBOS, motion, seed)
        .iter()
        .map(|order| correlate(&order.iter().map(|&k| residual[k]).collect::<Vec<f64>>()))
        .collect();
    let deviation: Vec<f64> = (0..correlation.len())
        .map(|k| {
            let square: f64 = placebos.iter().map(|row| row[k] * row[k]).sum();
            (square / placebos.len() as f64).sqrt().max(f64::MIN_POSITIVE)
        })
        .collect();
    let standing_out = |row: &[f64]| {
        row.iter()
            .zip(&deviation)
            .map(|(c, d)| (c / d).abs())
            .enumerate()
            .fold((0, 0.0), |best, now| if now.1 > best.1 { now } else { best })
    };
    let (worst, height) = standing_out(&correlation);
    let null: Vec<f64> = placebos.iter().map(|row| standing_out(row).1).collect();
    let step = interval(time);
    let lag_s: Vec<f64> = (-LAGS..=LAGS).map(|lag| lag as f64 * step).collect();
    Some(Independence {
        input: name.to_owned(),
        worst_lag_s: lag_s[worst],
        worst: correlation[worst],
        lag_s,
        correlation,
        bound: deviation.iter().map(|d| BAND * d).collect(),
        p_value: placebo::p_value(height, &null),
    })
}

#[cfg(test)]
mod tests;
