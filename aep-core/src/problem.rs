//! The task: a domain and a cost to be minimised.

use std::sync::{Mutex, PoisonError};

use crate::{Batch, Domain, LeastSquares, Scalar};

/// A task: find the position in [`Problem::domain`] with the smallest cost.
///
/// A user's own problem is one `impl` of two methods, or a closure in [`FnProblem`]. A cost that is
/// not finite counts as the worst one possible and is reported; a panic is caught and counted.
///
/// ```
/// use aep_core::{Domain, Problem};
///
/// struct Valley {
///     domain: Domain,
/// }
///
/// impl Problem for Valley {
///     fn domain(&self) -> &Domain {
///         &self.domain
///     }
///     fn evaluate(&self, x: &[f64]) -> f64 {
///         100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2)
///     }
/// }
/// ```
pub trait Problem<T: Scalar = f64>: Sync {
    /// Where the problem is defined.
    fn domain(&self) -> &Domain<T>;

    /// The cost of one position (problem coordinates).
    fn evaluate(&self, x: &[T]) -> T;

    /// The costs of many positions: `costs[i]` belongs to `points.row(i)`.
    ///
    /// Override it where a whole generation can be evaluated faster than one position after the
    /// other (SIMD lanes, a lockstep simulator, a GPU). A cost must not depend on which other
    /// positions are in the batch: evaluators cut a generation as they like.
    fn evaluate_batch(&self, points: Batch<'_, T>, costs: &mut [T]) {
        for (x, cost) in points.rows().zip(costs) {
            *cost = self.evaluate(x);
        }
    }

    /// The problem that this one is put around: what follows is asked of it where nothing else is said here.
    fn around(&self) -> Option<&dyn Problem<T>> {
        None
    }

    /// How many positions [`Problem::evaluate_batch`] likes to get at once: parallel evaluators
    /// cut a generation into pieces of this size. 1 for a problem without batch evaluation.
    fn batch_size(&self) -> usize {
        self.around().map_or(1, Problem::batch_size)
    }

    /// Evaluations that ended in an error so far, for problems that can fail.
    fn errors(&self) -> Errors {
        self.around().map_or_else(Errors::default, Problem::errors)
    }

    /// Whether the last evaluation was broken off, for problems that can be (Ctrl-C in the middle of a generation, no worker
    /// left): its costs are then not told, and the run ends as interrupted, as it stood before that generation.
    fn is_broken_off(&self) -> bool {
        self.around().is_some_and(Problem::is_broken_off)
    }

    /// The same task by its residuals, where the cost is the sum of their squares: a method that descends by them is
    /// told them. That of a problem around which another one is put is not asked: its cost is another.
    fn as_least_squares(&self) -> Option<&dyn LeastSquares> {
        None
    }

    /// What tells this problem from others of the same domain: its name, its data, its settings. A
    /// checkpoint of a run on another problem is refused; nothing is told apart by default.
    fn identity(&self) -> String {
        self.around().map_or_else(String::new, Problem::identity)
    }
}

/// How many evaluations ended in an error, and what the first one said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Errors {
    /// Number of errors.
    pub count: u64,
    /// Message of the first one.
    pub first: Option<String>,
}

/// A closure as a problem.
///
/// ```
/// use aep_core::{Domain, FnProblem};
/// let sphere = FnProblem::new(Domain::cube(3, -6.0, 6.0)?, |x: &[f64]| x.iter().map(|v| v * v).sum());
/// # Ok::<(), aep_core::ConfigError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FnProblem<F, T: Scalar = f64> {
    domain: Domain<T>,
    cost: F,
}

impl<T: Scalar, F: Fn(&[T]) -> T + Sync> FnProblem<F, T> {
    /// The problem of minimising `cost` in `domain`.
    pub fn new(domain: Domain<T>, cost: F) -> Self {
        Self { domain, cost }
    }
}

impl<T: Scalar, F: Fn(&[T]) -> T + Sync> Problem<T> for FnProblem<F, T> {
    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn evaluate(&self, x: &[T]) -> T {
        (self.cost)(x)
    }
}

/// A closure that can fail as a problem: an error is the worst cost, counted, its first message
/// kept for the report.
#[derive(Debug)]
pub struct FallibleProblem<F, T: Scalar = f64> {
    domain: Domain<T>,
    cost: F,
    errors: Mutex<Errors>,
}

impl<T: Scalar, E: std::fmt::Display, F: Fn(&[T]) -> Result<T, E> + Sync> FallibleProblem<F, T> {
    /// The problem of minimising `cost` in `domain`.
    pub fn new(domain: Domain<T>, cost: F) -> Self {
        Self { domain, cost, errors: Mutex::default() }
    }
}

impl<T: Scalar, E: std::fmt::Display, F: Fn(&[T]) -> Result<T, E> + Sync> Problem<T>
    for FallibleProblem<F, T>
{
    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn evaluate(&self, x: &[T]) -> T {
        (self.cost)(x).unwrap_or_else(|error| {
            let mut errors = self.errors.lock().unwrap_or_else(PoisonError::into_inner);
            errors.count += 1;
            errors.first.get_or_insert_with(|| error.to_string());
            T::nan()
        })
    }

    fn errors(&self) -> Errors {
        self.errors.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl<T: Scalar, P: Problem<T> + ?Sized> Problem<T> for &P {
    fn domain(&self) -> &Domain<T> {
        (**self).domain()
    }

    fn evaluate(&self, x: &[T]) -> T {
        (**self).evaluate(x)
    }

    fn evaluate_batch(&self, points: Batch<'_, T>, costs: &mut [T]) {
        (**self).evaluate_batch(points, costs);
    }

    fn around(&self) -> Option<&dyn Problem<T>> {
        (**self).around()
    }

    fn batch_size(&self) -> usize {
        (**self).batch_size()
    }

    fn errors(&self) -> Errors {
        (**self).errors()
    }

    fn is_broken_off(&self) -> bool {
        (**self).is_broken_off()
    }

    fn as_least_squares(&self) -> Option<&dyn LeastSquares> {
        (**self).as_least_squares()
    }

    fn identity(&self) -> String {
        (**self).identity()
    }
}
