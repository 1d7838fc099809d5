//! What a small disturbance does to the prediction errors, without a simulation.
//!
//! To first order a force beside the model drives the linear error dynamics of the observer: a mass with damping
//! that is corrected by the gain; where the axis rests, friction takes the force. That is exact enough to
//! choose among hundreds of periods of a ripple, at a hundredth of the cost.

use std::f64::consts::TAU;
use std::ops::Range;

use rayon::prelude::*;

use super::Predictor;
use super::gain::Motion;

/// Samples on either side over which an axis must have moved not to be at rest.
const AROUND: usize = 4;
/// Standard deviations of the position by which it must have.
const MOVED: f64 = 4.0;

/// Where a periodic disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wave {
    /// A force on the mass.
    Force,
    /// An error of what the sensor shows.
    Sensor,
    /// A force on the mass that repeats over time, not along the stroke.
    ForceOverTime,
}

impl Predictor {
    /// Changes of the prediction errors by `sin(2 pi x/period)` and `cos(2 pi x/period)`, or of time in the place of
    /// `x`, of 1 N (N m) against the motion or of 1 m (rad), for each period.
    pub fn responses(&self, setting: usize, wave: Wave, periods: &[f64]) -> Vec<[Vec<f32>; 2]> {
        let moving = self.moving();
        let motion: Vec<Motion> = (0..self.time.len())
            .map(|k| Motion::over(self.time[k] - self.time[k.saturating_sub(1)], self.plant))
            .collect();
        let one = |period: &f64| self.response(setting, wave, TAU / period, &moving, &motion);
        periods.par_iter().map(one).collect()
    }

    fn response(
        &self,
        setting: usize,
        wave: Wave,
        wavenumber: f64,
        moving: &[bool],
        motion: &[Motion],
    ) -> [Vec<f32>; 2] {
        let gain = self.gain(setting);
        let mut errors = [0, 1].map(|_| Vec::with_capacity(self.counted.len()));
        let mut counted = self.counted.iter().copied().peekable();
        for segment in &self.segments {
            let (mut x, mut v) = ([0.0; 2], [0.0; 2]);
            for k in segment.start + 1..segment.end {
                let counts = counted.next_if_eq(&k).is_some();
                let along = if wave == Wave::ForceOverTime { &self.time } else { &self.position };
                let (before, now) = (along[k - 1], along[k]);
                let (force, shown) = match wave {
                    Wave::Force | Wave::ForceOverTime if moving[k] => {
                        let (sin, cos) = (wavenumber * 0.5 * (before + now)).sin_cos();
                        ([-sin, -cos], [0.0; 2])
                    }
                    Wave::Force | Wave::ForceOverTime => ([0.0; 2], [0.0; 2]),
                    Wave::Sensor => {
                        let (sin, cos) = (wavenumber * now).sin_cos();
                        ([0.0; 2], [sin, cos])
                    }
                };
                let m = &motion[k];
                for j in 0..2 {
                    if moving[k] {
                        x[j] += m.way * v[j] + m.moved * force[j];
                        v[j] = m.decay * v[j] + m.gained * force[j];
                    } else {
                        v[j] = 0.0;
                    }
                    let error = -(x[j] + shown[j]);
                    x[j] += gain.position[k] * error;
                    v[j] += gain.velocity[k] * error;
                    if counts {
                        errors[j].push((error * gain.relative[k]) as f32);
                    }
                }
            }
        }
        errors
    }

    /// Whether the axis moves, at each sample that counts.
    pub fn counted_and_moving(&self) -> Vec<bool> {
        let moving = self.moving();
        self.counted.iter().map(|k| moving[*k]).collect()
    }

    /// Whether the axis moves in the interval before a sample.
    fn moving(&self) -> Vec<bool> {
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
fn around(segment: &Range<usize>, k: usize) -> (usize, usize) {
    (k.saturating_sub(AROUND).max(segment.start), (k + AROUND).min(segment.end - 1))
}
