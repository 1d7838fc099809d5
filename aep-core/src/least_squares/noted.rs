//! A problem whose residuals are kept until they are told.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use super::LeastSquares;
use crate::{Batch, Domain, Problem, Scalar};

/// A problem evaluated by its residuals, which are noted: an evaluator hands on costs only, in pieces and on threads as it
/// likes.
pub(crate) struct Noted<'a, T: Scalar> {
    problem: &'a dyn Problem<T>,
    squares: &'a dyn LeastSquares,
    /// By the bits of the position.
    residuals: Mutex<HashMap<Vec<u64>, Vec<f64>>>,
}

fn key<T: Scalar>(x: &[T]) -> Vec<u64> {
    x.iter().map(|x| x.as_f64().to_bits()).collect()
}

impl<'a, T: Scalar> Noted<'a, T> {
    pub fn new(problem: &'a dyn Problem<T>, squares: &'a dyn LeastSquares) -> Self {
        Self { problem, squares, residuals: Mutex::default() }
    }

    /// The residuals of each position; an empty row where its evaluation failed.
    pub fn of(self, points: Batch<'_, T>) -> Vec<Vec<f64>> {
        let residuals = self.residuals.into_inner().unwrap_or_else(PoisonError::into_inner);
        points.rows().map(|x| residuals.get(&key(x)).cloned().unwrap_or_default()).collect()
    }
}

impl<T: Scalar> Problem<T> for Noted<'_, T> {
    fn domain(&self) -> &Domain<T> {
        self.problem.domain()
    }

    fn evaluate(&self, x: &[T]) -> T {
        let mut cost = [T::nan()];
        self.evaluate_batch(Batch::new(x.len(), x), &mut cost);
        cost[0]
    }

    fn evaluate_batch(&self, points: Batch<'_, T>, costs: &mut [T]) {
        let numbers: Vec<f64> = points.as_slice().iter().map(|x| x.as_f64()).collect();
        let found = self.squares.residuals_batch(Batch::new(points.dimension(), &numbers));
        let mut noted = self.residuals.lock().unwrap_or_else(PoisonError::into_inner);
        for ((x, residuals), cost) in points.rows().zip(found).zip(costs) {
            *cost = T::of(self.squares.cost(&residuals));
            noted.insert(key(x), residuals);
        }
    }

    fn around(&self) -> Option<&dyn Problem<T>> {
        Some(self.problem)
    }
}
