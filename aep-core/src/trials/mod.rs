//! Many runs of several methods, and what they tell.
//!
//! Trial t of every method starts from the same initial population (the same seed, the same
//! domain, the same population size), so that a difference between methods is not one of luck at
//! the start.
//!
//! ```
//! use aep_core::trials::{Plan, rank_test};
//! use aep_core::{Aep, Budget, Domain, FnProblem, MetaEp, Method};
//!
//! let domain = Domain::cube(2, -6.0, 6.0)?;
//! let bowl = FnProblem::new(domain, |x: &[f64]| x[0].powi(2) + 10.0 * x[1].powi(2));
//! let plan = Plan::new(20, Budget::evaluations(8_000).with_target(1e-8));
//! let (aep, ep) = (plan.run(&Aep::paper(), |_| &bowl)?, plan.run(&MetaEp::paper(), |_| &bowl)?);
//!
//! let summary = aep.summary(1e-8);
//! println!("{} of {} solved, {:?}", summary.successes, summary.trials, summary.expected_running_time);
//! let test = rank_test(&aep.merits(1e-8), &ep.merits(1e-8));
//! println!("AEP ahead of EP with probability {:.2}, p = {:.1e}", test.effect, test.p_value);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod curve;
mod rank;
mod summary;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

#[cfg(feature = "parallel")]
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

pub use curve::{Curve, CurvePoint};
pub use rank::{Merit, RankTest, rank_test};
pub use summary::{Summary, quantile};

use crate::{
    Budget, Driver, Failures, Method, Problem, Progress, Purpose, RunError, Scalar, Start,
    StopReason, Streams,
};

/// How often and how long each method runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Number of trials of each method.
    pub trials: usize,
    /// What each trial may use.
    pub budget: Budget,
    /// Fixes all trials: trial t of every method gets the t-th seed derived from it.
    pub seed: u64,
}

impl Plan {
    /// `trials` trials within `budget` each, with seed 1.
    pub fn new(trials: usize, budget: Budget) -> Self {
        Self { trials, budget, seed: 1 }
    }

    /// The same from another seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Seed of a trial.
    pub fn trial_seed(&self, trial: usize) -> u64 {
        Streams::new(self.seed, Purpose::Trial, 0).word(trial)
    }

    /// All trials of `method`, spread over rayon's threads (feature `parallel`; the results
    /// are the same without it). `problem` makes the problem of a trial:
    /// `|_| &problem` for one and the same.
    ///
    /// # Errors
    /// When a setting of `method` is outside its range.
    pub fn run<T: Scalar, P: Problem<T>>(
        &self,
        method: &dyn Method<T>,
        problem: impl Fn(usize) -> P + Sync,
    ) -> Result<Trials, RunError> {
        self.run_watched(method, problem, &AtomicBool::new(false), &|| {})
    }

    /// The same until `stop` is set, for example by Ctrl-C: what is returned are the trials that had
    /// ended by then. `ended` is called after each of them, from any thread.
    ///
    /// # Errors
    /// As [`Plan::run`].
    pub fn run_watched<T: Scalar, P: Problem<T>>(
        &self,
        method: &dyn Method<T>,
        problem: impl Fn(usize) -> P + Sync,
        stop: &AtomicBool,
        ended: &(dyn Fn() + Sync),
    ) -> Result<Trials, RunError> {
        let one = |trial| self.one_of_them(trial, method, &problem(trial), stop, ended);
        #[cfg(feature = "parallel")]
        let numbers = (0..self.trials).into_par_iter();
        #[cfg(not(feature = "parallel"))]
        let numbers = 0..self.trials;
        let trials: Result<Vec<Option<Trial>>, RunError> = numbers.map(one).collect();
        Ok(Trials { method: method.name(), trials: trials?.into_iter().flatten().collect() })
    }

    /// The same on the calling thread, one trial after the other: for problems that share something between evaluations, or
    /// that spread each generation themselves. The results are those of [`Plan::run_watched`].
    ///
    /// # Errors
    /// As [`Plan::run`].
    pub fn run_in_turn<T: Scalar, P: Problem<T>>(
        &self,
        method: &dyn Method<T>,
        problem: impl Fn(usize) -> P,
        stop: &AtomicBool,
        ended: &dyn Fn(),
    ) -> Result<Trials, RunError> {
        let one = |trial| self.one_of_them(trial, method, &problem(trial), stop, ended);
        let trials: Result<Vec<Option<Trial>>, RunError> = (0..self.trials).map(one).collect();
        Ok(Trials { method: method.name(), trials: trials?.into_iter().flatten().collect() })
    }

    /// A trial that was not interrupted.
    fn one_of_them<T: Scalar>(
        &self,
        trial: usize,
        method: &dyn Method<T>,
        problem: &dyn Problem<T>,
        stop: &AtomicBool,
        ended: &dyn Fn(),
    ) -> Result<Option<Trial>, RunError> {
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let run = self.trial(method, problem, self.trial_seed(trial), stop)?;
        let whole = run.stop != StopReason::Interrupted;
        if whole {
            ended();
        }
        Ok(whole.then_some(run))
    }

    fn trial<T: Scalar>(
        &self,
        method: &dyn Method<T>,
        problem: &dyn Problem<T>,
        seed: u64,
        stop: &AtomicBool,
    ) -> Result<Trial, RunError> {
        let mut algorithm = method.start(&Start::new(problem.domain(), seed))?;
        let mut improvements: Vec<(u64, f64)> = Vec::new();
        let outcome = Driver::new(self.budget.clone())
            .with_stop_flag(stop)
            .with_observer(|progress: &Progress<'_, T>| {
                let cost = progress.best_cost().as_f64();
                if improvements.last().is_none_or(|(_, best)| cost < *best) {
                    improvements.push((progress.evaluations, cost));
                }
            })
            .run(&mut *algorithm, problem)?;
        Ok(Trial {
            seed,
            cost: outcome.cost.as_f64(),
            position: outcome.position.iter().map(|x| x.as_f64()).collect(),
            evaluations: outcome.evaluations,
            generations: outcome.generations,
            elapsed: outcome.elapsed,
            stop: outcome.stop,
            failures: outcome.failures,
            improvements,
        })
    }
}

/// One run of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Seed of the run.
    pub seed: u64,
    /// Best cost.
    pub cost: f64,
    /// Best position.
    pub position: Vec<f64>,
    /// Evaluations made.
    pub evaluations: u64,
    /// Generations completed after the initial population.
    pub generations: u64,
    /// Time used.
    pub elapsed: Duration,
    /// Why the run ended.
    pub stop: StopReason,
    /// Evaluations without a usable cost.
    pub failures: Failures,
    /// (evaluations, best cost) whenever a generation improved the best cost.
    pub improvements: Vec<(u64, f64)>,
}

impl Trial {
    /// Best cost after `evaluations`; infinite before the initial population was evaluated.
    pub fn cost_after(&self, evaluations: u64) -> f64 {
        let reached = self.improvements.partition_point(|(used, _)| *used <= evaluations);
        reached.checked_sub(1).map_or(f64::INFINITY, |last| self.improvements[last].1)
    }

    /// Evaluations until a cost of `target` or less was seen (at the end of a generation).
    pub fn evaluations_to(&self, target: f64) -> Option<u64> {
        let first = self.improvements.partition_point(|(_, cost)| *cost > target);
        self.improvements.get(first).map(|(used, _)| *used)
    }
}

/// All runs of one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trials {
    /// Name of the method.
    pub method: String,
    /// Its runs, in the order of their seeds.
    pub trials: Vec<Trial>,
}
