//! What a small disturbance does to the prediction errors, without a simulation.
//!
//! To first order a force beside the model drives the linear error dynamics of the observer: a mass with damping
//! that is corrected by the gain; where the axis rests, friction takes the force. That is exact enough to
//! choose among hundreds of periods of a ripple, at a hundredth of the cost.

use std::ops::Range;

use rayon::prelude::*;

use super::Predictor;
use super::gain::{Gain, Motion};
use crate::signal::quantile;
use crate::simd::{sin_cos_of_turns, vectorised};

/// Samples on either side over which an axis must have moved not to be at rest.
const AROUND: usize = 4;
/// Standard deviations of the position by which it must have.
const MOVED: f64 = 4.0;

/// Where a periodic disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wave {
    /// A force on the mass.
    Force,
    /// A share of the command that arrives besides.
    Gain,
    /// An error of what the sensor shows.
    Sensor,
    /// A force on the mass that repeats over time, not along the stroke.
    ForceOverTime,
}

/// Periods that are looked at side by side.
const BESIDE: usize = 8;

/// What the responses to all periods have in common.
struct Way<'a> {
    wave: Wave,
    /// Position or time of the samples.
    along: &'a [f64],
    /// Force of the drive from a sample on.
    drive: &'a [f64],
    segments: &'a [Range<usize>],
    moving: &'a [bool],
    /// What the plant does between a sample and the one before.
    motion: &'a [Motion],
    /// Whether a sample counts, and how many do.
    counts: &'a [bool],
    counted: usize,
    gain: &'a Gain,
}

vectorised! {
    fn respond(way: &Way<'_>, periods: &[f64; BESIDE], out: &mut Vec<[Vec<f32>; 2]>) {
        let none = || Vec::with_capacity(way.counted);
        let mut errors: [[Vec<f32>; 2]; BESIDE] = std::array::from_fn(|_| [none(), none()]);
        let per = periods.map(|period| 1.0 / period);
        for segment in way.segments {
            // Position and velocity that the sine and the cosine have made so far.
            let (mut x, mut v) = ([[0.0; BESIDE]; 2], [[0.0; BESIDE]; 2]);
            for k in segment.start + 1..segment.end {
                let (moves, m) = (way.moving[k], &way.motion[k]);
                let acts = way.wave == Wave::Sensor || moves;
                let at = match way.wave {
                    Wave::Sensor => way.along[k],
                    Wave::Force | Wave::Gain | Wave::ForceOverTime => {
                        0.5 * (way.along[k - 1] + way.along[k])
                    }
                };
                let drive = way.drive[k - 1];
                let mut swing = [[0.0; BESIDE]; 2];
                if acts {
                    for i in 0..BESIDE {
                        let (sin, cos) = sin_cos_of_turns(at * per[i]);
                        (swing[0][i], swing[1][i]) = (sin, cos);
                    }
                }
                let (position, velocity) = (way.gain.position[k], way.gain.velocity[k]);
                let mut seen = [[0.0; BESIDE]; 2];
                for j in 0..2 {
                    for i in 0..BESIDE {
                        let (force, shown) = match way.wave {
                            Wave::Sensor => (0.0, swing[j][i]),
                            Wave::Force | Wave::ForceOverTime => (-swing[j][i], 0.0),
                            Wave::Gain => (drive * swing[j][i], 0.0),
                        };
                        if moves {
                            x[j][i] += m.way * v[j][i] + m.moved * force;
                            v[j][i] = m.decay * v[j][i] + m.gained * force;
                        } else {
                            v[j][i] = 0.0;
                        }
                        let error = -(x[j][i] + shown);
                        x[j][i] += position * error;
                        v[j][i] += velocity * error;
                        seen[j][i] = error * way.gain.relative[k];
                    }
                }
                if way.counts[k] {
                    for (i, errors) in errors.iter_mut().enumerate() {
                        errors[0].push(seen[0][i] as f32);
                        errors[1].push(seen[1][i] as f32);
                    }
                }
            }
        }
        out.extend(errors);
    }
}

impl Predictor {
    /// Changes of the prediction errors by `sin(2 pi x/period)` and `cos(2 pi x/period)`, or of time in the place of
    /// `x`, of 1 N (N m) against the motion, of all of the command or of 1 m (rad), for each period.
    pub fn responses(&self, setting: usize, wave: Wave, periods: &[f64]) -> Vec<[Vec<f32>; 2]> {
        let moving = self.moving();
        let motion: Vec<Motion> = (0..self.time.len())
            .map(|k| Motion::over(self.time[k] - self.time[k.saturating_sub(1)], self.plant))
            .collect();
        let mut counts = vec![false; self.time.len()];
        self.counted.iter().for_each(|k| counts[*k] = true);
        let way = Way {
            wave,
            along: if wave == Wave::ForceOverTime { &self.time } else { &self.position },
            drive: &self.force,
            segments: &self.segments,
            moving: &moving,
            motion: &motion,
            counts: &counts,
            counted: self.counted.len(),
            gain: self.gain(setting),
        };
        let together = |periods: &[f64]| {
            let mut beside = [1.0; BESIDE];
            beside[..periods.len()].copy_from_slice(periods);
            let mut errors = Vec::new();
            respond(&way, &beside, &mut errors);
            errors.truncate(periods.len());
            errors
        };
        periods.par_chunks(BESIDE).flat_map_iter(together).collect()
    }

    /// Whether the axis moves, at each sample that counts.
    pub fn counted_and_moving(&self) -> Vec<bool> {
        let moving = self.moving();
        self.counted.iter().map(|k| moving[*k]).collect()
    }

    /// Whether the axis is faster at each sample that counts than at half of them; where it rests for most of the time, whether
    /// it moves.
    pub fn counted_and_fast(&self) -> Vec<bool> {
        let speeds: Vec<f64> = self.counted.iter().map(|k| self.speed_around(*k)).collect();
        let median = quantile(&speeds, 0.5);
        speeds.into_iter().map(|speed| speed > median).collect()
    }

    /// Whether the axis moves in the interval before a sample.
    pub(super) fn moving(&self) -> Vec<bool> {
        let mut moving = vec![false; self.time.len()];
        for segment in &self.segments {
            for (k, moving) in moving[..segment.end].iter_mut().enumerate().skip(segment.start + 1)
            {
                let (from, to) = around(segment, k);
                let way = (self.position[to] - self.position[from]).abs();
                *moving = way > MOVED * self.noise.position;
            }
        }
        moving
    }

    /// Mean speed of the measured axis over a few samples around one.
    pub(super) fn speed_around(&self, k: usize) -> f64 {
        let Some(segment) = self.segments.get(self.piece(k)) else { return 0.0 };
        let (from, to) = around(segment, k);
        let duration = (self.time[to] - self.time[from]).max(f64::MIN_POSITIVE);
        (self.position[to] - self.position[from]).abs() / duration
    }
}

/// First and last of the samples around one, in its piece.
pub(super) fn around(segment: &Range<usize>, k: usize) -> (usize, usize) {
    (k.saturating_sub(AROUND).max(segment.start), (k + AROUND).min(segment.end - 1))
}
