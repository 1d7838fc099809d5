//! Identification tasks as people have them: a model with unknown parameters, a recording, a misfit.
//!
//! One file per task. A new one is a file with a [`Model`] and a [`Task`] beside the others, a line in
//! [`ALL`], and its known best from `cargo run --release -p aep-problems --example known_best -- NAME`.
//!
//! The recordings are simulated, from a fixed seed, with the noise of a sensor: recordings of real
//! machines of the same kind may not be distributed with a library. The model that is fitted is the one that
//! made the data, so that a task measures the optimizer and nothing else.
//!
//! Every prediction is in standard deviations of its sensor. The cost is the sum of squared residuals,
//! about the number of samples at best; a tolerance of 1e-3 of it is, at a thousand samples, about what
//! one standard error of one parameter costs.
//!
//! ```
//! use aep_core::{Aep, Budget, minimize};
//!
//! let task = aep_problems::tasks::find("two-decays").unwrap().problem();
//! let budget = Budget::evaluations(20_000).with_target(task.target());
//! let found = minimize(&task, &Aep::practical(), budget, 1)?;
//! assert!(found.cost <= task.target());
//! # Ok::<(), aep_core::RunError>(())
//! ```

#![expect(clippy::unreadable_literal, reason = "known bests stand as the search prints them")]

mod identification;
mod integrate;
mod task;

mod battery;
mod closed_loop;
mod cogging;
mod decays;
mod hysteresis;
mod kinetics;
mod lift;
mod rod;
mod suspension;
mod table;
mod two_mass;
mod tyre;
mod windows;

pub use identification::Identification;
pub use task::{Best, Model, Parameter, Task};

/// All tasks, in the order they are listed.
pub const ALL: &[Task] = &[
    table::TASK,
    windows::TASK,
    lift::TASK,
    two_mass::TASK,
    closed_loop::TASK,
    decays::TASK,
    kinetics::TASK,
    suspension::TASK,
    rod::TASK,
    cogging::TASK,
    battery::TASK,
    hysteresis::TASK,
    tyre::TASK,
];

/// The task called `name`.
pub fn find(name: &str) -> Option<&'static Task> {
    ALL.iter().find(|task| task.name == name)
}
