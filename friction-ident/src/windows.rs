//! Restarted windows: the position error of a model over short pieces of a recording.
//!
//! Over a long free run the error drifts like an integral and ranks models wrongly; over 0.05..0.5 s
//! from a fitted start it shows what the model lacks. The start (position, velocity, and with an
//! elastic contact its utilisation) is fitted in each window by least squares: with a velocity taken
//! from the data even the true model misses by many micrometres.

use std::ops::Range;

use missing_physics::{Recording, RecordingError};
use rayon::prelude::*;

use crate::model::Model;
use crate::simulator::{DEFAULT_MAX_STEP, SimulationError};

mod fit;
mod start;

pub(crate) use fit::{Fitter, TOGETHER};
pub(crate) use start::Data;

/// How windows are cut and fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowOptions {
    /// Length of a window, s.
    pub length: f64,
    /// Gauss-Newton steps on the start.
    pub iterations: usize,
    /// Longest step of the simulation, s.
    pub max_step: f64,
}

impl WindowOptions {
    /// Windows of `length` s with the usual number of iterations.
    pub fn new(length: f64) -> Self {
        Self { length, iterations: 4, max_step: DEFAULT_MAX_STEP }
    }
}

/// Why there are no windows.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// A channel is missing.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The input or the step makes no sense.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// No segment is as long as a window.
    #[error(
        "no segment of the recording is as long as a window of {length} s\ntake shorter windows"
    )]
    TooShort {
        /// Length of a window, s.
        length: f64,
    },
}

/// One window and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Samples.
    pub samples: Range<usize>,
    /// Segment of the recording.
    pub segment: usize,
    /// Root mean square position error, m or rad; infinite where the simulation runs away.
    pub rms: f64,
    /// Fitted position at the first sample.
    pub position: f64,
    /// Fitted velocity at the first sample.
    pub velocity: f64,
}

/// Errors of all windows of one length.
#[derive(Clone, Debug, PartialEq)]
pub struct WindowErrors {
    /// Length of a window, s.
    pub length: f64,
    /// The windows in order.
    pub windows: Vec<Window>,
}

/// Errors are capped at this multiple of their segment's median before they are averaged: a window
/// in which the plant sticks or slips at the wrong moment says no more than that.
const CAP: f64 = 4.0;

impl WindowErrors {
    /// Median error of the windows, m or rad.
    pub fn median(&self) -> f64 {
        median(self.windows.iter().map(|window| window.rms).collect())
    }

    /// Root mean square of the capped errors, every segment with the same weight, m or rad.
    pub fn robust_rms(&self) -> f64 {
        let segments = self.by_segment();
        let squares: f64 = segments.iter().map(|errors| capped_mean_square(errors)).sum();
        (squares / segments.len().max(1) as f64).sqrt()
    }

    fn by_segment(&self) -> Vec<Vec<f64>> {
        let mut segments: Vec<(usize, Vec<f64>)> = Vec::new();
        for window in &self.windows {
            match segments.last_mut() {
                Some((segment, errors)) if *segment == window.segment => errors.push(window.rms),
                _ => segments.push((window.segment, vec![window.rms])),
            }
        }
        segments.into_iter().map(|(_, errors)| errors).collect()
    }
}

fn capped_mean_square(errors: &[f64]) -> f64 {
    let cap = CAP * median(errors.to_vec());
    errors.iter().map(|error| error.min(cap).powi(2)).sum::<f64>() / errors.len().max(1) as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Position errors of `model` over the windows of `recording` (channels `force` and `position`).
///
/// # Errors
/// A channel is missing, or no segment is as long as a window.
pub fn window_errors(
    model: &Model,
    recording: &Recording,
    options: &WindowOptions,
) -> Result<WindowErrors, WindowError> {
    let data = Data::new(recording, options)?;
    let cut = data.cut();
    if cut.is_empty() {
        return Err(WindowError::TooShort { length: options.length });
    }
    let windows = cut
        .par_chunks(TOGETHER)
        .map_init(|| Fitter::new(model, &data), Fitter::fit)
        .flatten_iter()
        .collect();
    Ok(WindowErrors { length: options.length, windows })
}

#[cfg(test)]
mod tests;
