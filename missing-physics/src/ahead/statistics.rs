//! Robust sums over prediction errors.

/// Errors beyond this many standard deviations count linearly, not by their square (P. J. Huber).
pub const HUBER: f64 = 4.0;
/// Largest lag of the autocorrelation that deflates a likelihood.
const LAGS: usize = 30;
/// Autocorrelation below which the rest is taken for noise.
const NEGLIGIBLE: f64 = 0.03;

/// Huber's loss of an error in standard deviations, nats.
pub fn loss(z: f64) -> f64 {
    let size = z.abs();
    if size < HUBER { 0.5 * z * z } else { HUBER * size - 0.5 * HUBER * HUBER }
}

/// Sum of the losses of `errors` in units of `scale`.
pub fn total(errors: &[f64], scale: f64) -> f64 {
    errors.iter().map(|e| loss(e / scale)).sum()
}

/// Weight of an error in least squares that solve Huber's problem.
pub fn weight(z: f64) -> f64 {
    1.0 / (z.abs() / HUBER).max(1.0)
}

/// Root mean square; squares beyond `cut` times their mean count as that.
pub fn rms(errors: &[f64], cut: f64) -> f64 {
    let count = errors.len().max(1) as f64;
    let mean = errors.iter().map(|e| e * e).sum::<f64>() / count;
    (errors.iter().map(|e| (e * e).min(cut * mean)).sum::<f64>() / count).sqrt()
}

/// Median size, as the standard deviation of normal errors.
pub fn spread(errors: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// How many errors say as much as one that is independent: `1 + 2 sum` of the positive autocorrelations.
pub fn correlation(errors: &[f64]) -> f64 {
    let count = errors.len().max(1) as f64;
    let deviation = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
    let cut: Vec<f64> = errors.iter().map(|e| e.clamp(-6.0 * deviation, 6.0 * deviation)).collect();
    let mean = cut.iter().sum::<f64>() / count;
    let z: Vec<f64> = cut.iter().map(|e| e - mean).collect();
    let square = crate::basis::dot(&z, &z);
    let mut factor = 1.0;
    for lag in 1..LAGS.min(z.len()) {
        let r = crate::basis::dot(&z[..z.len() - lag], &z[lag..]) / square;
        // Not a number counts as nothing.
        if r.is_nan() || r < NEGLIGIBLE {
            break;
        }
        factor += 2.0 * r;
    }
    factor
}
