//! A measurement before any model: the recording, what is to be known of it, its numbers in words. Readers of files
//! need no more than this room; it imports nothing of the engine.

pub mod check;
pub mod period;
pub mod quantity;
mod recording;

pub use check::{DataCheck, check, cut_at_gaps};
pub use recording::{Channel, Hold, MIN_SAMPLES, Recording, RecordingError};
