//! Descents on the residuals, beside the search.

use serde::{Deserialize, Serialize};

use super::descent::{Descent, End};
use crate::random::{self, Stream};

/// Evaluations per component that the search is taken to have made at the start: before that it gets nowhere, so that
/// descents come first.
fn head_start() -> f64 {
    std::env::var("K_HEAD").ok().and_then(|v| v.parse().ok()).unwrap_or(100.0)
}
fn k_places(n: usize) -> usize {
    let f = std::env::var("K_PLACES").ok().and_then(|v| v.parse().ok()).unwrap_or(1.0);
    ((4.0 + 3.0 * (n as f64).ln()) * f).max(1.0) as usize
}

/// Where descents begin, and how evaluations are shared with the search.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Descents {
    dimension: usize,
    descent: Descent,
    ends: Vec<End>,
    spent: u64,
    of_search: u64,
    /// The best of the search since a descent has begun there.
    found: Option<End>,
    from_search: bool,
}

impl Descents {
    /// The first one, from the best of the first population.
    pub fn new(dimension: usize, places: Vec<f64>, costs: &[f64], residuals: &[Vec<f64>]) -> Self {
        let mut descent = Descent::new(dimension, places);
        descent.tell(costs, residuals, f64::INFINITY, &[]);
        let of_search = (head_start() * dimension as f64) as u64;
        Self { dimension, descent, ends: Vec::new(), spent: 0, of_search, found: None, from_search: false }
    }

    /// Whether they are asked next, not the search.
    pub fn are_next(&self) -> bool {
        self.spent <= self.of_search
    }

    pub fn ask(&self, points: &mut Vec<f64>) {
        points.extend_from_slice(self.descent.asked());
    }

    /// Takes the costs and residuals of what was asked.
    pub fn tell(&mut self, costs: &[f64], residuals: &[Vec<f64>], lowest: f64, rng: &mut Stream) {
        self.spent += costs.len() as u64;
        self.descent.tell(costs, residuals, lowest, &self.ends);
        if self.descent.ended() {
            if std::env::var("K_LOG").is_ok() {
                eprintln!("end {:?} spent {} from search {}", self.descent.end().map(|e| e.cost), self.spent, self.from_search);
            }
            self.ends.extend(self.descent.end());
            self.begin(rng);
        }
    }

    fn begin(&mut self, rng: &mut Stream) {
        let n = self.dimension;
        let found = self.found.take_if(|_| !self.from_search);
        self.from_search = found.is_some();
        let places = match found {
            Some(found) => found.at,
            None => (0..n * k_places(n)).map(|_| random::uniform(rng)).collect(),
        };
        self.descent = Descent::new(n, places);
    }

    /// Notes evaluations of the search, and the best of them.
    pub fn note(&mut self, evaluations: usize, best: Option<End>) {
        self.of_search += evaluations as u64;
        if let Some(best) = best {
            let lower = self.found.as_ref().is_none_or(|found| best.cost < found.cost);
            if lower {
                self.found = Some(best);
            }
        }
    }
}
