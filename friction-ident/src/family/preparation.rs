//! From a recording to the motion and force that models are compared on.
//!
//! Position is smoothed without phase shift and differentiated; force and every regressor then pass
//! the same low-pass filter ("parallel filtering"), so that what the filter does to the one it does
//! to the other. Samples at rest say nothing of the friction level (any force below breakaway holds)
//! and are set to zero on both sides before that filter, which keeps the equation true.

use std::ops::Range;

use missing_physics::{Hold, Recording, RecordingError};

use super::filter::{Kernel, LowPass};
use crate::known::KnownError;

/// Cut-off of the position's smoother as a share of the sampling frequency.
pub(super) const SMOOTHER: f64 = 0.1;
/// A second, heavier smoother: where the two disagree, the motion is in doubt.
pub(super) const HEAVIER: f64 = 0.06;
/// Default bandwidth of the comparison as a share of the sampling frequency, where noise of the position leaves it.
const BANDWIDTH: f64 = 0.05;
/// Largest share of noise in the square of the acceleration that the default bandwidth lets pass: by as much least
/// squares underrate the mass. And the factor by which a bandwidth that lets more pass is narrowed.
const NOISE: f64 = 0.05;
const NARROWER: f64 = 1.6;
/// Grid points per period of the bandwidth.
const GRID: f64 = 2.5;
/// Most grid points; a longer recording is thinned out.
const MOST_POINTS: usize = 8000;
/// Speed below which the axis is taken to rest, in standard deviations of the velocity's noise.
const REST: f64 = 3.0;
/// The same as a share of the root mean square speed: ringing of the smoother after a stop.
const RINGING: f64 = 1e-3;
/// Time at either end of a piece, s, in which filters of others settle; at most this share of the piece.
const SETTLING: f64 = 0.3;
const SETTLING_SHARE: f64 = 0.05;
/// A grid point is used where at least this share of its neighbourhood moves.
const MOVING: f64 = 0.3;

/// Why a recording cannot be compared with a drive.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PreparationError {
    /// A channel is missing.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A parameter that is said to be known and cannot be.
    #[error(transparent)]
    Known(#[from] KnownError),
    /// A law of the user that reads a column which is not there.
    #[error(
        "effect '{effect}' reads '{column}', which is neither one of its parameters nor a column of the recording"
    )]
    Column {
        /// The effect.
        effect: String,
        /// The column.
        column: String,
    },
    /// A law of the user that has no value somewhere.
    #[error(
        "the law of effect '{effect}' is {value} at sample {sample} (t = {time:.6} s, x = {position:.6}, v = {velocity:.6})"
    )]
    Law {
        /// The effect.
        effect: String,
        /// What it is there.
        value: f64,
        /// Sample, from 1.
        sample: usize,
        /// Time, s.
        time: f64,
        /// Position, m or rad.
        position: f64,
        /// Velocity, m/s or rad/s.
        velocity: f64,
    },
    /// Too little is left to compare.
    #[error(
        "only {points} of the recording's instants can be compared, {needed} are needed: it is too \
         short, or the axis hardly moves"
    )]
    TooLittle {
        /// Usable grid points.
        points: usize,
        /// Grid points needed.
        needed: usize,
    },
    /// Samples that are too far apart.
    #[error(
        "the samples are {interval} s apart, a drive needs {SLOWEST} s or less: what friction does shows within milliseconds"
    )]
    Slow {
        /// Median interval, s.
        interval: f64,
    },
    /// The force or the position is constant.
    #[error("'{channel}' never changes: nothing can be learned from it")]
    Constant {
        /// Which channel.
        channel: &'static str,
    },
}

/// Longest sampling interval, s. Friction, gaps and couplings act within milliseconds; milliseconds that are read as seconds
/// are longer than this, and each of them would be simulated in a thousand steps.
const SLOWEST: f64 = 0.2;
/// Fewest grid points of a comparison.
const LEAST_POINTS: usize = 60;

/// Motion and force, uniformly sampled in every segment.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Sampling interval, s.
    pub interval: f64,
    /// Times, s.
    pub time: Vec<f64>,
    /// Smoothed position, m or rad.
    pub position: Vec<f64>,
    /// Velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Acceleration, m/s^2 or rad/s^2.
    pub acceleration: Vec<f64>,
    /// Force or torque at the instants of the samples, N or N m.
    pub force: Vec<f64>,
    /// Contiguous pieces.
    pub segments: Vec<Range<usize>>,
    /// 1 where the axis moves, 0 where it rests.
    pub moving: Vec<f64>,
    /// Samples of the comparison grid.
    pub grid: Vec<usize>,
    /// Samples from one point of the grid to the next.
    pub stride: usize,
    /// Bandwidth of the comparison, Hz.
    pub bandwidth: f64,
    /// Cut-off of the position's smoother, Hz.
    pub cutoff: f64,
    /// Standard deviation of what the smoother took out of the position: its noise, m or rad.
    pub position_noise: f64,
    /// Speed below which the axis is taken to rest, m/s or rad/s.
    pub rest_speed: f64,
    /// Velocity and acceleration by the heavier smoother.
    pub heavier: (Vec<f64>, Vec<f64>),
    kernel: Kernel,
}

impl Prepared {
    /// Prepares `recording`; `bandwidth` in Hz, by default 5 % of the sampling frequency or what noise of the position
    /// leaves of it.
    ///
    /// # Errors
    /// A channel is missing or constant, or too little of the recording moves.
    pub fn new(recording: &Recording, bandwidth: Option<f64>) -> Result<Self, PreparationError> {
        let force = recording.require("force")?;
        let position = recording.require("position")?;
        for (channel, values) in [("force", force), ("position", position)] {
            if values.iter().all(|value| *value == values[0]) {
                return Err(PreparationError::Constant { channel });
            }
        }
        let interval = recording.interval();
        if interval > SLOWEST {
            return Err(PreparationError::Slow { interval });
        }
        let mut raw = Raw::default();
        for range in recording.segments() {
            raw.resample(
                &recording.time()[range.clone()],
                &position[range.clone()],
                &force[range.clone()],
                interval,
                recording.hold(),
            );
        }
        let relative = bandwidth.map_or(BANDWIDTH, |hz| hz * interval).min(0.2);
        let at = |relative: f64, smoother: f64| {
            Self::from_raw(&raw, interval, (relative, smoother), recording.hold())
        };
        let prepared = at(relative, SMOOTHER.max(1.5 * relative))?;
        if bandwidth.is_some() {
            return Ok(prepared);
        }
        // Beyond the bandwidth the velocity is noise, too: of coarse counts friction would turn with it.
        let narrower = prepared.above_noise();
        let narrower =
            narrower.and_then(|relative| at(relative, SMOOTHER / BANDWIDTH * relative).ok());
        Ok(narrower.unwrap_or(prepared))
    }

    /// The widest bandwidth at which the acceleration is not noise, as a share of the sampling frequency, where this one is
    /// wider.
    fn above_noise(&self) -> Option<f64> {
        let narrower = |wider: &Self| {
            if wider.acceleration_noise() <= NOISE {
                return None;
            }
            let narrower = wider.clone().with_bandwidth(wider.bandwidth * self.interval / NARROWER);
            (narrower.grid.len() >= LEAST_POINTS).then_some(narrower)
        };
        let last = std::iter::successors(narrower(self), narrower).last()?;
        Some(last.bandwidth * self.interval)
    }

    /// Share of the square of the compared acceleration that noise of the position makes. The smoother takes out what
    /// white noise has above its cut-off; the rest, differentiated twice below f, is rms (2 pi f)^2 sqrt(2 f / 5 fs).
    fn acceleration_noise(&self) -> f64 {
        let position = self.position_noise / (1.0 - 2.0 * self.cutoff * self.interval).sqrt();
        let relative = self.bandwidth * self.interval;
        let rate = std::f64::consts::TAU * self.bandwidth;
        let noise = position * rate * rate * (2.0 * relative / 5.0).sqrt();
        (noise / rms(&self.compare(&self.acceleration)).max(f64::MIN_POSITIVE)).powi(2)
    }

    /// Time from sample to sample, s, that the bandwidth needs: what lies between them is mostly noise of the position.
    pub fn apart(&self) -> f64 {
        BANDWIDTH / self.bandwidth
    }

    fn with_bandwidth(mut self, relative: f64) -> Self {
        self.bandwidth = relative / self.interval;
        self.kernel = Kernel::new(relative);
        self.stride = self.stride_for(relative);
        self.grid = self.choose_grid(relative);
        self
    }

    fn from_raw(
        raw: &Raw,
        interval: f64,
        (relative, smoother): (f64, f64),
        hold: Hold,
    ) -> Result<Self, PreparationError> {
        let light = raw.motion(&LowPass::new(smoother), interval, hold);
        let heavy = raw.motion(&LowPass::new(smoother * HEAVIER / SMOOTHER), interval, hold);
        let residue: Vec<f64> =
            raw.position.iter().zip(&light.position).map(|(a, b)| a - b).collect();
        let position_noise = rms(&residue);
        // White noise of this size, low-passed at f and differentiated: rms 2 pi f sqrt(2 f / 3 fs).
        let cutoff = std::f64::consts::TAU * smoother / interval;
        let velocity_noise = position_noise * cutoff * (2.0 * smoother / 3.0).sqrt();
        let rest_speed = (REST * velocity_noise).max(RINGING * rms(&light.velocity));
        let moving: Vec<f64> =
            light.velocity.iter().map(|v| f64::from(u8::from(v.abs() > rest_speed))).collect();
        let prepared = Self {
            interval,
            time: raw.time.clone(),
            position: light.position,
            velocity: light.velocity,
            acceleration: light.acceleration,
            force: raw.force.clone(),
            segments: raw.segments.clone(),
            moving,
            grid: Vec::new(),
            stride: 1,
            bandwidth: relative / interval,
            cutoff: smoother / interval,
            position_noise,
            rest_speed,
            heavier: (heavy.velocity, heavy.acceleration),
            kernel: Kernel::new(relative),
        }
        .with_bandwidth(relative);
        if prepared.grid.len() < LEAST_POINTS {
            let (points, needed) = (prepared.grid.len(), LEAST_POINTS);
            return Err(PreparationError::TooLittle { points, needed });
        }
        Ok(prepared)
    }

    /// The same with what is near a rest or a reversal left out on both sides: there friction holds the axis for a
    /// moment, which smoothed positions do not show, and a force that is made of velocities knows nothing of the force
    /// that is held.
    ///
    /// # Errors
    /// Too little is left.
    pub fn without_rests(mut self) -> Result<Self, PreparationError> {
        let reach = (1.0 / (self.cutoff * self.interval)).ceil() as usize;
        let before = self.moving.clone();
        for segment in &self.segments {
            for k in segment.clone() {
                let turns = k > segment.start && self.velocity[k - 1] * self.velocity[k] <= 0.0;
                if turns || before[k] == 0.0 {
                    let from = k.saturating_sub(reach).max(segment.start);
                    self.moving[from..(k + reach + 1).min(segment.end)].fill(0.0);
                }
            }
            // What others make of positions settles at either end.
            let settling = (SETTLING / self.interval) as usize;
            let skipped = settling.min((segment.len() as f64 * SETTLING_SHARE) as usize);
            self.moving[segment.start..segment.start + skipped].fill(0.0);
            self.moving[segment.end - skipped..segment.end].fill(0.0);
        }
        self.grid = self.choose_grid(self.bandwidth * self.interval);
        if self.grid.len() < LEAST_POINTS {
            let (points, needed) = (self.grid.len(), LEAST_POINTS);
            return Err(PreparationError::TooLittle { points, needed });
        }
        Ok(self)
    }

    fn stride_for(&self, relative: f64) -> usize {
        ((1.0 / (GRID * relative)) as usize).max(self.time.len() / MOST_POINTS).max(1)
    }

    fn choose_grid(&self, relative: f64) -> Vec<usize> {
        let stride = self.stride;
        // The kernel must not reach beyond a piece.
        let edge = Kernel::reach_of(relative);
        let inner = |range: &Range<usize>| {
            (range.start + edge..range.end.saturating_sub(edge)).step_by(stride)
        };
        let moves = |k: &usize| self.kernel.at(&self.moving, *k) > MOVING;
        self.segments.iter().flat_map(inner).filter(moves).collect()
    }

    /// A signal on the comparison grid: zero where the axis rests, low-passed, thinned out.
    pub fn compare(&self, signal: &[f64]) -> Vec<f64> {
        let masked: Vec<f64> = signal.iter().zip(&self.moving).map(|(s, m)| s * m).collect();
        self.grid.iter().map(|&k| self.kernel.at(&masked, k)).collect()
    }

    /// Like [`Self::compare`], at every sample; no number where the axis rests or a piece ends.
    pub fn compare_everywhere(&self, signal: &[f64]) -> Vec<f64> {
        let masked: Vec<f64> = signal.iter().zip(&self.moving).map(|(s, m)| s * m).collect();
        let edge = Kernel::reach_of(self.bandwidth * self.interval);
        let mut compared = vec![f64::NAN; signal.len()];
        for range in &self.segments {
            let inner = range.start + edge..range.end.saturating_sub(edge);
            for k in inner.filter(|k| self.kernel.at(&self.moving, *k) > MOVING) {
                compared[k] = self.kernel.at(&masked, k);
            }
        }
        compared
    }

    /// The sample nearest to a time within a piece.
    pub fn nearest(&self, piece: usize, time: f64) -> usize {
        let Some(range) = self.segments.get(piece).filter(|range| !range.is_empty()) else {
            return 0;
        };
        let steps = ((time - self.time[range.start]) / self.interval).round().max(0.0) as usize;
        // The interval of a piece differs a little from that of all.
        let near = (range.start + steps).min(range.end - 1);
        let away = |k: usize| (self.time[k] - time).abs();
        let mut best = near;
        while best > range.start && away(best - 1) < away(best) {
            best -= 1;
        }
        while best + 1 < range.end && away(best + 1) < away(best) {
            best += 1;
        }
        best
    }

    /// Autocorrelation that the low-pass gives to white noise, at steps of the grid.
    pub fn colour(&self) -> Vec<f64> {
        self.kernel.colour(self.stride)
    }

    /// A signal on the comparison grid as it is.
    pub fn sample(&self, signal: &[f64]) -> Vec<f64> {
        self.grid.iter().map(|&k| signal[k]).collect()
    }
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// Uniformly sampled position and force.
#[derive(Default)]
struct Raw {
    time: Vec<f64>,
    position: Vec<f64>,
    force: Vec<f64>,
    segments: Vec<Range<usize>>,
}

struct Motion {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Raw {
    /// Appends a piece on a uniform grid of the median interval (linear interpolation, which leaves
    /// a uniformly sampled piece as it is but for jitter).
    fn resample(
        &mut self,
        time: &[f64],
        position: &[f64],
        force: &[f64],
        interval: f64,
        hold: Hold,
    ) {
        let (first, last) = (time[0], time[time.len() - 1]);
        let count = ((last - first) / interval).round() as usize + 1;
        let step = if count > 1 { (last - first) / (count - 1) as f64 } else { interval };
        let start = self.time.len();
        let mut before = 0;
        for k in 0..count {
            let now = first + k as f64 * step;
            while before + 2 < time.len() && time[before + 1] <= now {
                before += 1;
            }
            let after = (before + 1).min(time.len() - 1);
            let width = time[after] - time[before];
            let part =
                if width > 0.0 { ((now - time[before]) / width).clamp(0.0, 1.0) } else { 0.0 };
            let between = |values: &[f64]| values[before] + part * (values[after] - values[before]);
            self.time.push(now);
            self.position.push(between(position));
            self.force.push(match hold {
                Hold::Sampled => between(force),
                Hold::ZeroOrder => force[if part > 1.0 - 1e-6 { after } else { before }],
            });
        }
        self.segments.push(start..self.time.len());
        if hold == Hold::ZeroOrder {
            centre_held(&mut self.force[start..]);
        }
    }

    fn motion(&self, smoother: &LowPass, interval: f64, hold: Hold) -> Motion {
        let mut motion =
            Motion { position: Vec::new(), velocity: Vec::new(), acceleration: Vec::new() };
        for range in &self.segments {
            let x = smoother.run(&self.position[range.clone()]);
            motion.velocity.extend(first_difference(&x, interval));
            motion.acceleration.extend(second_difference(&x, interval, hold));
            motion.position.extend(x);
        }
        motion
    }
}

/// A command held over each interval acts on the motion around a sample as the mean of the intervals
/// before and after it; for a mass that is exact with the second difference of its position.
fn centre_held(force: &mut [f64]) {
    for k in (1..force.len()).rev() {
        force[k] = 0.5 * (force[k] + force[k - 1]);
    }
}

/// Central difference of fourth order, of second order near the ends.
fn first_difference(x: &[f64], interval: f64) -> Vec<f64> {
    let n = x.len();
    let at = |k: usize| match k {
        _ if n < 3 => 0.0,
        0 => x[1] - x[0],
        _ if k == n - 1 => x[k] - x[k - 1],
        _ if k == 1 || k == n - 2 => 0.5 * (x[k + 1] - x[k - 1]),
        _ => (8.0 * (x[k + 1] - x[k - 1]) - (x[k + 2] - x[k - 2])) / 12.0,
    };
    (0..n).map(|k| at(k) / interval).collect()
}

/// Second difference: of second order where the force is held (there it is exact), else of fourth.
fn second_difference(x: &[f64], interval: f64, hold: Hold) -> Vec<f64> {
    let n = x.len();
    let simple = |k: usize| x[k + 1] - 2.0 * x[k] + x[k - 1];
    let at = |k: usize| match k {
        _ if n < 3 => 0.0,
        _ if k == 0 || k == n - 1 => simple(k.clamp(1, n - 2)),
        _ if hold == Hold::ZeroOrder || k == 1 || k == n - 2 => simple(k),
        _ => (16.0 * (x[k + 1] + x[k - 1]) - (x[k + 2] + x[k - 2]) - 30.0 * x[k]) / 12.0,
    };
    (0..n).map(|k| at(k) / (interval * interval)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::Channel;

    fn sine(interval: f64, jitter: f64) -> Recording {
        counted(interval, jitter, 1e-12)
    }

    /// The same by a sensor that counts.
    fn counted(interval: f64, jitter: f64, count: f64) -> Recording {
        let time: Vec<f64> = (0..4000)
            .map(|k| interval * (f64::from(k) + jitter * (1.7 * f64::from(k)).sin()))
            .collect();
        let counted = |x: f64| (x / count).round() * count;
        let position = time.iter().map(|t| counted(0.05 * (6.0 * t).sin())).collect();
        let force = time.iter().map(|t| 10.0 * (6.0 * t).cos()).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Recording::new("sine", time, channels).unwrap()
    }

    #[test]
    fn velocity_and_acceleration_of_a_sine_are_within_a_per_mille() {
        let prepared = Prepared::new(&sine(1e-3, 0.0), None).unwrap();
        for &k in &prepared.grid {
            let t = prepared.time[k];
            assert!((prepared.velocity[k] - 0.3 * (6.0 * t).cos()).abs() < 3e-4);
            assert!((prepared.acceleration[k] + 1.8 * (6.0 * t).sin()).abs() < 2e-3);
        }
    }

    #[test]
    fn of_coarse_counts_at_a_high_rate_velocity_and_acceleration_are_those_of_the_motion() {
        let recording = counted(2.5e-4, 0.0, 2e-4);
        let prepared = Prepared::new(&recording, None).unwrap();
        assert!(prepared.bandwidth < 50.0, "{}", prepared.bandwidth);
        let errs = |of: &[f64], truth: &dyn Fn(f64) -> f64| {
            let truth: Vec<f64> = prepared.grid.iter().map(|k| truth(prepared.time[*k])).collect();
            let off: Vec<f64> = of.iter().zip(&truth).map(|(a, b)| a - b).collect();
            rms(&off) / rms(&truth)
        };
        let velocity = errs(&prepared.sample(&prepared.velocity), &|t| 0.3 * (6.0 * t).cos());
        let acceleration = prepared.compare(&prepared.acceleration);
        let acceleration = errs(&acceleration, &|t| -1.8 * (6.0 * t).sin());
        assert!(velocity < 0.03 && acceleration < 0.3, "{velocity} {acceleration}");
        assert!((prepared.apart() * prepared.bandwidth - BANDWIDTH).abs() < 1e-12);
        assert!(prepared.apart() > 4.0 * prepared.interval);
        // As wide as the rate would allow it is mostly noise.
        let wide = Prepared::new(&recording, Some(200.0)).unwrap();
        assert!(rms(&wide.acceleration) > 20.0 * rms(&prepared.acceleration));
    }

    #[test]
    fn irregular_sampling_costs_little() {
        let prepared = Prepared::new(&sine(1e-3, 0.2), None).unwrap();
        let worst = prepared
            .grid
            .iter()
            .map(|&k| (prepared.velocity[k] - 0.3 * (6.0 * prepared.time[k]).cos()).abs())
            .fold(0.0, f64::max);
        assert!(worst < 3e-3, "{worst}");
    }

    #[test]
    fn a_constant_position_is_refused() {
        let time: Vec<f64> = (0..100).map(|k| 1e-3 * f64::from(k)).collect();
        let force = time.clone();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", vec![1.0; 100])];
        let recording = Recording::new("still", time, channels).unwrap();
        assert_eq!(
            Prepared::new(&recording, None).unwrap_err(),
            PreparationError::Constant { channel: "position" }
        );
    }
}
