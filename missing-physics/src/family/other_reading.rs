//! The other way to read a recording.

use super::model_family::ModelFamily;

/// A recording read in another way than the one that its simplest model prefers.
#[derive(Clone, Copy)]
pub struct OtherReading<'a> {
    /// The family of that reading.
    pub family: &'a dyn ModelFamily,
    /// By how many nats the simplest model prefers the first one.
    pub nats: f64,
    /// Whether that is so much that only a model with effects may say otherwise.
    pub decided: bool,
}
