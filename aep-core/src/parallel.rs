//! Many threads, by rayon: the only file that a build without the feature `parallel` leaves out.

use rayon::prelude::*;

use crate::evaluate::evaluate_caught;
use crate::{Batch, Evaluator, Failures, Problem, Scalar};

/// In pieces of [`Problem::batch_size`] on a pool of threads.
#[derive(Debug)]
pub struct Parallel {
    pool: Option<rayon::ThreadPool>,
}

impl Parallel {
    /// On rayon's global pool: as many threads as there are cores.
    pub fn new() -> Self {
        Self { pool: None }
    }

    /// On a pool of its own with `threads` threads; 0 takes as many as there are cores.
    ///
    /// # Errors
    /// When the system gives no threads.
    pub fn with_threads(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        Ok(Self { pool: Some(pool) })
    }
}

impl Default for Parallel {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Scalar> Evaluator<T> for Parallel {
    fn evaluate(
        &self,
        problem: &dyn Problem<T>,
        points: Batch<'_, T>,
        costs: &mut [T],
    ) -> Failures {
        let size = problem.batch_size().max(1);
        let mut work = || {
            let pieces = costs.par_chunks_mut(size).enumerate();
            let failures: Vec<Failures> = pieces
                .map(|(piece, costs)| {
                    let from = piece * size;
                    evaluate_caught(problem, points.slice(from, from + costs.len()), costs)
                })
                .collect();
            failures.into_iter().fold(Failures::default(), |mut sum, part| {
                sum.add(part);
                sum
            })
        };
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}
