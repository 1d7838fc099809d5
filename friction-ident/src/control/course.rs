//! References as an engineer asks for them: ramp, sine, trapezoid, velocity reversal, samples.

use crate::reference::{MOST_SAMPLES, Profile, Reference};

/// A reference by its shape; SI units of the axis. All begin at position 0 and time 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// Constant velocity from the first sample on.
    Ramp {
        /// m/s or rad/s, of either sign.
        speed: f64,
    },
    /// `amplitude sin(2 pi frequency t)`.
    Sine {
        /// m or rad.
        amplitude: f64,
        /// Hz.
        frequency: f64,
    },
    /// Forth and back by `distance` with rests of a quarter of the travel's duration.
    Trapezoid {
        /// m or rad, of either sign.
        distance: f64,
        /// m/s or rad/s.
        speed: f64,
        /// m/s^2 or rad/s^2.
        acceleration: f64,
    },
    /// A velocity that jumps between `speed` and `-speed`: position is a triangle.
    Reversal {
        /// m/s or rad/s.
        speed: f64,
        /// Time between two reversals, s.
        interval: f64,
    },
}

impl Course {
    /// How long it takes to show what it is for, s.
    pub fn usual_duration(&self) -> f64 {
        match *self {
            Self::Ramp { .. } => 10.0,
            Self::Sine { frequency, .. } => 3.0 / frequency,
            Self::Trapezoid { distance, speed, acceleration } => {
                4.0 * travel_time(distance, speed, acceleration)
            }
            Self::Reversal { interval, .. } => 5.0 * interval,
        }
    }

    /// Samples every `sample_time` s over `duration` s, at most 10^7.
    pub fn sampled(&self, sample_time: f64, duration: f64) -> Reference {
        let samples = (duration / sample_time).round().clamp(0.0, MOST_SAMPLES) as usize + 1;
        if let Self::Trapezoid { distance, speed, acceleration } = *self {
            return trapezoid(distance, speed, acceleration, sample_time, samples);
        }
        let points = (0..samples).map(|k| self.at(k as f64 * sample_time));
        let (mut position, mut velocity, mut acceleration) = (vec![], vec![], vec![]);
        for (x, v, a) in points {
            position.push(x);
            velocity.push(v);
            acceleration.push(a);
        }
        Reference { sample_time, position, velocity, acceleration }
    }

    /// Position, velocity and acceleration at time `t`; a trapezoid is made of pieces.
    fn at(&self, t: f64) -> (f64, f64, f64) {
        match *self {
            Self::Ramp { speed } => (speed * t, speed, 0.0),
            Self::Sine { amplitude, frequency } => {
                let w = std::f64::consts::TAU * frequency;
                let (sin, cos) = (w * t).sin_cos();
                (amplitude * sin, amplitude * w * cos, -amplitude * w * w * sin)
            }
            Self::Reversal { speed, interval } => {
                // A sample that falls on a reversal belongs to what follows it.
                let half = (t / interval + 1e-9).floor();
                let way = t - half * interval;
                let top = speed * interval;
                if half % 2.0 == 0.0 {
                    (speed * way, speed, 0.0)
                } else {
                    (top - speed * way, -speed, 0.0)
                }
            }
            Self::Trapezoid { .. } => (0.0, 0.0, 0.0),
        }
    }
}

fn travel_time(distance: f64, speed: f64, acceleration: f64) -> f64 {
    let top = speed.min((distance.abs() * acceleration).sqrt());
    distance.abs() / top + top / acceleration
}

fn trapezoid(
    distance: f64,
    speed: f64,
    acceleration: f64,
    sample_time: f64,
    samples: usize,
) -> Reference {
    let rest = 0.25 * travel_time(distance, speed, acceleration);
    let mut profile = Profile::new(sample_time);
    let mut built = 0.0;
    // A way of less than no time never adds up to the duration.
    for _ in 0..samples {
        if built >= samples as f64 * sample_time {
            break;
        }
        for way in [distance, -distance] {
            profile = profile.dwell(rest).travel(way, speed, acceleration).dwell(rest);
        }
        built += 4.0 * rest + 2.0 * travel_time(distance, speed, acceleration);
    }
    let mut reference = profile.build(0.0, 0.0);
    reference.position.truncate(samples);
    reference.velocity.truncate(samples);
    reference.acceleration.truncate(samples);
    reference
}

/// A reference from its positions, m or rad; velocity and acceleration by differences.
pub fn from_positions(sample_time: f64, position: Vec<f64>) -> Reference {
    let last = position.len().saturating_sub(1);
    // Forward: the velocity with which the reference leaves a sample.
    let slope = |values: &[f64]| -> Vec<f64> {
        (0..values.len())
            .map(|k| {
                (values[(k + 1).min(last)] - values[k.min(last.saturating_sub(1))]) / sample_time
            })
            .collect()
    };
    let velocity = slope(&position);
    let acceleration = slope(&velocity);
    Reference { sample_time, position, velocity, acceleration }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_reversal_is_a_triangle() {
        let reference = Course::Reversal { speed: 1e-3, interval: 2.0 }.sampled(5e-3, 8.0);
        assert_eq!(reference.position.len(), 1601);
        let at = |t: f64| reference.position[(t / 5e-3).round() as usize];
        for (t, x) in [(0.0, 0.0), (1.0, 1e-3), (2.0, 2e-3), (3.0, 1e-3), (4.0, 0.0), (7.0, 1e-3)] {
            assert!((at(t) - x).abs() < 1e-12, "{t}: {}", at(t));
        }
        assert_eq!(reference.velocity[400], -1e-3);
    }

    #[test]
    fn a_trapezoid_goes_forth_and_back_within_its_limits() {
        let course = Course::Trapezoid { distance: 0.02, speed: 0.01, acceleration: 0.1 };
        let reference = course.sampled(1e-3, course.usual_duration());
        let top = reference.position.iter().fold(0.0f64, |top, x| top.max(*x));
        assert!((top - 0.02).abs() < 2e-5, "{top}");
        assert!(reference.velocity.iter().all(|v| v.abs() < 0.01 + 1e-9));
        assert!(reference.velocity.iter().any(|v| *v < -0.0099));
    }

    #[test]
    fn samples_know_their_velocity() {
        let reference = from_positions(0.1, vec![0.0, 0.1, 0.3, 0.3]);
        let exact = [1.0, 2.0, 0.0, 0.0];
        for (v, exact) in reference.velocity.iter().zip(exact) {
            assert!((v - exact).abs() < 1e-12, "{:?}", reference.velocity);
        }
        assert!(from_positions(0.1, vec![0.5]).velocity[0] == 0.0);
    }

    proptest! {
        #[test]
        fn velocity_is_the_slope_of_position(amplitude in 1e-4f64..0.1, frequency in 0.1f64..5.0) {
            let reference = Course::Sine { amplitude, frequency }.sampled(1e-3, 1.0);
            let w = std::f64::consts::TAU * frequency;
            for k in 1..reference.position.len() - 1 {
                let slope = (reference.position[k + 1] - reference.position[k - 1]) / 2e-3;
                let bound = amplitude * w * (w * 1e-3).powi(2);
                prop_assert!((reference.velocity[k] - slope).abs() < bound);
            }
        }
    }
}
