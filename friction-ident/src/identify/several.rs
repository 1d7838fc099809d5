//! Several searches, each to the bottom of its valley: several valleys may fit as well.

use aep_core::{Budget, Method, Refined};

use super::{Identification, IdentifyError, Interval, intervals_over};
use crate::model::Model;

/// Searches from the same start with other seeds.
const SEARCHES: u64 = 3;

/// What several searches found.
pub struct Searched {
    /// The best model.
    pub model: Model,
    /// Values of its free parameters.
    pub position: Vec<f64>,
    /// Their 95 % intervals, over all valleys that fit as well; nothing where it was stopped before.
    pub intervals: Option<Vec<Interval>>,
    /// Position error of the best model, m or rad rms.
    pub rms: f64,
    /// Searches that were made.
    pub searches: usize,
}

impl Identification<'_> {
    /// Searches several times and takes the best; once it is stopped what there is.
    ///
    /// # Errors
    /// The method does not fit the task, or nothing could be evaluated.
    pub fn from_several_starts(
        &self,
        method: &dyn Method,
        budget: &Budget,
        seed: u64,
    ) -> Result<Searched, IdentifyError> {
        let mut found: Vec<Refined> = Vec::new();
        for search in 0..SEARCHES {
            if search > 0 && self.is_stopped() {
                break;
            }
            let end = self.run_from(&[self.start()], method, budget.clone(), seed + search)?;
            // Nothing was evaluated where there was no time at all.
            let from = if end.position.is_empty() { self.start() } else { end.position };
            found.push(self.refine_around(&from));
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // The first search is always made.
        let position = found[0].position.clone();
        let optima: Vec<Vec<f64>> = found.iter().map(|found| found.position.clone()).collect();
        // Intervals are refits as well; whoever stops wants to go.
        let intervals = (!self.is_stopped()).then(|| intervals_over(self, &optima));
        let errors = self.errors(&position);
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt();
        let model = self.model(&position)?;
        Ok(Searched { model, position, intervals, rms, searches: found.len() })
    }
}
