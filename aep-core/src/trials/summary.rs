//! What a method's trials come to.

use serde::{Deserialize, Serialize};

use super::{Merit, Trials};

/// A method's trials in numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Name of the method.
    pub method: String,
    /// Number of trials.
    pub trials: usize,
    /// Trials that reached the target.
    pub successes: usize,
    /// Mean of the final costs.
    pub mean: f64,
    /// Median of the final costs.
    pub median: f64,
    /// Quartiles of the final costs.
    pub quartiles: (f64, f64),
    /// Smallest and largest final cost.
    pub range: (f64, f64),
    /// Median evaluations to the target among the successful trials.
    pub evaluations_to_target: Option<f64>,
    /// Expected evaluations to the target when failed runs are started again: evaluations of all
    /// trials (successful ones up to the target) per success. None without a success.
    pub expected_running_time: Option<f64>,
    /// Evaluations without a usable cost, all trials together.
    pub failures: u64,
    /// Seconds per trial, mean.
    pub seconds: f64,
}

impl Trials {
    /// The trials in numbers; successful is a trial that reached `target`.
    pub fn summary(&self, target: f64) -> Summary {
        let mut costs: Vec<f64> = self.trials.iter().map(|trial| trial.cost).collect();
        costs.sort_by(f64::total_cmp);
        let hits: Vec<Option<u64>> =
            self.trials.iter().map(|trial| trial.evaluations_to(target)).collect();
        let mut reached: Vec<f64> = hits.iter().flatten().map(|hit| *hit as f64).collect();
        reached.sort_by(f64::total_cmp);
        let used = self.trials.iter().zip(&hits).map(|(t, hit)| hit.unwrap_or(t.evaluations));
        let spent = used.fold(0, u64::saturating_add);
        let successes = reached.len();
        let count = self.trials.len();
        let seconds: f64 = self.trials.iter().map(|t| t.elapsed.as_secs_f64()).sum();
        Summary {
            method: self.method.clone(),
            trials: count,
            successes,
            mean: costs.iter().sum::<f64>() / count as f64,
            median: quantile(&costs, 0.5),
            quartiles: (quantile(&costs, 0.25), quantile(&costs, 0.75)),
            range: (quantile(&costs, 0.0), quantile(&costs, 1.0)),
            evaluations_to_target: (successes > 0).then(|| quantile(&reached, 0.5)),
            expected_running_time: (successes > 0).then(|| spent as f64 / successes as f64),
            failures: self.trials.iter().fold(0, |sum, t| sum.saturating_add(t.failures.total())),
            seconds: seconds / count as f64,
        }
    }

    /// What [`super::rank_test`] compares.
    pub fn merits(&self, target: f64) -> Vec<Merit> {
        self.trials.iter().map(|t| Merit::new(t.evaluations_to(target), t.cost)).collect()
    }
}

/// The `p`-quantile of ascending values, interpolated linearly between neighbours (type 7); NaN
/// without values.
pub fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = p.clamp(0.0, 1.0) * last as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    if below == above { below } else { below + (above - below) * place.fract() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_neighbours() {
        let values = [1.0, 2.0, 4.0, 8.0];
        assert_eq!(quantile(&values, 0.5), 3.0);
        assert_eq!(quantile(&values, 0.25), 1.75);
        assert_eq!(quantile(&values, 1.0), 8.0);
        assert!(quantile(&[], 0.5).is_nan());
        assert_eq!(quantile(&[f64::INFINITY; 3], 0.5), f64::INFINITY);
    }
}
