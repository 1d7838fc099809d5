//! Mutated inputs for every way in: files of measurements, their mapping, model files, effects, formulas, checkpoints.
//!
//! A [`Campaign`] takes the seeds of a [`Target`], mutates them, and keeps as further seeds those whose outcome was not seen before:
//! what an error says, without its numbers, tells how far an input came. A panic, a hang or memory beyond [`Limits`] is a
//! [`Finding`]; its input goes into `corpus/`, where the tests replay it from then on.
//!
//! ```sh
//! cargo run --profile dev -p fuzz -- --minutes 30          # with overflow checks; all targets one after the other
//! cargo run --profile dev -p fuzz -- csv mat --minutes 5
//! ```

mod campaign;
mod corpus;
mod mutate;
mod targets;

pub use campaign::{Campaign, Cause, Ended, Finding, Limits, hushed};
pub use corpus::{corpus, kept, read};
pub use mutate::mutated;
pub use targets::{ALL, Target, find};

/// Counts the bytes in use, so that an input that asks for too many is seen.
#[global_allocator]
static MEMORY: peak_alloc::PeakAlloc = peak_alloc::PeakAlloc;
