//! Control with friction compensation: references, the sampled loop, the paper's compensator, what
//! engineers measure of a loop, its robustness, and the compensator as C.
//!
//! ```
//! use friction_ident::control::{Course, Servo, Settings, compare};
//! use friction_ident::paper;
//!
//! let table = paper::table()?;
//! let reference = Course::Ramp { speed: 1e-3 }.sampled(5e-3, 2.0);
//! let servo = Servo::for_mass(table.mass(), 5e-3);
//! let both = compare(&table, &table, &reference, &servo, Settings::new(5e-3, 6e-4))?;
//! assert!(both.compensated.measures.rms_error < 0.1 * both.pd.measures.rms_error);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compensator;
mod contact;
mod course;
mod delay;
pub mod export;
mod measures;
mod memory;
pub mod paper;
mod response;
mod robustness;
mod state;
mod trial;

pub use compensator::{Compensated, Compensator, CompensatorError, LeftOut, Settings};
pub use course::{Course, from_positions};
pub use delay::Delay;
pub use measures::{LimitCycle, Measures, STANDSTILL_COUNTS};
pub use response::LinearLoop;
pub use robustness::{Behaviour, Deviation, robustness};
pub use state::MotionState;
pub use trial::{Comparison, ControlError, Servo, Trial, compare, run, samples};
