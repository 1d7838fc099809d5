//! The one loop: asks, evaluates, tells, counts, observes, saves, stops.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::checkpoint::{self, RunState};
use crate::run::{Ledger, Run};
use crate::{
    Algorithm, Budget, CheckpointError, ConfigError, Evaluator, Failures, Method, Observer,
    Problem, Scalar, Serial, Start, StopReason, TellError,
};

/// What a run found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Outcome<T: Scalar = f64> {
    /// The best position, in problem coordinates; empty when every evaluation failed.
    pub position: Vec<T>,
    /// Its cost; infinite when every evaluation failed.
    pub cost: T,
    /// Evaluations made.
    pub evaluations: u64,
    /// Generations completed after the initial population.
    pub generations: u64,
    /// Time used, earlier parts of a resumed run included.
    pub elapsed: Duration,
    /// Why the run ended.
    pub stop: StopReason,
    /// Evaluations without a usable cost.
    pub failures: Failures,
    /// What went wrong when a checkpoint was last written, if anything: the run went on.
    pub checkpoint_error: Option<String>,
}

/// Why a run could not be started or continued.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The configuration cannot work.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The algorithm and the problem have different numbers of components.
    #[error("the algorithm searches {algorithm} components, the problem has {problem}")]
    Dimension {
        /// Components of the algorithm's domain.
        algorithm: usize,
        /// Components of the problem's domain.
        problem: usize,
    },
    /// The algorithm refused the costs it had asked for.
    #[error(transparent)]
    Tell(#[from] TellError),
    /// The checkpoint to resume from is not usable.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}

/// Runs an algorithm on a problem within a budget.
///
/// ```
/// use aep_core::{Aep, Budget, Domain, Driver, FnProblem, Method, Problem, Progress, Start};
///
/// let domain = Domain::cube(3, -6.0, 6.0)?;
/// let sphere = FnProblem::new(domain, |x: &[f64]| x.iter().map(|v| v * v).sum());
/// let mut aep = Aep::paper().start(&Start::new(sphere.domain(), 1))?;
/// let mut curve = Vec::new();
/// let outcome = Driver::new(Budget::generations(300))
///     .with_observer(|p: &Progress| curve.push(p.best_cost()))
///     .run(&mut *aep, &sphere)?;
/// assert!(outcome.cost < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Driver<'a, T: Scalar = f64> {
    budget: Budget,
    evaluator: Box<dyn Evaluator<T> + 'a>,
    observers: Vec<Box<dyn Observer<T> + 'a>>,
    stop: Option<&'a AtomicBool>,
    checkpoint: Option<(PathBuf, u64)>,
}

impl<'a, T: Scalar> Driver<'a, T> {
    /// A driver that evaluates on the calling thread.
    pub fn new(budget: Budget) -> Self {
        Self {
            budget,
            evaluator: Box::new(Serial),
            observers: Vec::new(),
            stop: None,
            checkpoint: None,
        }
    }

    /// Evaluates with `evaluator`.
    #[must_use]
    pub fn with_evaluator(mut self, evaluator: impl Evaluator<T> + 'a) -> Self {
        self.evaluator = Box::new(evaluator);
        self
    }

    /// Evaluates on as many threads as there are cores (feature `parallel`).
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn in_parallel(self) -> Self {
        self.with_evaluator(crate::Parallel::new())
    }

    /// Adds an observer.
    #[must_use]
    pub fn with_observer(mut self, observer: impl Observer<T> + 'a) -> Self {
        self.observers.push(Box::new(observer));
        self
    }

    /// Ends the run after the current generation once `flag` is set, for example by Ctrl-C.
    #[must_use]
    pub fn with_stop_flag(mut self, flag: &'a AtomicBool) -> Self {
        self.stop = Some(flag);
        self
    }

    /// Writes a checkpoint to `path` every `generations` generations and at the end.
    #[must_use]
    pub fn with_checkpoint(mut self, path: impl Into<PathBuf>, generations: u64) -> Self {
        self.checkpoint = Some((path.into(), generations.max(1)));
        self
    }

    /// Runs `algorithm` on `problem` from where it stands.
    ///
    /// # Errors
    /// When the two have different numbers of components. Failed evaluations are no error: they are counted
    /// in [`Outcome::failures`], and what went wrong with a checkpoint is told in the outcome, too.
    pub fn run(
        &mut self,
        algorithm: &mut dyn Algorithm<T>,
        problem: &dyn Problem<T>,
    ) -> Result<Outcome<T>, RunError> {
        let progress = (f64::INFINITY, algorithm.generation());
        let failures = Failures::default();
        let ledger = Ledger { evaluations: 0, failures, elapsed: Duration::ZERO, progress };
        self.go_on(algorithm, problem, ledger)
    }

    /// Continues the run saved in `path`. `algorithm` must be built as for that run, and `problem`
    /// must be the same as far as [`Problem::identity`] tells; the result equals that of the
    /// uninterrupted run to the bit. Budgets count from the run's beginning.
    ///
    /// # Errors
    /// When the checkpoint cannot be read, is damaged, or is of another run or another problem.
    pub fn resume(
        &mut self,
        algorithm: &mut dyn Algorithm<T>,
        problem: &dyn Problem<T>,
        path: &Path,
    ) -> Result<Outcome<T>, RunError> {
        let saved: RunState = checkpoint::read(path)?;
        let run = problem.identity();
        if saved.problem != run {
            let checkpoint = saved.problem;
            return Err(CheckpointError::OtherProblem { checkpoint, run }.into());
        }
        let run = algorithm.signature();
        if saved.signature != run {
            return Err(CheckpointError::OtherRun { checkpoint: saved.signature, run }.into());
        }
        let ledger = checkpoint::decode(&saved.ledger)?;
        algorithm.restore(&saved.algorithm)?;
        self.go_on(algorithm, problem, ledger)
    }

    fn go_on(
        &mut self,
        algorithm: &mut dyn Algorithm<T>,
        problem: &dyn Problem<T>,
        ledger: Ledger,
    ) -> Result<Outcome<T>, RunError> {
        let dimensions = (algorithm.domain().dimension(), problem.domain().dimension());
        if dimensions.0 != dimensions.1 {
            return Err(RunError::Dimension { algorithm: dimensions.0, problem: dimensions.1 });
        }
        let errors_before = problem.errors().count;
        let before = ledger.failures.clone();
        let earlier = ledger.elapsed;
        let mut run = Run { ledger, started: Instant::now(), earlier, costs: Vec::new() };
        let mut checkpoint_error = None;
        let stop = loop {
            if let Some(stop) = self.stop_reason(algorithm, &run) {
                break stop;
            }
            if run.out_of_evaluations(algorithm, &self.budget) {
                break StopReason::Evaluations;
            }
            if !run.step(algorithm, problem, &*self.evaluator)? {
                break StopReason::Interrupted;
            }
            run.count_errors(problem, errors_before, &before);
            run.note_progress(algorithm, self.budget.stagnation.map_or(0.0, |s| s.tolerance));
            self.observe(algorithm, &run);
            if let Some(error) = self.save_when_due(algorithm, problem, &run) {
                checkpoint_error = Some(error.to_string());
            }
        };
        if let Some((path, _)) = &self.checkpoint
            && let Err(error) = run.save(algorithm, problem, path)
        {
            checkpoint_error = Some(error.to_string());
        }
        let outcome = run.outcome(algorithm, stop, checkpoint_error);
        self.observers.iter_mut().for_each(|observer| observer.finished(&outcome));
        Ok(outcome)
    }

    fn stop_reason(&self, algorithm: &dyn Algorithm<T>, run: &Run<T>) -> Option<StopReason> {
        let best = algorithm.best().map_or(f64::INFINITY, |best| best.cost.as_f64());
        let generation = algorithm.generation();
        let budget = &self.budget;
        if budget.target.is_some_and(|target| best <= target) {
            Some(StopReason::Target)
        } else if self.stop.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            Some(StopReason::Interrupted)
        } else if budget.generations.is_some_and(|most| run.begun() && generation >= most) {
            Some(StopReason::Generations)
        } else if budget.time.is_some_and(|most| run.ledger.elapsed >= most) {
            Some(StopReason::Time)
        } else if budget.stagnation.is_some_and(|s| run.stagnates(generation, s.generations)) {
            Some(StopReason::Stagnation)
        } else {
            algorithm.exhausted().map(|why| StopReason::Exhausted(why.into()))
        }
    }

    fn observe(&mut self, algorithm: &dyn Algorithm<T>, run: &Run<T>) {
        for observer in &mut self.observers {
            observer.generation(&run.progress(algorithm));
        }
    }
}

impl<T: Scalar> Driver<'_, T> {
    fn save_when_due(
        &self,
        algorithm: &dyn Algorithm<T>,
        problem: &dyn Problem<T>,
        run: &Run<T>,
    ) -> Option<CheckpointError> {
        let (path, every) = self.checkpoint.as_ref()?;
        let due = algorithm.generation().is_multiple_of(*every);
        if due { run.save(algorithm, problem, path).err() } else { None }
    }
}

/// Minimises `problem` with `method` within `budget` on the calling thread. [`Driver`] has the
/// rest: threads, observers, checkpoints, a stop flag.
///
/// ```
/// use aep_core::{Aep, Budget, Domain, FnProblem, minimize};
/// let domain = Domain::cube(2, -6.0, 6.0)?;
/// let bowl = FnProblem::new(domain, |x: &[f64]| 3.0 + x[0].powi(2) + 100.0 * x[1].powi(2));
/// let outcome = minimize(&bowl, &Aep::practical(), Budget::evaluations(20_000), 1)?;
/// assert!((outcome.cost - 3.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When a setting of `method` is outside its range.
pub fn minimize<T: Scalar>(
    problem: &dyn Problem<T>,
    method: &dyn Method<T>,
    budget: Budget,
    seed: u64,
) -> Result<Outcome<T>, RunError> {
    let mut algorithm = method.start(&Start::new(problem.domain(), seed))?;
    Driver::new(budget).run(&mut *algorithm, problem)
}
