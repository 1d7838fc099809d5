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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;

    /// `x = (t - 2 s)^2` over 0.1 s twice, from 0 and from 0.3 m: what 6 N do to 3 kg.
    fn pulled() -> Recording {
        let time: Vec<f64> = (0..202).map(|k| 2.0 + f64::from(k % 101) * 1e-3).collect();
        let run = |k: usize| k / 101;
        let place = |(k, t): (usize, &f64)| 0.3 * run(k) as f64 + (t - 2.0).powi(2);
        let position = time.iter().enumerate().map(place).collect();
        let channels = vec![
            Channel::new("force", "N", vec![6.0; time.len()]),
            Channel::new("position", "m", position),
        ];
        let segment = (0..time.len()).map(|k| run(k) as i64).collect();
        Recording::with_segments("pulled", time, channels, segment).unwrap()
    }

    #[test]
    fn each_segment_begins_where_it_was_measured_and_drifts_as_its_first_velocity_is_off() {
        let run = free_run(&Model::new(Axis::Linear, 3.0).unwrap(), &pulled()).unwrap();
        let [x, v] = ["position", "velocity"].map(|name| run.channel(name).unwrap().values.clone());
        let measured = run.channel("measured_position").unwrap().values.clone();
        // The mean velocity of the first five intervals is that of the middle of them.
        for first in [0, 101] {
            assert_eq!(x[first].to_bits(), measured[first].to_bits());
            assert!((v[first] - 5e-3).abs() < 1e-12, "{}", v[first]);
            let drifted = x[first + 100] - measured[first + 100];
            assert!((drifted - 5e-3 * 0.1).abs() < 1e-9, "{drifted}");
        }
        // It grows in proportion to time: 0.5 mm at the end, 0.5 mm times the rms of k / 100 over the samples.
        let rms =
            5e-4 * ((0..=100).map(|k| (f64::from(k) / 100.0).powi(2)).sum::<f64>() / 101.0).sqrt();
        let told = deviation(&run).unwrap();
        assert!((told / rms - 1.0).abs() < 1e-6, "{told} {rms}");
    }

    #[test]
    fn a_segment_of_three_samples_begins_with_the_mean_velocity_of_all_of_it() {
        let long = pulled();
        let segment = (0..long.len()).map(|k| i64::from(k >= 3) + i64::from(k >= 101)).collect();
        let (time, channels) = (long.time().to_vec(), long.channels().to_vec());
        let short = Recording::with_segments("short", time, channels, segment).unwrap();
        let run = free_run(&Model::new(Axis::Linear, 3.0).unwrap(), &short).unwrap();
        let v = run.channel("velocity").unwrap().values[0];
        assert!((v - 2e-3).abs() < 1e-12, "{v}");
    }

    #[test]
    fn a_recording_that_is_no_free_run_has_no_deviation() {
        assert!(deviation(&pulled()).is_err());
    }
}
