//! Candidates that have been re-identified with the whole model, and which of them to take.

use crate::fit::Fit;

/// A rival's squared error is larger by at most this share.
const RIVAL: f64 = 0.05;
/// Beside a best candidate at a limit of its search, a rival removes at least this share of what that does.
const NEARLY: f64 = 0.9;
/// A rival's excess over the best in standard errors of the difference.
const STANDARD_ERRORS: f64 = 1.0;
/// Pieces of time for the standard error of a mean.
const PIECES: usize = 15;

/// A candidate re-identified with the whole model.
pub struct Tried {
    /// What was added: one term, or two that only help together.
    pub terms: Vec<usize>,
    /// The whole model with them.
    pub fit: Fit,
    /// Mean squared residual on all data.
    pub square: f64,
    /// That of the screening.
    pub p_value: f64,
}

impl Tried {
    /// A fit that has been made.
    pub fn new(terms: &[usize], fit: Fit, p_value: f64) -> Self {
        Self { terms: terms.to_vec(), square: square(&fit), fit, p_value }
    }
}

/// Of candidates, the best first, and those that are as good the one with the fewest parameters. A best
/// one with a parameter at a limit of its search is a simpler law in disguise: one that removes
/// nearly as much is as good.
pub fn simplest(tried: &[Tried], before: f64, best_at_bound: bool) -> Option<usize> {
    let best = tried.first()?;
    let parameters = |k: &usize| tried[*k].fit.model.values.len();
    let removes = |rival: &Tried| before - rival.square >= NEARLY * (before - best.square);
    let good = |k: &usize| {
        let rival = &tried[*k];
        *k == 0 || as_good(rival, best, before) || (best_at_bound && removes(rival))
    };
    (0..tried.len()).filter(good).min_by_key(parameters)
}

/// Mean squared residual on all data.
pub fn square(fit: &Fit) -> f64 {
    fit.residual.iter().map(|value| value * value).sum::<f64>() / fit.residual.len() as f64
}

/// Whether the data cannot tell a rival from the best: the rival removes half as much at least,
/// and its squared error is larger by less than a few per cent or by less than the differences
/// between pieces of time make likely. All data count: what a handful of
/// parameters gains by being fitted is small against what a third of the data leaves to chance.
pub fn as_good(rival: &Tried, best: &Tried, before: f64) -> bool {
    let (removed, more) = (before - best.square, rival.square - best.square);
    let pairs = rival.fit.residual.iter().zip(&best.fit.residual);
    let differences: Vec<f64> = pairs.map(|(a, b)| a * a - b * b).collect();
    let by_chance = STANDARD_ERRORS * error_of_mean(&differences);
    more < 0.5 * removed && (more < RIVAL * best.square || more < by_chance)
}

/// Standard error of the mean of autocorrelated values, from the means of contiguous pieces.
fn error_of_mean(values: &[f64]) -> f64 {
    let size = values.len().div_ceil(PIECES).max(1);
    let means: Vec<f64> =
        values.chunks(size).map(|piece| piece.iter().sum::<f64>() / piece.len() as f64).collect();
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let square: f64 = means.iter().map(|piece| (piece - mean).powi(2)).sum();
    (square / (count * (count - 1.0).max(1.0))).sqrt()
}
