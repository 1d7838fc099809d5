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
//! let outcome = minimize(&valley, &Aep::paper(), Budget::generations(2_000), 1)?;
//!
//! assert!(outcome.cost < 1e-6);
//! println!("{} at {:?}: {}", outcome.cost, outcome.position, outcome.stop);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod aep;
mod algorithm;
mod border;
mod budget;
pub mod checkpoint;
mod cma_es;
mod de;
mod domain;
mod driver;
mod engine;
mod error;
mod evaluate;
mod meta_ep;
pub mod methods;
mod mutation;
mod observe;
mod points;
mod population;
mod problem;
pub mod random;
mod scalar;
mod selection;
mod trace;
pub mod trials;

pub use aep::{
    Aep, AepIndividual, AepMutation, AgeLimit, Components, Division, Spread, StepScale, StepUnit,
};
pub use algorithm::{Algorithm, Best, Method, Start};
pub use border::Border;
pub use budget::{Budget, Stagnation, StopReason};
pub use checkpoint::CheckpointError;
pub use cma_es::{CmaEs, Restarts};
pub use de::{Control, De, Factors};
pub use domain::{Domain, Scale};
pub use driver::{Driver, Outcome, RunError, minimize};
pub use engine::Engine;
pub use error::{ConfigError, TellError};
pub use evaluate::{Evaluator, Failures, Parallel, Serial, silence_caught_panics};
pub use meta_ep::{
    CommonRate, LearningRate, MetaEp, MetaEpMutation, SigmaUnit, StepSizes, UpdateOrder,
};
pub use mutation::{Child, Mutation};
pub use observe::{Observer, Progress};
pub use points::{Batch, Points};
pub use population::{Individual, Population};
pub use problem::{Errors, FallibleProblem, FnProblem, Problem};
pub use random::{Purpose, Stream, Streams};
pub use scalar::Scalar;
pub use selection::{OneToOne, Selection, Ties, Tournament};
pub use trace::{Trace, TraceFormat};
