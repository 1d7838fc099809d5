//! A measurement before any model: the recording, what is to be known of it, its numbers in words. Readers of files
//! need no more than this room; it imports nothing of the engine.

pub mod check;
pub mod period;
mod pieces;
pub mod quantity;
mod recording;

pub use check::{DataCheck, check, cut_at_gaps};
pub use pieces::{MOST_LOOKED_AT, in_pieces, looked_at, spread};
pub use recording::{Channel, Hold, MIN_SAMPLES, Recording, RecordingError};
