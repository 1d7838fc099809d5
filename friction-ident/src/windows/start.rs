//! A recording cut into windows, and a first guess of where the plant is at the start of each.

use std::ops::Range;

use missing_physics::{Hold, Recording};
use nalgebra::{Matrix3, Vector3};

use super::{WindowError, WindowOptions};
use crate::simulator::{Input, check_step};

/// Samples on either side of a start that its guess is taken from.
const NEIGHBOURS: usize = 12;

/// The channels of a recording that windows need.
#[derive(Clone)]
pub(crate) struct Data<'a> {
    pub time: &'a [f64],
    pub force: &'a [f64],
    pub position: &'a [f64],
    pub segments: &'a [Range<usize>],
    pub hold: Hold,
    pub options: WindowOptions,
    /// Steps per sample interval, the same everywhere.
    pub steps: usize,
    /// Noise of the position, m or rad.
    pub noise: f64,
}

impl<'a> Data<'a> {
    pub fn new(recording: &'a Recording, options: &WindowOptions) -> Result<Self, WindowError> {
        let (force, position) = (recording.require("force")?, recording.require("position")?);
        let time = recording.time();
        let longest = recording
            .segments()
            .iter()
            .flat_map(|segment| time[segment.clone()].windows(2).map(|pair| pair[1] - pair[0]))
            .fold(0.0, f64::max);
        check_step(longest * time.len() as f64, options.max_step)?;
        Ok(Self {
            time,
            force,
            position,
            segments: recording.segments(),
            hold: recording.hold(),
            options: *options,
            steps: ((longest / options.max_step - 1e-6).ceil() as usize).max(1),
            noise: noise(position, recording.segments()),
        })
    }

    /// Mean time between samples, s.
    pub fn sample_time(&self) -> f64 {
        let time: f64 =
            self.segments.iter().map(|s| self.time[s.end - 1] - self.time[s.start]).sum();
        let intervals: usize = self.segments.iter().map(|s| s.len() - 1).sum();
        time / intervals.max(1) as f64
    }

    /// The whole recording as an input.
    pub fn input(&self) -> Input<'a> {
        Input::new(self.time, self.force, self.hold)
    }

    /// Length (s) and mean command of a step after sample `k` of a piece; none behind its end.
    pub fn step(&self, piece: &Range<usize>, k: usize, step: usize) -> (f64, f64) {
        let sample = piece.start + k;
        if sample + 1 >= piece.end {
            return (0.0, self.force[piece.end - 1]);
        }
        let length = (self.time[sample + 1] - self.time[sample]) / self.steps as f64;
        (length, self.input().mean(sample, step, self.steps))
    }

    /// Whether the first samples of a segment show no motion beyond the noise.
    pub fn stands(&self, segment: usize) -> bool {
        let within = &self.segments[segment];
        let first = &self.position[within.start..within.end.min(within.start + NEIGHBOURS)];
        let (low, high) = first.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (x.min(l), x.max(h)));
        high - low <= 4.0 * self.noise
    }

    /// Windows side by side, as (segment, samples). Only whole ones.
    pub fn cut(&self) -> Vec<(usize, Range<usize>)> {
        let mut windows = Vec::new();
        for (number, segment) in self.segments.iter().enumerate() {
            let mut start = segment.start;
            for k in segment.clone() {
                // Half an interval of tolerance: rounding must not cost a sample.
                let slack = 0.5 * (self.time[k] - self.time[k.saturating_sub(1).max(start)]);
                if self.time[k] - self.time[start] + slack >= self.options.length && k > start + 3 {
                    windows.push((number, start..k + 1));
                    start = k;
                }
            }
        }
        windows
    }

    /// Position and velocity at the first sample of a window: a parabola through its neighbours.
    pub fn guess(&self, segment: usize, first: usize) -> (f64, f64) {
        let within = &self.segments[segment];
        let from = first.saturating_sub(NEIGHBOURS).max(within.start);
        let to = (first + NEIGHBOURS + 1).min(within.end);
        let (mut left, mut right) = (Matrix3::zeros(), Vector3::zeros());
        let scale = (self.time[to - 1] - self.time[from]).max(f64::MIN_POSITIVE);
        for k in from..to {
            let t = (self.time[k] - self.time[first]) / scale;
            let row = Vector3::new(1.0, t, t * t);
            left += row * row.transpose();
            right += row * (self.position[k] - self.position[first]);
        }
        match left.cholesky().map(|cholesky| cholesky.solve(&right)) {
            Some(parabola) => (self.position[first] + parabola[0], parabola[1] / scale),
            None => (self.position[first], 0.0),
        }
    }
}

/// Standard deviation of white noise on `position`, from its third differences: smooth motion has
/// next to none.
fn noise(position: &[f64], segments: &[Range<usize>]) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for w in segments.iter().flat_map(|segment| position[segment.clone()].windows(4)) {
        sum += (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).powi(2);
        count += 1;
    }
    // 1 + 9 + 9 + 1 = 20.
    (sum / (20.0 * count.max(1) as f64)).sqrt()
}
