//! A model under the recorded force, from the measured position on.

use std::ops::Range;

use missing_physics::{Channel, Recording, RecordingError};

use super::{Input, SimulationError, Start, Trajectory, simulate};
use crate::model::Model;

/// Samples whose mean velocity a run starts with, so that counts of the encoder do not matter much.
const FIRST: usize = 5;

/// The motion of a model under the recorded force: channels `force`, `position`, `velocity`, and `measured_position` beside
/// them. Each segment starts at the measured position. The run drifts away from the measurement like an integral of the
/// force error, also for a good model.
///
/// # Errors
/// The recording has no force or no position, or the simulation runs away.
pub fn free_run(model: &Model, measured: &Recording) -> Result<Recording, SimulationError> {
    let mut motion =
        Trajectory { position: Vec::new(), velocity: Vec::new(), drive_force: Vec::new() };
    let mut segment = vec![0; measured.len()];
    for (number, range) in measured.segments().iter().enumerate() {
        let part = of_segment(model, measured, range)?;
        motion.position.extend(part.position);
        motion.velocity.extend(part.velocity);
        segment[range.clone()].fill(number as i64);
    }
    let unit = measured.channel("position").map(|channel| channel.unit.clone()).unwrap_or_default();
    let force = measured.channel("force").cloned();
    let mut channels: Vec<Channel> = force.into_iter().collect();
    channels.push(Channel::new("position", unit.clone(), motion.position));
    channels.push(Channel::new("velocity", format!("{unit}/s"), motion.velocity));
    let position = measured.require("position")?.to_vec();
    channels.push(Channel::new("measured_position", unit, position));
    let time = measured.time().to_vec();
    Ok(Recording::with_segments("simulated", time, channels, segment)?.with_hold(measured.hold()))
}

/// Distance of the simulated from the measured position of a [`free_run`], rms, in the unit of the position.
///
/// # Errors
/// A recording that is none of a free run.
pub fn deviation(run: &Recording) -> Result<f64, RecordingError> {
    let (simulated, measured) = (run.require("position")?, run.require("measured_position")?);
    let squares: f64 = measured.iter().zip(simulated).map(|(a, b)| (a - b).powi(2)).sum();
    Ok((squares / measured.len() as f64).sqrt())
}

fn of_segment(
    model: &Model,
    recording: &Recording,
    range: &Range<usize>,
) -> Result<Trajectory, SimulationError> {
    let time = &recording.time()[range.clone()];
    let force = &recording.require("force")?[range.clone()];
    let position = &recording.require("position")?[range.clone()];
    let last = (time.len() - 1).min(FIRST);
    let elapsed = time[last] - time[0];
    let velocity = if elapsed > 0.0 { (position[last] - position[0]) / elapsed } else { 0.0 };
    let start = Start { position: position[0], velocity, command: force[0], ..Start::default() };
    simulate(model, &Input::new(time, force, recording.hold()), &start)
}
