//! What is asked of a discovery.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use super::thresholds::Thresholds;
use crate::family::Fitted;

/// What is asked of a discovery.
#[derive(Clone, Debug)]
pub struct Settings<'a> {
    /// Names of the terms of the base model (those of every model need not be named).
    pub base: Vec<String>,
    /// The base model as it is known already, near which it is fitted; else it is searched for.
    pub start: Option<Fitted>,
    /// Names of terms that are not to be tried.
    pub exclude: Vec<String>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Largest p-value at which an effect holds on other recordings.
    pub alpha: f64,
    /// Most effects that are added.
    pub most: usize,
    /// Numbers that steer the search.
    pub thresholds: Thresholds,
    /// Set from outside to stop; what has been found is reported.
    pub stop: Option<&'a AtomicBool>,
    /// Time after which no new rung is begun.
    pub time_limit: Option<Duration>,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            base: Vec::new(),
            start: None,
            exclude: Vec::new(),
            seed: 1,
            alpha: 0.05,
            most: 8,
            thresholds: Thresholds::default(),
            stop: None,
            time_limit: None,
        }
    }
}
