//! Whole segments of a recording, all candidates in lockstep: under the recorded command, or under the
//! command of a controller that follows the recorded reference.

use std::ops::Range;

use missing_physics::Recording;

use super::IdentifyError;
use crate::closed_loop::{Controller, Pd, Sample, quantise};
use crate::model::Model;
use crate::signal::derivative;
use crate::simulator::{Plants, Start};
use crate::windows::{Data, WindowOptions};

/// Lanes of one batch: enough to hide the calls, few enough for the first-level cache.
const LANES: usize = 96;

/// A controller and what it follows.
#[derive(Clone)]
struct Loop<'a> {
    controller: Pd,
    /// Resolution of the encoder that it sees, m or rad; 0 for none.
    resolution: f64,
    reference: &'a [f64],
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl<'a> Loop<'a> {
    fn new(
        recording: &'a Recording,
        controller: Pd,
        resolution: f64,
    ) -> Result<Self, IdentifyError> {
        let (time, reference) = (recording.time(), recording.require("reference")?);
        let (mut velocity, mut acceleration) = (Vec::new(), Vec::new());
        for segment in recording.segments() {
            let time = &time[segment.clone()];
            let speed = derivative(time, &reference[segment.clone()]);
            acceleration.extend(derivative(time, &speed));
            velocity.extend(speed);
        }
        Ok(Self { controller, resolution, reference, velocity, acceleration })
    }

    fn sample(&self, k: usize, time: f64, position: f64) -> Sample {
        Sample {
            time,
            reference: self.reference[k],
            reference_velocity: self.velocity[k],
            reference_acceleration: self.acceleration[k],
            position: quantise(position, self.resolution),
        }
    }
}

/// Runs of one recording from its first samples.
#[derive(Clone)]
pub(super) struct FreeRun<'a> {
    data: Data<'a>,
    model: Model,
    starts: Vec<Start>,
    /// None where the recorded command acts.
    under_control: Option<Loop<'a>>,
    /// Longest segment.
    longest: usize,
    /// Mean square of the motion about its mean, m^2 or rad^2.
    pub scale: f64,
    /// Noise of the position, m or rad.
    pub noise: f64,
}

impl<'a> FreeRun<'a> {
    pub fn new(
        model: &Model,
        recording: &'a Recording,
        max_step: f64,
    ) -> Result<Self, IdentifyError> {
        let options = WindowOptions { max_step, ..WindowOptions::new(1.0) };
        let data = Data::new(recording, &options)?;
        let starts = (0..data.segments.len()).map(|s| start(&data, s)).collect();
        let longest = data.segments.iter().map(Range::len).max().unwrap_or(0);
        let (scale, noise) = (mean_square(&data), data.noise);
        Ok(Self { data, model: model.clone(), starts, under_control: None, longest, scale, noise })
    }

    /// The same with the command of `controller`, which follows the recorded reference.
    pub fn under(
        mut self,
        recording: &'a Recording,
        controller: Pd,
        resolution: f64,
    ) -> Result<Self, IdentifyError> {
        self.under_control = Some(Loop::new(recording, controller, resolution)?);
        Ok(self)
    }

    /// Mean sampling time, s.
    pub fn sample_time(&self) -> f64 {
        self.data.sample_time()
    }

    /// The same with `times` as many steps.
    pub fn finer(&self, times: usize) -> Self {
        let mut finer = self.clone();
        finer.data.steps *= times;
        finer
    }

    /// Candidates that go into one batch.
    pub fn together(&self) -> usize {
        (LANES / self.data.segments.len()).max(1)
    }

    /// Mean square error of each candidate over that of the motion.
    pub fn costs(&self, candidates: &[Vec<f64>], costs: &mut [f64]) {
        for (candidates, costs) in
            candidates.chunks(self.together()).zip(costs.chunks_mut(self.together()))
        {
            costs.fill(0.0);
            let mut samples = 0usize;
            self.run(candidates, |_, errors| {
                for (cost, error) in costs.iter_mut().zip(errors) {
                    *cost += error * error;
                }
                samples += 1;
            });
            for cost in costs {
                *cost /= samples.max(1) as f64 * self.scale;
            }
        }
    }

    /// Errors at every sample for each candidate.
    pub fn residuals(&self, candidates: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut all = Vec::with_capacity(candidates.len());
        for candidates in candidates.chunks(self.together()) {
            let mut errors = vec![vec![0.0; self.data.time.len()]; candidates.len()];
            self.run(candidates, |sample, now| {
                for (errors, error) in errors.iter_mut().zip(now) {
                    errors[sample] = *error;
                }
            });
            all.append(&mut errors);
        }
        all
    }

    /// Simulates candidates and hands over their errors sample by sample, segment by segment at
    /// each time.
    fn run(&self, candidates: &[Vec<f64>], mut each: impl FnMut(usize, &[f64])) {
        let (count, segments) = (candidates.len(), self.data.segments);
        let lanes = count * segments.len();
        let mut plants = Plants::uniform(&self.model, lanes);
        for s in 0..segments.len() {
            for (c, values) in candidates.iter().enumerate() {
                plants.set_values(s * count + c, values);
            }
        }
        plants.keep_pasts();
        for (s, start) in self.starts.iter().enumerate() {
            (0..count).for_each(|c| plants.start(s * count + c, start));
        }
        let (mut duration, mut command) = (vec![0.0; lanes], vec![0.0; lanes]);
        let mut errors = vec![0.0; count];
        let mut controllers: Vec<Pd> = match &self.under_control {
            Some(control) => vec![control.controller; lanes],
            None => Vec::new(),
        };
        let mut held = vec![0.0; controllers.len()];
        for k in 0..self.longest {
            let shown = plants.shown();
            for (s, segment) in segments.iter().enumerate().filter(|(_, s)| k < s.len()) {
                let measured = self.data.position[segment.start + k];
                let simulated = &shown[s * count..(s + 1) * count];
                errors.iter_mut().zip(simulated).for_each(|(e, x)| *e = measured - x);
                each(segment.start + k, &errors);
            }
            if let Some(control) = &self.under_control {
                for (s, segment) in segments.iter().enumerate().filter(|(_, s)| k < s.len()) {
                    let sample = segment.start + k;
                    for i in s * count..(s + 1) * count {
                        let (time, x) = (self.data.time[sample], shown[i]);
                        held[i] = controllers[i].command(&control.sample(sample, time, x));
                    }
                }
            }
            for step in 0..self.data.steps {
                for (s, segment) in segments.iter().enumerate() {
                    let (length, force) = self.data.step(segment, k, step);
                    duration[s * count..(s + 1) * count].fill(length);
                    command[s * count..(s + 1) * count].fill(force);
                }
                let acting = if held.is_empty() { &command } else { &held };
                plants.step(&duration, acting);
            }
        }
    }
}

/// Start of a segment: at rest where the first samples do not move.
fn start(data: &Data<'_>, segment: usize) -> Start {
    let first = data.segments[segment].start;
    let (position, velocity) = data.guess(segment, first);
    let stands = data.stands(segment);
    let start =
        if stands { Start::at(data.position[first], 0.0) } else { Start::at(position, velocity) };
    Start { time: data.time[first], command: data.force[first], ..start }
}

fn mean_square(data: &Data<'_>) -> f64 {
    let mut sum = 0.0;
    for segment in data.segments {
        let x = &data.position[segment.clone()];
        let mean = x.iter().sum::<f64>() / x.len() as f64;
        sum += x.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    }
    (sum / data.position.len() as f64).max(data.noise * data.noise).max(f64::MIN_POSITIVE)
}
