//! Simulation of one or many plants: implicit in the set-valued friction, second order between events.
//!
//! # The step
//! Over a step `r` the mean force decides: with the mean velocity `u = (v + v1) / 2` the momentum
//! balance is `2 m (u - v) = r (F - S - L d - c (u - v_p) - f(r u))`, where `F` is the drive's mean
//! force, `S` and `c` the smooth forces and their slope at the predicted middle (`x + r v / 2`, `v_p`),
//! `L d` the rigid friction and `f` the mean force of elastic elements, which grows with the
//! displacement. It is one equation for `u` with a left side that grows with `u`: one solution at any
//! step, without energy from nowhere.
//!
//! * Position forces enter as in the leapfrog scheme, elastic elements as in the trapezoidal rule:
//!   neither lets the energy of an oscillation grow.
//! * Rigid friction is set-valued: a lane whose velocity would change sign is taken to `v = 0`
//!   exactly, at the time where that happens, and decides there anew: it stays at rest while the
//!   applied force is within the level, and slides off otherwise, in the rest of the same step.
//! * With a pre-sliding contact the friction force is continuous and there is no event to locate.

mod correct;
mod error;
mod free_run;
mod hooks;
mod kernels;
mod plants;
mod run;
mod scratch;
mod step;

pub use error::SimulationError;
pub use free_run::{deviation, free_run};
pub use plants::{Plants, Start};
pub(crate) use run::check_step;
pub use run::{DEFAULT_MAX_STEP, Input, Trajectory, simulate};

#[cfg(test)]
mod tests;
