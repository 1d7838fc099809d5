//! What a page is told of the recording.

use missing_physics::Thresholds;
use missing_physics::report::{Combinations, Explained, Samples};

/// Where the recording came from and what was asked of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// Name of the file.
    pub name: String,
    /// How each quantity was read: quantity, column in the file, unit.
    pub columns: Vec<[String; 3]>,
    /// The command that makes this page again.
    pub command: String,
    /// What an effect had to gain.
    pub thresholds: Thresholds,
    /// What parameters of the last model make together.
    pub together: Combinations,
    /// The recording and its models sample by sample, for the first screen; empty where the page has none.
    pub samples: Samples,
    /// What is known of the effects that the page names.
    pub effects: Vec<Explained>,
}
