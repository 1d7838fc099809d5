//! A run in progress: what the driver counts while it loops.

use std::path::Path;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::checkpoint::{self, RunState};
use crate::least_squares::Noted;
use crate::{
    Algorithm, Budget, CheckpointError, Evaluator, Failures, Outcome, Problem, Progress, Scalar,
    StopReason, TellError,
};

/// What the driver itself remembers across a resumption.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Ledger {
    pub evaluations: u64,
    pub failures: Failures,
    pub elapsed: Duration,
    /// Best cost when progress was last seen, and the generation it was seen in.
    pub progress: (f64, u64),
}

/// The state of the loop.
pub(crate) struct Run<T> {
    pub ledger: Ledger,
    pub started: Instant,
    /// Time used before this part of the run.
    pub earlier: Duration,
    pub costs: Vec<T>,
}

impl<T: Scalar> Run<T> {
    pub fn begun(&self) -> bool {
        self.ledger.evaluations > 0
    }

    pub fn out_of_evaluations(&self, algorithm: &mut dyn Algorithm<T>, budget: &Budget) -> bool {
        let Some(most) = budget.evaluations else { return false };
        let next = algorithm.ask().len() as u64;
        self.begun() && self.ledger.evaluations.saturating_add(next) > most
    }

    /// A generation; whether it was told. One that was broken off leaves no trace.
    pub fn step(
        &mut self,
        algorithm: &mut dyn Algorithm<T>,
        problem: &dyn Problem<T>,
        evaluator: &dyn Evaluator<T>,
    ) -> Result<bool, TellError> {
        let squares = problem.as_least_squares().filter(|_| algorithm.wants_residuals());
        let noted = squares.map(|squares| Noted::new(problem, squares));
        let points = algorithm.ask();
        self.costs.resize(points.len(), T::infinity());
        let asked = noted.as_ref().map_or(problem, |noted| noted);
        let failures = evaluator.evaluate(asked, points, &mut self.costs);
        self.ledger.elapsed = self.earlier.saturating_add(self.started.elapsed());
        if problem.is_broken_off() {
            return Ok(false);
        }
        self.ledger.failures.add(failures);
        match noted {
            Some(noted) => {
                let residuals = noted.of(points);
                algorithm.tell_residuals(&self.costs, &residuals)?;
            }
            None => algorithm.tell(&self.costs)?,
        }
        self.ledger.evaluations = self.ledger.evaluations.saturating_add(self.costs.len() as u64);
        Ok(true)
    }

    /// Errors reach the evaluator as NaN; they are counted as what they are.
    pub fn count_errors(&mut self, problem: &dyn Problem<T>, at_start: u64, before: &Failures) {
        let errors = problem.errors();
        let new = before.errors.saturating_add(errors.count.saturating_sub(at_start));
        let failures = &mut self.ledger.failures;
        let more = new.saturating_sub(failures.errors);
        failures.errors += more;
        failures.non_finite = failures.non_finite.saturating_sub(more);
        failures.first_message = failures.first_message.take().or(errors.first);
    }

    pub fn stagnates(&self, generation: u64, most: u64) -> bool {
        self.begun() && generation.saturating_sub(self.ledger.progress.1) >= most
    }

    pub fn note_progress(&mut self, algorithm: &dyn Algorithm<T>, tolerance: f64) {
        let Some(best) = algorithm.best() else { return };
        let (reference, _) = self.ledger.progress;
        let cost = best.cost.as_f64();
        if reference.is_infinite() || cost < reference - tolerance * reference.abs() {
            self.ledger.progress = (cost, algorithm.generation());
        }
    }

    pub fn progress<'b>(&'b self, algorithm: &'b dyn Algorithm<T>) -> Progress<'b, T> {
        Progress {
            generation: algorithm.generation(),
            evaluations: self.ledger.evaluations,
            best: algorithm.best(),
            failures: &self.ledger.failures,
            elapsed: self.ledger.elapsed,
        }
    }

    pub fn save(
        &self,
        algorithm: &dyn Algorithm<T>,
        problem: &dyn Problem<T>,
        path: &Path,
    ) -> Result<(), CheckpointError> {
        let state = RunState {
            problem: problem.identity(),
            signature: algorithm.signature(),
            algorithm: algorithm.save()?,
            ledger: checkpoint::encode(&self.ledger)?,
        };
        checkpoint::write(path, &state)
    }

    pub fn outcome(
        self,
        algorithm: &dyn Algorithm<T>,
        stop: StopReason,
        checkpoint_error: Option<String>,
    ) -> Outcome<T> {
        let best = algorithm.best();
        Outcome {
            position: best.map_or_else(Vec::new, |best| best.position.to_vec()),
            cost: best.map_or_else(T::infinity, |best| best.cost),
            evaluations: self.ledger.evaluations,
            generations: algorithm.generation(),
            elapsed: self.ledger.elapsed,
            stop,
            failures: self.ledger.failures,
            checkpoint_error,
        }
    }
}
