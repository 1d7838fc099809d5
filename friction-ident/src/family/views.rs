//! The model's error in restarted windows, next to that of the force.

use missing_physics::Recording;
use missing_physics::report::{NamedError, SplitError};
use missing_physics::statistics::split::Split;

use crate::axis::{Axis, Quantity};
use crate::model::Model;
use crate::windows::{Window, WindowErrors, WindowOptions, window_errors};

/// Length of a window, s; velocity weakening makes longer ones unstable even for the true model.
const LENGTH: f64 = 0.1;
/// Fewest samples of a window.
const SAMPLES: f64 = 10.0;

/// Position error over windows of 0.1 s with fitted starts, on fitted and on held-out blocks;
/// `grid` holds the times of the comparison grid that `split` divides. Nothing where the recording
/// has no such windows.
pub fn views(
    model: &Model,
    recording: &Recording,
    grid: &[f64],
    split: &Split,
) -> Option<NamedError> {
    let length = LENGTH.max(SAMPLES * recording.interval());
    let errors = window_errors(model, recording, &WindowOptions::new(length)).ok()?;
    let (fit, validation) = parted(errors.windows, recording.time(), (grid, split));
    let rms = |windows: Vec<Window>| WindowErrors { length, windows }.robust_rms();
    let error = SplitError { fit: rms(fit), validation: rms(validation) };
    Some(named(model.axis(), error))
}

fn named(axis: Axis, error: SplitError) -> NamedError {
    NamedError::absolute("window", axis.unit(Quantity::Length), error)
}

/// Windows on fitted and on held-out blocks, each where its middle lies; those between blocks are in neither. `grid` holds
/// the times that `split` divides.
pub(super) fn parted(
    windows: Vec<Window>,
    time: &[f64],
    (grid, split): (&[f64], &Split),
) -> (Vec<Window>, Vec<Window>) {
    let (mut fit, mut validation) = (Vec::new(), Vec::new());
    for window in windows {
        let middle = time[usize::midpoint(window.samples.start, window.samples.end)];
        match held_out(middle, grid, split) {
            Some(true) => validation.push(window),
            Some(false) => fit.push(window),
            None => {}
        }
    }
    (fit, validation)
}

/// Whether the block around an instant is held out; nothing between blocks.
pub(super) fn held_out(time: f64, grid: &[f64], split: &Split) -> Option<bool> {
    split
        .blocks()
        .find(|(range, _)| {
            !range.is_empty() && (grid[range.start]..=grid[range.end - 1]).contains(&time)
        })
        .map(|(_, out)| out)
}
