//! Evaluators: where and on how many threads a generation is evaluated.

use std::any::Any;
use std::cell::Cell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::sync::Once;

use serde::{Deserialize, Serialize};

use crate::{Batch, Problem, Scalar};

/// Evaluations that gave no usable cost. Each counts in one of the three.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failures {
    /// Costs that were NaN or infinite.
    pub non_finite: u64,
    /// Evaluations that ended in an error ([`Problem::errors`]).
    pub errors: u64,
    /// Evaluations that panicked.
    pub panics: u64,
    /// What the first panic or error said.
    pub first_message: Option<String>,
}

impl Failures {
    /// All failures.
    pub fn total(&self) -> u64 {
        self.non_finite.saturating_add(self.errors).saturating_add(self.panics)
    }

    /// Adds the failures of another part of the run; the earlier message stays.
    pub fn add(&mut self, other: Self) {
        self.non_finite = self.non_finite.saturating_add(other.non_finite);
        self.errors = self.errors.saturating_add(other.errors);
        self.panics = self.panics.saturating_add(other.panics);
        self.first_message = self.first_message.take().or(other.first_message);
    }
}

/// Evaluates a generation. A cost depends on its position only, so every evaluator gives the same
/// costs; an evaluator of one's own can send the positions to other machines.
pub trait Evaluator<T: Scalar = f64>: Send + Sync {
    /// Writes the cost of each position; worst cost (infinity) where there is none.
    fn evaluate(&self, problem: &dyn Problem<T>, points: Batch<'_, T>, costs: &mut [T])
    -> Failures;
}

/// One position after the other on the calling thread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Serial;

impl<T: Scalar> Evaluator<T> for Serial {
    fn evaluate(
        &self,
        problem: &dyn Problem<T>,
        points: Batch<'_, T>,
        costs: &mut [T],
    ) -> Failures {
        evaluate_caught(problem, points, costs)
    }
}

thread_local! {
    /// Whether this thread is inside an evaluation whose panic is caught.
    static CATCHING: Cell<bool> = const { Cell::new(false) };
}

/// Keeps panics that an evaluator catches off the standard error stream; all others are reported
/// as before. Acts on the whole process, hence never done unasked: call it once in `main`.
pub fn silence_caught_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !CATCHING.get() {
                previous(info);
            }
        }));
    });
}

/// What code of others gives that may panic; its panics are those that [`silence_caught_panics`] keeps quiet.
///
/// # Errors
/// The panic.
pub fn caught<R>(code: impl FnOnce() -> R) -> std::thread::Result<R> {
    let outer = CATCHING.replace(true);
    let result = catch_unwind(AssertUnwindSafe(code));
    CATCHING.set(outer);
    result
}

/// Evaluates as one batch. If that panics, the positions without a cost are evaluated one by one,
/// so that a single bad position does not cost its neighbours.
pub(crate) fn evaluate_caught<T: Scalar>(
    problem: &dyn Problem<T>,
    points: Batch<'_, T>,
    costs: &mut [T],
) -> Failures {
    let mut failures = Failures::default();
    costs.fill(T::nan());
    let whole = caught(|| problem.evaluate_batch(points, costs));
    if whole.is_err() {
        for (x, cost) in points.rows().zip(costs.iter_mut()).filter(|(_, cost)| cost.is_nan()) {
            match caught(|| problem.evaluate(x)) {
                Ok(value) => *cost = value,
                Err(panic) => {
                    failures.panics += 1;
                    failures.first_message.get_or_insert_with(|| panic_message(&*panic));
                }
            }
        }
    }
    for cost in costs.iter_mut().filter(|cost| !cost.is_finite()) {
        *cost = T::infinity();
        failures.non_finite += 1;
    }
    failures.non_finite -= failures.panics;
    failures
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(ToString::to_string);
    text.or_else(|| panic.downcast_ref::<String>().cloned())
        .unwrap_or_else(|| "panic without a message".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, FnProblem};

    fn evaluate(evaluator: &dyn Evaluator) -> (Vec<f64>, Failures) {
        let domain = Domain::cube(1, -10.0, 10.0).unwrap();
        let problem = FnProblem::new(domain, |x: &[f64]| match x[0] {
            0.0 => f64::NAN,
            1.0 => f64::NEG_INFINITY,
            2.0 => panic!("two is out of stock"),
            other => other,
        });
        let data = [0.0, 1.0, 2.0, 3.0, 4.0];
        let mut costs = [0.0; 5];
        let failures = evaluator.evaluate(&problem, Batch::new(1, &data), &mut costs);
        (costs.to_vec(), failures)
    }

    #[test]
    fn every_failure_is_worst_and_counted_once() {
        let infinite = f64::INFINITY;
        let evaluators: &[&dyn Evaluator] = &[
            &Serial,
            #[cfg(feature = "parallel")]
            &crate::Parallel::new(),
        ];
        for evaluator in evaluators {
            let (costs, failures) = evaluate(*evaluator);
            assert_eq!(costs, [infinite, infinite, infinite, 3.0, 4.0]);
            assert_eq!((failures.non_finite, failures.panics), (2, 1));
            assert_eq!(failures.first_message.as_deref(), Some("two is out of stock"));
        }
    }
}
