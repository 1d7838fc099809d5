//! What ends a search early.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// What ends a search early: the best so far is taken. By default nothing does.
#[derive(Clone, Copy, Debug, Default)]
pub struct Until<'a> {
    /// A flag that is set from outside.
    pub stop: Option<&'a AtomicBool>,
    /// The end of its time.
    pub at: Option<Instant>,
}

impl<'a> Until<'a> {
    /// Until `flag` is set.
    pub fn stopped(flag: &'a AtomicBool) -> Self {
        Self { stop: Some(flag), at: None }
    }

    /// Time that is left; nothing where there is no limit.
    pub fn left(self) -> Option<Duration> {
        self.at.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// Whether nothing new is to begin.
    pub fn is_over(self) -> bool {
        self.stop.is_some_and(|flag| flag.load(Ordering::Relaxed))
            || self.left().is_some_and(|left| left.is_zero())
    }
}
