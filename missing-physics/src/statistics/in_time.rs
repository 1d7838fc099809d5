//! What a residual does along time by itself: a step at some moment, a sine of some period.
//!
//! Any slow function of time is explained by bins along time, shifted or not, so that the test of the
//! other coordinates says nothing here. A disturbance that keeps its phase or its side over the whole
//! recording is told from noise by placebos whose blocks of time are in random order.

use std::f64::consts::TAU;

use crate::statistics::basis::dot;

/// Number of trial frequencies, half a line width apart.
const FREQUENCIES: usize = 160;
/// A step is looked for in the middle part of the recording: this share is left out at either end.
const ENDS: f64 = 0.05;

/// A structure along time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Structure {
    /// The residual changes its level at this time, s, by this much.
    Step {
        /// When, s.
        time: f64,
        /// Level after minus level before.
        height: f64,
    },
    /// The residual swings with this period, s, and amplitude.
    Sine {
        /// Period, s.
        period: f64,
        /// Amplitude.
        amplitude: f64,
    },
}

/// Trial sines for one grid of times.
pub struct Trials {
    time: Vec<f64>,
    /// Period, cosine and sine, both of unit length.
    sines: Vec<(f64, Vec<f64>, Vec<f64>)>,
}

impl Trials {
    /// Trials for increasing times, s.
    pub fn new(time: &[f64]) -> Self {
        let span = time[time.len() - 1] - time[0];
        let sines = (2..FREQUENCIES + 2)
            .map(|k| {
                let frequency = k as f64 / (2.0 * span);
                let wave = |phase: fn(f64) -> f64| -> Vec<f64> {
                    let raw: Vec<f64> =
                        time.iter().map(|t| phase(TAU * frequency * (t - time[0]))).collect();
                    let length = dot(&raw, &raw).sqrt().max(f64::MIN_POSITIVE);
                    raw.iter().map(|value| value / length).collect()
                };
                (1.0 / frequency, wave(f64::cos), wave(f64::sin))
            })
            .collect();
        Self { time: time.to_vec(), sines }
    }

    /// The structure that explains most of `values`, with the share of their square (about the mean).
    pub fn best(&self, values: &[f64]) -> (f64, Structure) {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let total = dot(&centred, &centred).max(f64::MIN_POSITIVE);
        let step = self.best_step(&centred, total);
        let sine = self.best_sine(&centred, total);
        if step.0 > sine.0 { step } else { sine }
    }

    fn best_step(&self, centred: &[f64], total: f64) -> (f64, Structure) {
        let n = centred.len();
        let ends = ((n as f64 * ENDS) as usize).max(1);
        let mut best = (0.0, Structure::Step { time: self.time[0], height: 0.0 });
        let mut sum: f64 = centred[..ends].iter().sum();
        for (k, value) in centred.iter().enumerate().take(n - ends).skip(ends) {
            let (before, after) = (k as f64, (n - k) as f64);
            // The values sum to zero: before is minus after.
            let share = sum * sum * (1.0 / before + 1.0 / after) / total;
            if share > best.0 {
                let height = -sum / after - sum / before;
                best = (share, Structure::Step { time: self.time[k], height });
            }
            sum += value;
        }
        best
    }

    fn best_sine(&self, centred: &[f64], total: f64) -> (f64, Structure) {
        let mut best = (0.0, Structure::Sine { period: 0.0, amplitude: 0.0 });
        for (period, cosine, sine) in &self.sines {
            let square = dot(cosine, centred).powi(2) + dot(sine, centred).powi(2);
            if square / total > best.0 {
                let amplitude = (2.0 * square / centred.len() as f64).sqrt();
                best = (square / total, Structure::Sine { period: *period, amplitude });
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_and_a_sine_are_found_with_time_and_period() {
        let time: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
        let trials = Trials::new(&time);
        let step: Vec<f64> = time.iter().map(|t| if *t < 4.0 { 1.0 } else { 3.0 }).collect();
        let (share, found) = trials.best(&step);
        assert!(share > 0.99);
        assert!(
            matches!(found, Structure::Step { time, height } if (time - 4.0).abs() < 0.02 && (height - 2.0).abs() < 1e-6)
        );
        let sine: Vec<f64> = time.iter().map(|t| 0.5 * (TAU * t / 1.25 + 0.3).sin()).collect();
        let (share, found) = trials.best(&sine);
        assert!(share > 0.99);
        assert!(
            matches!(found, Structure::Sine { period, amplitude } if (period - 1.25).abs() < 0.02 && (amplitude - 0.5).abs() < 0.01)
        );
    }
}
