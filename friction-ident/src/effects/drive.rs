//! Drives: what happens to the commanded force on its way to the mass.

use super::{Parameters, Past};

/// What happens to the commanded force on its way to the mass.
pub trait Drive: Sync + Send {
    /// State variables per lane.
    fn states(&self) -> usize {
        0
    }

    /// State of one lane after a long time at constant `command`.
    fn start(&self, _p: &[f64], _command: f64, _state: &mut [f64]) {}

    /// Longest time, s, over which it must remember its command; `past` then holds the integral of
    /// the command over time.
    fn memory(&self, _p: Parameters<'_>) -> f64 {
        0.0
    }

    /// Advances over a step; replaces `force`, the mean command, by the mean of what comes out.
    fn advance(&self, p: Parameters<'_>, step: &Advance<'_>, state: &mut [f64], force: &mut [f64]);

    /// Replaces `force`, one contiguous piece sampled at `time`, by the command that yields it.
    fn invert(&self, p: &[f64], time: &[f64], force: &mut [f64]);

    /// Adds to `force` what never arrives of the `command` that was recorded, sample by sample.
    fn withhold(&self, _p: &[f64], _command: &[f64], _force: &mut [f64]) {}
}

/// A step as a [`Drive`] sees it.
#[derive(Clone, Copy, Debug)]
pub struct Advance<'a> {
    /// Length of the step, s.
    pub duration: &'a [f64],
    /// Time at its end, s.
    pub end: &'a [f64],
    /// Integral of the command over time up to `end`, where [`Drive::memory`] asks for it.
    pub past: &'a Past,
}
