//! The best position that an algorithm was told.

use serde::{Deserialize, Serialize};

use crate::{Best, Scalar};

/// The best of all costs told so far, and where it was; part of every algorithm's state.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct BestSoFar<T: Scalar> {
    /// In problem coordinates; meaningless while the cost is infinite.
    position: Vec<T>,
    cost: T,
}

impl<T: Scalar> BestSoFar<T> {
    pub fn new(dimension: usize) -> Self {
        Self { position: vec![T::zero(); dimension], cost: T::infinity() }
    }

    pub fn dimension(&self) -> usize {
        self.position.len()
    }

    pub fn get(&self) -> Option<Best<'_, T>> {
        self.cost.is_finite().then(|| Best { position: &self.position, cost: self.cost })
    }

    /// Takes the first of the smallest finite `costs` if it is lower; `position` writes where the
    /// cost of that index was, in problem coordinates.
    pub fn note(&mut self, costs: &[T], position: impl FnOnce(usize, &mut [T])) {
        let mut lowest = None;
        for (i, cost) in costs.iter().enumerate() {
            if *cost < self.cost && cost.is_finite() {
                self.cost = *cost;
                lowest = Some(i);
            }
        }
        if let Some(i) = lowest {
            position(i, &mut self.position);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_equal_costs_stays_and_what_is_not_finite_never_counts() {
        let mut best = BestSoFar::new(1);
        let mut tell = |costs: &[f64], from: f64| {
            best.note(costs, |i, x| x[0] = from + i as f64);
            best.get().map(|best| (best.position[0], best.cost))
        };
        assert_eq!(tell(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY], 0.0), None);
        assert_eq!(tell(&[5.0, 3.0, 3.0, f64::NAN], 10.0), Some((11.0, 3.0)));
        assert_eq!(tell(&[3.0, 4.0], 20.0), Some((11.0, 3.0)));
    }
}
