//! Watching a run.

use std::time::Duration;

use crate::{Best, Failures, Outcome, Scalar};

/// Where a run stands after a generation.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a, T: Scalar = f64> {
    /// Generations completed; 0 after the initial population.
    pub generation: u64,
    /// Evaluations made.
    pub evaluations: u64,
    /// The best position so far, unless every evaluation failed.
    pub best: Option<Best<'a, T>>,
    /// Evaluations without a usable cost.
    pub failures: &'a Failures,
    /// Time used, earlier parts of a resumed run included.
    pub elapsed: Duration,
}

impl<T: Scalar> Progress<'_, T> {
    /// The best cost; infinite while every evaluation failed.
    pub fn best_cost(&self) -> T {
        self.best.map_or_else(T::infinity, |best| best.cost)
    }
}

/// Is told about every generation. Implemented for closures.
pub trait Observer<T: Scalar = f64> {
    /// A generation has been completed.
    fn generation(&mut self, progress: &Progress<'_, T>);

    /// The run has ended.
    fn finished(&mut self, _outcome: &Outcome<T>) {}
}

impl<T: Scalar, F: FnMut(&Progress<'_, T>)> Observer<T> for F {
    fn generation(&mut self, progress: &Progress<'_, T>) {
        self(progress);
    }
}
