//! A one-axis drive made of effects: friction laws, simulator, identification, and the model family for discovery.
//!
//! A [`Model`] is a mass and a list of [`effects`]. Driven along a measured motion it says which force
//! the drive must have commanded:
//!
//! ```
//! use friction_ident::{Axis, MeasuredMotion, Model, force_along};
//!
//! let model = Model::new(Axis::Linear, 30.0)?
//!     .with("coulomb", &[("F_C", 8.0)])?
//!     .with("viscous", &[("F_v", 200.0)])?;
//! let (time, position, velocity) = ([0.0, 0.1, 0.2], [0.0, 0.01, 0.02], [0.1, 0.1, 0.1]);
//! let motion = MeasuredMotion::new(&time, &position, &velocity, &[0.0; 3])?;
//! assert_eq!(force_along(&model, &motion), [28.0; 3]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod axis;
pub mod challenge;
pub mod closed_loop;
pub mod control;
pub mod driven;
pub mod effects;
pub mod export;
pub mod family;
pub mod identify;
pub mod known;
pub mod model;
pub mod paper;
pub mod predictor;
pub mod reference;
pub mod simulator;
pub mod windows;

mod signal;
mod simd;

pub use axis::{Axis, Effort, Quantity};
pub use challenge::Challenge;
pub use closed_loop::{Controller, Pd, Setup, closed_loop};
pub use driven::{Columns, MeasuredMotion, MotionError, columns_along, force_along};
pub use effects::{Effect, Library};
pub use identify::{Free, Horizon, Identification, intervals, intervals_over};
pub use known::{Known, KnownError};
pub use model::{Model, ModelError};
pub use reference::{Profile, Reference};
pub use simulator::{Input, Plants, SimulationError, Start, Trajectory, simulate};
pub use windows::{WindowErrors, WindowOptions, window_errors};

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
