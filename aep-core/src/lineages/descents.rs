//! Descents on the residuals, beside the search.

use serde::{Deserialize, Serialize};

use super::descent::{Descent, End};
use crate::random::{self, Stream};

/// Evaluations per component that the search is taken to have made at the start: before that it gets nowhere, so that
/// descents come first.
const HEAD_START: u64 = 100;

/// Where descents begin, and how evaluations are shared with the search: whoever has made fewer is next.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Descents {
    dimension: usize,
    /// How many places a descent chooses its start from.
    places: usize,
    descent: Descent,
    ends: Vec<End>,
    /// Evaluations of the descents, and those charged to the search.
    spent: u64,
    of_search: u64,
    /// The best of the search since a descent has begun there.
    found: Option<End>,
    from_search: bool,
}

impl Descents {
    /// The first one, from the best of the first population.
    pub fn new(
        dimension: usize,
        places: Vec<f64>,
        (costs, residuals): (&[f64], &[Vec<f64>]),
        rng: &mut Stream,
    ) -> Self {
        let mut descents = Self {
            dimension,
            places: costs.len(),
            descent: Descent::new(dimension, places),
            ends: Vec::new(),
            spent: 0,
            of_search: HEAD_START * dimension as u64,
            found: None,
            from_search: false,
        };
        descents.tell(costs, residuals, f64::INFINITY, rng);
        descents
    }

    /// Whether they are asked next, not the search.
    pub fn are_next(&self) -> bool {
        self.spent <= self.of_search
    }

    /// What is to be evaluated next.
    pub fn asked(&self) -> &[f64] {
        self.descent.asked()
    }

    /// Takes the costs and residuals of what was asked.
    pub fn tell(&mut self, costs: &[f64], residuals: &[Vec<f64>], lowest: f64, rng: &mut Stream) {
        self.spent += costs.len() as u64;
        self.descent.tell(costs, residuals, lowest, &self.ends);
        if self.descent.ended() {
            self.ends.extend(self.descent.end());
            self.begin(rng);
        }
    }

    /// The next descent: from where the search has come since, if the last one was not from there; otherwise from the best
    /// of some random places.
    fn begin(&mut self, rng: &mut Stream) {
        let n = self.dimension;
        let found = self.found.take_if(|_| !self.from_search);
        self.from_search = found.is_some();
        let places = match found {
            Some(found) => found.at,
            None => (0..n * self.places).map(|_| random::uniform(rng)).collect(),
        };
        self.descent = Descent::new(n, places);
    }

    /// Notes evaluations of the search, and the best of them.
    pub fn note(&mut self, evaluations: usize, best: Option<End>) {
        self.of_search += evaluations as u64;
        let reference = self.found.as_ref().map_or(f64::INFINITY, |found| found.cost);
        self.found = best.filter(|best| best.cost < reference).or(self.found.take());
    }
}
