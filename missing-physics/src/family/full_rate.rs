//! A residual at the full rate of the recording.

use std::ops::Range;

use super::coordinate::Coordinate;

/// A residual at the full rate of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct FullRate {
    /// Sampling interval, s; uniform inside segments.
    pub interval: f64,
    /// Target minus prediction.
    pub residual: Vec<f64>,
    /// False where it says nothing (a drive at rest).
    pub used: Vec<bool>,
    /// Contiguous pieces; where the motion repeats itself, its cycles: all of a spectrum's structure
    /// that comes from the cycle then lies in single bins.
    pub pieces: Vec<Range<usize>>,
    /// Coordinates along which something may be periodic.
    pub coordinates: Vec<Coordinate>,
}
