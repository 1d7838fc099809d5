//! A problem whose best is known.

use aep_core::Problem;

use crate::TestProblem;
use crate::tasks::Identification;

/// A problem whose best is known: a test function or an identification task.
pub trait Known: Problem {
    /// Its name.
    fn name(&self) -> &'static str;

    /// The smallest cost that is known, without noise.
    fn smallest(&self) -> f64;

    /// The cost at which a run counts as successful.
    fn target(&self) -> f64;

    /// Whether its costs are subject to chance.
    fn is_noisy(&self) -> bool;
}

impl Known for TestProblem {
    fn name(&self) -> &'static str {
        self.definition().name
    }

    fn smallest(&self) -> f64 {
        self.optimal_cost()
    }

    fn target(&self) -> f64 {
        self.target()
    }

    fn is_noisy(&self) -> bool {
        self.is_noisy()
    }
}

impl Known for Identification {
    fn name(&self) -> &'static str {
        self.task().name
    }

    fn smallest(&self) -> f64 {
        self.task().best.cost
    }

    fn target(&self) -> f64 {
        self.target()
    }

    fn is_noisy(&self) -> bool {
        self.is_noisy()
    }
}
