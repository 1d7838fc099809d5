//! A generic evolutionary optimizer: Problem, Individual, Mutation, Selection, and the algorithms
//! composed of them.
//!
//! ```
//! use aep_core::{Aep, Budget, Domain, FnProblem, minimize};
//!
//! // A task is a domain and a cost.
//! let domain = Domain::new(vec![-6.0, -6.0], vec![6.0, 6.0])?;
//! let valley = FnProblem::new(domain, |x: &[f64]| {
//!     100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2)
//! });
//! // A method, a budget, a seed: the same seed gives the same result to the bit.
//! let outcome = minimize(&valley, &Aep::practical(), Budget::evaluations(10_000), 1)?;
//!
//! assert!(outcome.cost < 1e-6);
//! println!("{} at {:?}: {}", outcome.cost, outcome.position, outcome.stop);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A tour
//!
//! **The task.** A [`Problem`] has a [`Domain`] and a cost to be minimised; a closure becomes one by
//! [`FnProblem`], one that can fail by [`FallibleProblem`]. A component of the domain can be
//! logarithmic, so that the search covers its decades evenly. A simulator that takes many positions
//! at once overrides [`Problem::evaluate_batch`]. Constraints are put around a problem by
//! [`Constrained`], whole numbers by [`Integers`]. A cost that is a sum of squares is a [`LeastSquares`]
//! task: searched like any other, then taken to the bottom of its valley by [`polish`].
//!
//! **The method.** What to run is a [`Method`]; [`methods`] has all by name.
//!
//! | method | for |
//! |---|---|
//! | [`Aep::practical`] | real tasks: any smallest cost, parameters that differ in magnitude |
//! | [`Lineages`] | costs that take time: few evaluations, on one minimum or on many |
//! | [`Aep::paper`] | the paper's rules, for costs whose smallest value is 0 |
//! | [`Restarting`] | any of them again and again where runs get stuck in local minima |
//! | [`MetaEp::paper`], [`MetaEp::practical`] | the paper's yardstick |
//! | [`De`] | yardstick: differential evolution, strong on separable and multimodal costs |
//! | [`CmaEs`] | yardstick: covariance matrix adaptation, strong on ill-conditioned costs |
//!
//! **The run.** [`minimize`] is the short way. A [`Driver`] owns the loop: a [`Budget`] of
//! evaluations, generations, time, target and stagnation; an [`Evaluator`] on one thread
//! ([`Serial`]) or many ([`Parallel`]); [`Observer`]s, of which [`Trace`] writes CSV or JSON lines;
//! a stop flag; checkpoints. It answers with an [`Outcome`], whose [`StopReason`] is a value.
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//! use aep_core::{Aep, Budget, Domain, Driver, FnProblem, Method, Problem, Progress, Start};
//!
//! let domain = Domain::cube(4, -5.0, 5.0)?;
//! let slow = FnProblem::new(domain, |x: &[f64]| 3.0 + x.iter().map(|x| x * x).sum::<f64>());
//! let ctrl_c = AtomicBool::new(false);
//! let folder = tempfile::tempdir()?;
//! let checkpoint = folder.path().join("run.ckpt");
//!
//! let start = Start::new(slow.domain(), 1);
//! let budget = Budget::evaluations(8_000).with_stagnation(50, 1e-12);
//! let driver = Driver::new(budget);
//! # #[cfg(feature = "parallel")]
//! let driver = driver.in_parallel();
//! let mut driver = driver
//!     .with_stop_flag(&ctrl_c)
//!     .with_checkpoint(&checkpoint, 10)
//!     .with_observer(|p: &Progress| println!("{} {}", p.generation, p.best_cost()));
//! let outcome = driver.run(&mut *Aep::practical().start(&start)?, &slow)?;
//!
//! // A run that was killed goes on from its last checkpoint and ends as if nothing had happened.
//! let again = driver.resume(&mut *Aep::practical().start(&start)?, &slow, &checkpoint)?;
//! assert_eq!(outcome.position, again.position);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **Elsewhere.** Who evaluates on a cluster or on a test bench asks and tells: see [`Algorithm`], and [`SteadyState`]
//! for one position at a time, where nobody waits for who is slow.
//!
//! **Failures.** A cost that is NaN or infinite, an evaluation that ends in an error or panics: each
//! is the worst cost, each is counted in [`Failures`], and the run goes on. (A program built with
//! `panic = "abort"` cannot go on.)
//!
//! **Comparing.** [`trials`] runs methods many times from the same initial populations: mean, median
//! and quartile curves, success rate, expected running time, rank test with effect size.
//!
//! **One's own algorithm.** An [`Engine`] joins an [`Individual`] (what is remembered), a
//! [`Mutation`] (how a child is made) and a [`Selection`] (who survives). The examples
//! `own_mutation` and `own_selection` have about 30 lines each.
//!
//! # Features
//!
//! `parallel` (default): evaluations and trials on many threads, by rayon. Without it there is no
//! [`Parallel`], trials run one after the other, and all results are the same to the bit.
//!
//! # What holds always
//!
//! - **The same seed gives the same bits** on one thread, on many, and across a resumption: every
//!   random number comes from a stream named by (seed, purpose, generation, individual), see
//!   [`random`]. (A [`SteadyState`] depends on the order in which its costs come, too.) Across platforms the last bits of exp and ln may differ, and with them the run.
//! - **No input panics.** Errors say what is wrong, where, and what mends it; what fits into no memory is one, too
//!   ([`ConfigError::TooLarge`]). Only an index beyond the end of [`Points`] or of a [`Batch`] panics, as that of a slice does.
//! - **Nothing is silently on.** Each deviation from the paper's rules is a named setting.
//! - **Only what was asked is evaluated**: a budget of evaluations is never exceeded, except that
//!   the initial population is always evaluated.

mod aep;
mod algorithm;
mod best;
mod border;
mod budget;
pub mod checkpoint;
mod cma_es;
mod constrained;
mod cube;
mod de;
mod domain;
mod driver;
mod engine;
mod error;
mod evaluate;
mod integers;
mod least_squares;
mod lineages;
mod meta_ep;
pub mod methods;
mod mutation;
mod observe;
#[cfg(feature = "parallel")]
mod parallel;
mod points;
mod population;
mod problem;
pub mod random;
mod restart;
mod run;
mod scalar;
mod selection;
mod steady_state;
mod trace;
pub mod trials;
mod turn;
mod wide;

pub use aep::{
    Aep, AepIndividual, AepMutation, AgeLimit, Components, Division, Spread, StepScale, StepUnit,
};
pub use algorithm::{Algorithm, Best, Method, Start, StartedSteadyState};
pub use border::Border;
pub use budget::{Budget, Stagnation, StopReason};
pub use checkpoint::CheckpointError;
pub use cma_es::{CmaEs, Restarts};
pub use constrained::Constrained;
pub use de::{Control, De, Factors};
pub use domain::{Domain, Scale};
pub use driver::{Driver, Outcome, RunError, minimize};
pub use engine::Engine;
pub use error::{ConfigError, TellError};
pub use evaluate::{Evaluator, Failures, Serial, caught, silence_caught_panics};
pub use integers::{Integers, Whole};
pub use least_squares::{
    FnResiduals, LeastSquares, LevenbergMarquardt, Refined, SumOfSquares, least_squares, polish,
};
pub use lineages::{Ingredient, Lineages};
pub use meta_ep::{
    CommonRate, LearningRate, MetaEp, MetaEpMutation, SigmaUnit, StepSizes, UpdateOrder,
};
pub use mutation::{Child, Mutation};
pub use observe::{Observer, Progress};
#[cfg(feature = "parallel")]
pub use parallel::Parallel;
pub use points::{Batch, Points};
pub use population::{Individual, Population};
pub use problem::{Errors, FallibleProblem, FnProblem, Problem};
pub use random::{Purpose, Stream, Streams};
pub use restart::Restarting;
pub use scalar::Scalar;
pub use selection::{OneToOne, Selection, Ties, Tournament};
pub use steady_state::SteadyState;
pub use trace::{Trace, TraceFormat};

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
