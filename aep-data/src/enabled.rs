//! Samples at which the drive is switched off.
//!
//! An open motor gives no force whatever was commanded, and does not brake by its back-EMF either: such
//! samples follow another equation than the rest and are left out.

use std::ops::Range;

use missing_physics::{Channel, Recording, RecordingError};

/// The recording without the samples where `enabled` is 0; a piece ends where some are left out.
///
/// # Errors
/// Too little is left.
pub(crate) fn switched_on(
    recording: &Recording,
    enabled: &[f64],
) -> Result<Recording, RecordingError> {
    let on = |range: &Range<usize>| -> Vec<Range<usize>> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for k in range.clone().filter(|&k| enabled[k] != 0.0) {
            match runs.last_mut() {
                Some(run) if run.end == k => run.end = k + 1,
                _ => runs.push(k..k + 1),
            }
        }
        runs
    };
    let runs: Vec<Range<usize>> = recording.segments().iter().flat_map(on).collect();
    let kept = |values: &[f64]| -> Vec<f64> {
        runs.iter().flat_map(|run| &values[run.clone()]).copied().collect()
    };
    let channels = recording.channels().iter();
    let channels = channels.map(|c| Channel::new(&c.name, &c.unit, kept(&c.values))).collect();
    let segment = (0i64..).zip(&runs).flat_map(|(number, run)| run.clone().map(move |_| number));
    let (time, segment) = (kept(recording.time()), segment.collect());
    let left = Recording::with_segments(recording.name(), time, channels, segment)?;
    Ok(left.with_hold_of(recording))
}
