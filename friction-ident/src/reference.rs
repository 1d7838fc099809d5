//! Reference motions: moves, sines and ramps strung together, with a limit on the jerk.

/// A sampled reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Time between samples, s.
    pub sample_time: f64,
    /// Position at each sample, m or rad.
    pub position: Vec<f64>,
    /// Velocity at each sample.
    pub velocity: Vec<f64>,
    /// Acceleration at each sample.
    pub acceleration: Vec<f64>,
}

/// Most samples of a reference.
pub(crate) const MOST_SAMPLES: f64 = 1e7;
/// Longest smoothing of a short motion, samples.
const LONGEST_WINDOW: usize = 100_000;

/// Builds a [`Reference`] piece by piece; every piece begins and ends at rest. A piece without an end, or one that makes
/// more than 10^7 samples, is left out.
#[derive(Clone, Debug)]
pub struct Profile {
    sample_time: f64,
    velocity: Vec<f64>,
}

impl Profile {
    /// An empty profile, sampled every `sample_time` s.
    pub fn new(sample_time: f64) -> Self {
        Self { sample_time, velocity: Vec::new() }
    }

    /// Stands still for `duration` s.
    #[must_use]
    pub fn dwell(self, duration: f64) -> Self {
        self.piece(duration, |_| 0.0)
    }

    /// Moves by `distance` (signed) at `speed` with `acceleration` (both positive); a short way is
    /// a triangle that does not reach the speed.
    #[must_use]
    pub fn travel(self, distance: f64, speed: f64, acceleration: f64) -> Self {
        let way = distance.abs();
        let top = speed.min((way * acceleration).sqrt());
        let ramp = top / acceleration;
        let duration = if top > 0.0 { way / top + ramp } else { 0.0 };
        self.piece(duration, |t| {
            (acceleration * t).min(acceleration * (duration - t)).clamp(0.0, top)
                * distance.signum()
        })
    }

    /// Forth and back by `distance`.
    #[must_use]
    pub fn round_trip(self, distance: f64, speed: f64, acceleration: f64) -> Self {
        self.travel(distance, speed, acceleration).travel(-distance, speed, acceleration)
    }

    /// `x = amplitude (1 - cos(2 pi f t))` for `cycles` whole cycles.
    #[must_use]
    pub fn reciprocate(self, amplitude: f64, frequency: f64, cycles: f64) -> Self {
        let w = std::f64::consts::TAU * frequency;
        self.piece(cycles / frequency, |t| amplitude * w * (w * t).sin())
    }

    /// Velocity up to `speed`, down through zero to `-speed` and back to rest, at constant
    /// acceleration.
    #[must_use]
    pub fn velocity_triangle(self, speed: f64, duration: f64) -> Self {
        self.piece(duration, |t| {
            let u = 4.0 * t / duration;
            speed
                * if u < 1.0 {
                    u
                } else if u < 3.0 {
                    2.0 - u
                } else {
                    u - 4.0
                }
        })
    }

    fn piece(mut self, duration: f64, velocity: impl Fn(f64) -> f64) -> Self {
        let samples = (duration / self.sample_time).round();
        if samples.is_nan() || self.velocity.len() as f64 + samples > MOST_SAMPLES {
            return self;
        }
        let samples = samples as usize;
        let middle = |k: usize| (k as f64 + 0.5) * self.sample_time;
        self.velocity.extend((0..samples).map(|k| velocity(middle(k))));
        self
    }

    /// Samples from `start`; accelerations are spread over `smoothing` s, which limits the jerk.
    pub fn build(self, start: f64, smoothing: f64) -> Reference {
        let window = (smoothing / self.sample_time).round().max(1.0) as usize;
        // Over more than all of the motion there is nothing left to smooth.
        let window = window.min((2 * self.velocity.len()).max(LONGEST_WINDOW));
        let step = self.sample_time;
        // Rest at both ends takes up what the smoothing spreads beyond them.
        let rest = vec![0.0; window / 2 + 1];
        let velocity = moving_average(&[&rest[..], &self.velocity, &rest].concat(), window);
        let mut position = Vec::with_capacity(velocity.len());
        let mut x = start;
        for v in &velocity {
            position.push(x);
            x += v * step;
        }
        let last = velocity.len().saturating_sub(1);
        let change = |k: usize| (velocity[(k + 1).min(last)] - velocity[k.saturating_sub(1)]) / 2.0;
        let acceleration = (0..velocity.len()).map(|k| change(k) / step).collect();
        Reference { sample_time: step, position, velocity, acceleration }
    }
}

/// Centred, with zeros beyond both ends.
fn moving_average(values: &[f64], window: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(values.len() + 1);
    sums.push(0.0);
    for value in values {
        sums.push(sums.last().copied().unwrap_or(0.0) + value);
    }
    let (back, ahead) = (window / 2, window - window / 2);
    (0..values.len())
        .map(|k| {
            (sums[(k + ahead).min(values.len())] - sums[k.saturating_sub(back)]) / window as f64
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_trip_comes_back_and_keeps_its_limits() {
        let profile = Profile::new(1e-3).dwell(0.05).round_trip(0.1, 0.2, 2.0).dwell(0.05);
        let reference = profile.build(0.3, 0.02);
        let last = *reference.position.last().unwrap();
        assert!((last - 0.3).abs() < 1e-9);
        let top = reference.position.iter().copied().fold(0.0, f64::max);
        assert!((top - 0.4).abs() < 1e-4, "{top}");
        assert!(reference.velocity.iter().all(|v| v.abs() <= 0.2 + 1e-12));
        assert!(reference.acceleration.iter().all(|a| a.abs() <= 2.0 + 1e-9));
    }

    #[test]
    fn a_short_way_does_not_reach_the_speed() {
        let reference = Profile::new(1e-3).travel(-0.01, 1.0, 1.0).build(0.0, 0.0);
        let lowest = reference.velocity.iter().copied().fold(0.0, f64::min);
        assert!((lowest + 0.1).abs() < 1e-3, "{lowest}");
    }

    #[test]
    fn a_sine_and_a_triangle_return_to_where_they_began() {
        let profile = Profile::new(1e-3).reciprocate(1e-3, 5.0, 2.0).velocity_triangle(0.02, 1.0);
        let reference = profile.dwell(0.05).build(0.0, 0.01);
        assert!(reference.position.last().unwrap().abs() < 1e-9);
        let top = reference.position[..400].iter().copied().fold(0.0, f64::max);
        assert!((top - 2e-3).abs() < 1e-4, "{top}");
    }
}
