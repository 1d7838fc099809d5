//! One plant under a recorded input.

use missing_physics::Hold;

use super::{Plants, SimulationError, Start};
use crate::model::Model;

/// Longest step, s, unless another is asked for. Sample intervals are divided to stay below.
pub const DEFAULT_MAX_STEP: f64 = 1e-3;

/// Most steps of a simulation: hours for the cheapest plant.
const MOST_STEPS: f64 = 1e11;

/// Refuses a longest step by which a simulation of `duration` s does not come to an end.
pub(crate) fn check_step(duration: f64, max_step: f64) -> Result<(), SimulationError> {
    let refused =
        |need| Err(SimulationError::Setting { name: "the longest step", value: max_step, need });
    if max_step.is_nan() || max_step <= 0.0 {
        return refused("it must be above 0 s");
    }
    if duration / max_step > MOST_STEPS {
        return refused("it would take more than 10^11 steps");
    }
    Ok(())
}

/// A recorded command.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// Times, s, increasing; the spacing may be irregular.
    pub time: &'a [f64],
    /// Command at each time, N or N m.
    pub force: &'a [f64],
    /// What the command does between two times.
    pub hold: Hold,
    /// Longest step, s.
    pub max_step: f64,
}

impl<'a> Input<'a> {
    /// An input with the default step.
    pub fn new(time: &'a [f64], force: &'a [f64], hold: Hold) -> Self {
        Self { time, force, hold, max_step: DEFAULT_MAX_STEP }
    }

    /// The same with steps of at most `max_step`, s.
    #[must_use]
    pub fn with_max_step(mut self, max_step: f64) -> Self {
        self.max_step = max_step;
        self
    }

    /// Checks lengths, times and step.
    pub(crate) fn check(&self) -> Result<(), SimulationError> {
        let (samples, values) = (self.time.len(), self.force.len());
        if samples != values {
            return Err(SimulationError::Length { samples, values });
        }
        for (k, pair) in self.time.windows(2).enumerate() {
            let (before, after) = (pair[0], pair[1]);
            if !before.is_finite() || !after.is_finite() || after <= before {
                return Err(SimulationError::Time { index: k + 1, before, after });
            }
        }
        let duration =
            self.time.last().zip(self.time.first()).map_or(0.0, |(last, first)| last - first);
        check_step(duration, self.max_step)
    }

    /// Number and length of the steps from sample `k` to the next.
    pub(crate) fn steps(&self, k: usize) -> (usize, f64) {
        let interval = self.time[k + 1] - self.time[k];
        // An interval that exceeds the longest step by rounding alone is one step.
        let steps = (interval / self.max_step - 1e-6).ceil().max(1.0);
        (steps as usize, interval / steps)
    }

    /// Mean command of step `j` of `steps` after sample `k`.
    pub(crate) fn mean(&self, k: usize, j: usize, steps: usize) -> f64 {
        match self.hold {
            Hold::ZeroOrder => self.force[k],
            Hold::Sampled => {
                let middle = (j as f64 + 0.5) / steps as f64;
                self.force[k] + middle * (self.force[k + 1] - self.force[k])
            }
        }
    }
}

/// A simulated motion, one value per time of the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// Position as the sensor shows it, m or rad.
    pub position: Vec<f64>,
    /// Velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Mean force of the drive on the mass in the step before, N or N m.
    pub drive_force: Vec<f64>,
}

/// Simulates `model` under `input` from `start`.
///
/// # Errors
/// The input does not make sense, or the state leaves the finite numbers.
pub fn simulate(
    model: &Model,
    input: &Input<'_>,
    start: &Start,
) -> Result<Trajectory, SimulationError> {
    input.check()?;
    let mut batch = Plants::new(std::slice::from_ref(model))?;
    let samples = input.time.len();
    let mut out = Trajectory {
        position: Vec::with_capacity(samples),
        velocity: Vec::with_capacity(samples),
        drive_force: Vec::with_capacity(samples),
    };
    let Some(first) = input.time.first() else { return Ok(out) };
    batch.start(0, &Start { time: *first, ..*start });
    out.push(&batch, start.command);
    for k in 0..samples - 1 {
        let (steps, duration) = input.steps(k);
        for j in 0..steps {
            batch.step(&[duration], &[input.mean(k, j, steps)]);
        }
        if !batch.is_finite(0) {
            let effect = batch.culprit(0);
            return Err(SimulationError::NotFinite { time: input.time[k + 1], effect });
        }
        out.push(&batch, batch.drive_force()[0]);
    }
    Ok(out)
}

impl Trajectory {
    fn push(&mut self, batch: &Plants, force: f64) {
        self.position.push(batch.shown()[0]);
        self.velocity.push(batch.velocity()[0]);
        self.drive_force.push(force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_longest_step_is_refused_that_is_none_or_by_which_no_simulation_ends() {
        let refused = |duration, step| check_step(duration, step).is_err();
        for step in [0.0, -1e-3, f64::NAN, f64::NEG_INFINITY] {
            assert!(refused(1.0, step), "{step}");
        }
        // 10^11 steps are the most.
        let cases = [(1.0, 0.1), (99.0, 1e-9), (1e20, 1e10), (0.0, 1e-300)];
        assert!(cases.iter().all(|(duration, step)| !refused(*duration, *step)));
        let cases = [(101.0, 1e-9), (1e-3, 1e-20), (1e20, 1e8), (f64::INFINITY, 1.0)];
        assert!(cases.iter().all(|(duration, step)| refused(*duration, *step)));
    }
}
