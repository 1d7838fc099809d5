//! Best cost against evaluations, over all trials.

use serde::{Deserialize, Serialize};

use super::{Trials, quantile};

/// Statistics of the best cost after a number of evaluations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Evaluations used.
    pub evaluations: u64,
    /// Mean over the trials.
    pub mean: f64,
    /// Median over the trials.
    pub median: f64,
    /// First quartile.
    pub low: f64,
    /// Third quartile.
    pub high: f64,
}

/// Most points of a curve.
const MOST_POINTS: u64 = 1_000_000;

/// Best cost against evaluations. A trial that ended earlier keeps its last value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve(pub Vec<CurvePoint>);

impl Trials {
    /// Statistics of the best cost after `evaluations`.
    pub fn after(&self, evaluations: u64) -> CurvePoint {
        let mut costs: Vec<f64> =
            self.trials.iter().map(|trial| trial.cost_after(evaluations)).collect();
        costs.sort_by(f64::total_cmp);
        let mean = costs.iter().sum::<f64>() / costs.len() as f64;
        let at = |p| quantile(&costs, p);
        CurvePoint { evaluations, mean, median: at(0.5), low: at(0.25), high: at(0.75) }
    }

    /// The curve at multiples of `step` evaluations up to `last`, at most a million points.
    pub fn curve(&self, step: u64, last: u64) -> Curve {
        let step = step.max(1);
        Curve((1..=(last / step).min(MOST_POINTS)).map(|i| self.after(i * step)).collect())
    }

    /// The largest number of evaluations any trial used.
    pub fn longest(&self) -> u64 {
        self.trials.iter().map(|trial| trial.evaluations).max().unwrap_or(0)
    }
}
