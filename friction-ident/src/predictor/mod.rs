//! One sample ahead: the prediction errors of models along a recording.
//!
//! The plant is simulated as it is, stick and all, under the recorded force; at every sample its state is
//! corrected by the prediction error times the gain of a Kalman filter. What is left are innovations: with
//! the true model they are as large as the noise of encoder and force makes them, and white; whatever the
//! model lacks makes them larger. This is the innovations form of prediction-error methods (L. Ljung, System
//! Identification, 1999, ch. 5 and 7).
//!
//! The gain stands for what the model does not know: a white force that is added to the recorded one. A
//! ladder of such forces is held ready, and each model is judged at the one that suits it best; a second
//! ladder trusts the model while the axis is at rest, where friction holds whatever else acts.

mod gain;
mod missing;
mod noise;
mod response;
mod stale;
mod surrogate;

use std::ops::Range;
use std::sync::OnceLock;

use missing_physics::measurement::spread;
use missing_physics::{Hold, Recording};
use rayon::prelude::*;

pub use noise::Noise;
pub use response::Wave;

use crate::effects::Slot;
use crate::model::Model;
use crate::simulator::{Input, Plants, SimulationError, Start};
use gain::{Gain, gains};

/// Longest step of the simulation, s, and that with a second body.
const STEP: f64 = 1.25e-3;
const STEP_OF_TWO: f64 = 8e-4;
/// Process noise of the ladder: the smallest as a share of the rms force, the factor from rung to rung, and the
/// number of rungs.
const LEAST: f64 = 1e-3;
const FACTOR: f64 = 3.2;
const RUNGS: usize = 7;
/// Time at the start of a piece, s, in which states that nobody knows settle; at most this share of the piece.
const SETTLING: f64 = 0.3;
const SETTLING_SHARE: f64 = 0.1;
/// Largest error that is fed back, as a share of the stroke: a wild sample must not throw the state away.
const FED_BACK: f64 = 0.02;
/// Speed of rest, in standard deviations of the position per sampling interval.
const REST: f64 = 0.5;
/// Errors in standard deviations beyond which they are cut off: a model that runs away.
const LIMIT: f64 = 1e4;
/// Length of the pieces of a thinned recording, s.
const PIECE: f64 = 1.0;
/// Fewest and most plants that advance together.
const LANES: (usize, usize) = (8, 32);
/// Why samples do not count.
const REPEATED: &str = "repeats the sample before it while the axis moves";
const UNSETTLED: &str = "start of a piece";
/// Plants in the widest vector.
const VECTOR: usize = 8;

/// What is needed of a recording to predict it.
#[derive(Clone, Debug)]
pub struct Predictor {
    /// Where each sample stands in the recording.
    origin: Vec<usize>,
    time: Vec<f64>,
    position: Vec<f64>,
    force: Vec<f64>,
    hold: Hold,
    segments: Vec<Range<usize>>,
    noise: Noise,
    /// Samples that only repeat the one before.
    stale: Vec<bool>,
    /// Samples that count, in order.
    counted: Vec<usize>,
    /// Process noise of the ladder, N.
    ladder: Vec<f64>,
    /// One for each process noise, made when it is first asked for: of a long recording that is searched in part few are.
    gains: Vec<OnceLock<Gain>>,
    /// Mass and damping that the gains are made for.
    plant: (f64, f64),
    fed_back: f64,
    rest_speed: f64,
}

/// What happens to a model at a sample.
struct Step {
    /// Measured less shown position, m or rad.
    error: f64,
    /// What is added to position and velocity after it.
    fed: (f64, f64),
    /// Whether the model rests at its end.
    rests: bool,
}

impl Predictor {
    /// A predictor for a recording with channels `force` and `position`, its gains made for a plant of `mass`
    /// and `damping` (SI).
    pub fn new(recording: &Recording, mass: f64, damping: f64) -> Option<Self> {
        let force = recording.channel("force")?.values.clone();
        let position = recording.channel("position")?.values.clone();
        let stale = stale::stale(recording, &position);
        let noise = Noise::of(recording, &stale, mass)?;
        let rms = (force.iter().map(|f| f * f).sum::<f64>() / force.len() as f64).sqrt();
        let ladder = (0..RUNGS).map(|k| rms * LEAST * FACTOR.powi(k as i32)).collect();
        let stroke = position.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        let mut predictor = Self {
            origin: (0..recording.len()).collect(),
            time: recording.time().to_vec(),
            hold: recording.hold(),
            segments: recording.segments().to_vec(),
            counted: Vec::new(),
            ladder,
            gains: Vec::new(),
            plant: (mass, damping),
            fed_back: FED_BACK * (stroke.1 - stroke.0),
            rest_speed: REST * noise.position / recording.interval().max(f64::MIN_POSITIVE),
            position,
            force,
            noise,
            stale,
        };
        predictor.counted = predictor.countable();
        predictor.tune(mass, damping);
        (!predictor.counted.is_empty()).then_some(predictor)
    }

    fn countable(&self) -> Vec<usize> {
        let settled = self.segments.iter().flat_map(|s| self.settled(s));
        settled.filter(|k| !self.stale[*k]).collect()
    }

    /// Samples of a piece from which on its start no longer matters.
    fn settled(&self, segment: &Range<usize>) -> Range<usize> {
        let until = self.time[segment.start] + SETTLING;
        let by_time = self.time[segment.clone()].iter().take_while(|t| **t < until).count();
        let skipped = by_time.max(20).min((segment.len() as f64 * SETTLING_SHARE) as usize);
        segment.start + skipped.max(1).min(segment.len())..segment.end
    }

    /// Makes the gains for a plant of `mass` and `damping`.
    pub fn tune(&mut self, mass: f64, damping: f64) {
        self.plant = (mass, damping);
        self.gains = vec![OnceLock::new(); self.ladder.len()];
    }

    /// The gain for a process noise of the ladder.
    fn gain_of(&self, rung: usize) -> &Gain {
        self.gains[rung].get_or_init(|| {
            let force = self.ladder[rung].hypot(self.noise.force);
            gains(
                &self.time,
                &self.segments,
                &self.counted,
                &self.stale,
                self.plant,
                (self.noise.position, force),
            )
        })
    }

    /// The same on pieces of about `PIECE` s, spread over the recording, that have `most` samples together; nothing
    /// where the recording has no more.
    pub fn thinned(&self, most: usize) -> Option<Self> {
        let all: usize = self.segments.iter().map(Range::len).sum();
        if all <= most + most / 4 {
            return None;
        }
        let share = most as f64 / all as f64;
        let parts = spread(&self.segments, share, |segment| {
            let interval =
                (self.time[segment.end - 1] - self.time[segment.start]) / segment.len() as f64;
            ((PIECE / interval) as usize).clamp(50, most / 4)
        });
        let mut end = 0;
        let segments = parts.iter().map(|part| {
            let start = end;
            end += part.len();
            start..end
        });
        let mut thinned = Self {
            segments: segments.collect(),
            origin: picked(&self.origin, &parts),
            time: picked(&self.time, &parts),
            position: picked(&self.position, &parts),
            force: picked(&self.force, &parts),
            stale: picked(&self.stale, &parts),
            counted: Vec::new(),
            gains: Vec::new(),
            ladder: self.ladder.clone(),
            noise: self.noise,
            ..*self
        };
        thinned.counted = thinned.countable();
        thinned.tune(self.plant.0, self.plant.1);
        Some(thinned)
    }

    /// Instants of the samples that count, s, and the number of the piece that each belongs to.
    pub fn instants(&self) -> Vec<(f64, usize)> {
        self.counted.iter().map(|k| (self.time[*k], self.piece(*k))).collect()
    }

    fn piece(&self, sample: usize) -> usize {
        self.segments.partition_point(|segment| segment.end <= sample)
    }

    /// What is known of the noise.
    pub fn noise(&self) -> &Noise {
        &self.noise
    }

    /// Share of the samples that only repeat the one before although the axis moves.
    pub fn stale(&self) -> f64 {
        let stale = self.segments.iter().flat_map(|s| &self.stale[s.clone()]);
        let all: usize = self.segments.iter().map(Range::len).sum();
        stale.filter(|stale| **stale).count() as f64 / all as f64
    }

    /// Indices in the recording of the samples that count.
    pub fn counted(&self) -> impl Iterator<Item = usize> {
        self.counted.iter().map(|k| self.origin[*k])
    }

    /// Number of process noises: the ladder, and the ladder with trust at rest.
    pub fn settings(&self) -> usize {
        2 * self.ladder.len()
    }

    /// Process noise of a setting, N.
    pub fn process(&self, setting: usize) -> f64 {
        self.ladder[setting % self.ladder.len()]
    }

    /// Innovation that is to be expected at a setting, m or rad: its standard deviation at a typical sample.
    pub fn expected(&self, setting: usize) -> f64 {
        self.gain(setting).expected
    }

    /// Innovation that the sensors alone make: the smallest process noise beside that of the recorded force.
    pub fn budget(&self) -> f64 {
        self.gain_of(1.min(self.gains.len() - 1)).expected
    }

    /// Prediction errors of models of the same effects, each at its own setting, at the samples that count: m or
    /// rad, each brought to the size that it would have at a typical sample.
    pub fn errors(&self, models: &[(Model, usize)]) -> Vec<Vec<f64>> {
        let threads = rayon::current_num_threads().max(1);
        let lanes = models.len().div_ceil(threads).next_multiple_of(4).clamp(LANES.0, LANES.1);
        let batches: Vec<Vec<Vec<f64>>> =
            models.par_chunks(lanes).map(|batch| self.batch(batch)).collect();
        batches.into_iter().flatten().collect()
    }

    /// The position that a model shows at each sample of the recording, one sample ahead; no number at the first of a
    /// piece, or anywhere where the model cannot be simulated.
    pub fn shown(&self, model: &Model, setting: usize) -> Vec<f64> {
        let mut shown = vec![f64::NAN; self.time.len()];
        let seen = self.follow(&[(model.clone(), setting)], |n, _, step| {
            shown[n] = self.position[n] - step.error;
        });
        if seen.is_err() {
            shown.fill(f64::NAN);
        }
        shown
    }

    /// Why each sample does not count; nothing for those that do.
    pub fn left_out(&self) -> Vec<Option<&'static str>> {
        let why = |k: usize| if self.stale[k] { REPEATED } else { UNSETTLED };
        let mut left_out: Vec<_> = (0..self.time.len()).map(|k| Some(why(k))).collect();
        self.counted.iter().for_each(|k| left_out[*k] = None);
        left_out
    }

    fn batch(&self, trials: &[(Model, usize)]) -> Vec<Vec<f64>> {
        let gain: Vec<&Gain> = trials.iter().map(|(_, setting)| self.gain(*setting)).collect();
        let mut errors = vec![Vec::with_capacity(self.counted.len()); trials.len()];
        let mut counted = vec![false; self.time.len()];
        self.counted.iter().for_each(|k| counted[*k] = true);
        let plants = self.follow(trials, |n, i, step| {
            if counted[n] {
                // A model that runs away errs as much as can be, whatever it says.
                let (scaled, cut) = (step.error * gain[i].relative[n], LIMIT * gain[i].expected);
                errors[i].push(if scaled.is_finite() { scaled.clamp(-cut, cut) } else { cut });
            }
        });
        if plants.is_err() {
            return vec![vec![f64::NAN; self.counted.len()]; trials.len()];
        }
        errors
    }

    /// The gain of a setting while the axis moves.
    fn gain(&self, setting: usize) -> &Gain {
        self.gain_of(setting % self.ladder.len())
    }

    /// Runs models of the same effects along the recording, each at its own setting; tells what happens at every
    /// sample but the first of a piece: its number, that of the model, and the step.
    fn follow(
        &self,
        trials: &[(Model, usize)],
        see: impl FnMut(usize, usize, &Step),
    ) -> Result<(), SimulationError> {
        self.follow_errors(trials, |n, shown| self.position[n] - shown, see)
    }

    /// The same with errors of the caller's: from the number of the sample and the position that a model shows there.
    fn follow_errors(
        &self,
        trials: &[(Model, usize)],
        mut error: impl FnMut(usize, f64) -> f64,
        mut see: impl FnMut(usize, usize, &Step),
    ) -> Result<(), SimulationError> {
        let lanes = trials.len();
        let mut models: Vec<Model> = trials.iter().map(|(model, _)| model.clone()).collect();
        let two = models[0].acts_on(Slot::Attached);
        if two && lanes > 1 {
            // A vector that is not full costs as much as one that is, plants beside it far more.
            models.resize(lanes.next_multiple_of(VECTOR), trials[lanes - 1].0.clone());
        }
        let mut plants = Plants::new(&models)?;
        let rungs = self.ladder.len();
        let gain: Vec<&Gain> = trials.iter().map(|(_, setting)| self.gain(*setting)).collect();
        let at_rest: Vec<&Gain> =
            trials.iter().map(|(_, s)| self.gain_of(if *s < rungs { *s } else { 0 })).collect();
        let step = if two { STEP_OF_TWO } else { STEP };
        let input = Input::new(&self.time, &self.force, self.hold).with_max_step(step);
        let all = models.len();
        let (mut length, mut command) = (vec![0.0; all], vec![0.0; all]);
        let (mut dx, mut dv) = (vec![0.0; all], vec![0.0; all]);
        for segment in &self.segments {
            let start = self.start(segment);
            (0..all).for_each(|i| plants.start(i, &start));
            for k in segment.start..segment.end - 1 {
                let (steps, duration) = input.steps(k);
                length.fill(duration);
                for j in 0..steps {
                    command.fill(input.mean(k, j, steps));
                    plants.step(&length, &command);
                }
                let n = k + 1;
                let (shown, velocity) = (plants.shown(), plants.velocity());
                for i in 0..lanes {
                    let error = error(n, shown[i]);
                    let rests = velocity[i].abs() < self.rest_speed;
                    let g = if rests { at_rest[i] } else { gain[i] };
                    let finite = error.is_finite();
                    let fed = if finite { error.clamp(-self.fed_back, self.fed_back) } else { 0.0 };
                    dx[i] = g.position[n] * fed;
                    dv[i] = g.velocity[n] * fed;
                    see(n, i, &Step { error, fed: (dx[i], dv[i]), rests });
                }
                for i in lanes..all {
                    (dx[i], dv[i]) = (dx[lanes - 1], dv[lanes - 1]);
                }
                plants.correct(&dx, &dv);
            }
        }
        Ok(())
    }

    /// Where a piece starts: at rest, unless the first samples move by more than their noise.
    fn start(&self, segment: &Range<usize>) -> Start {
        let first = segment.start;
        let next = (first + 4).min(segment.end - 1);
        let moved = self.position[next] - self.position[first];
        let moves = moved.abs() > 6.0 * self.noise.position;
        let duration = (self.time[next] - self.time[first]).max(f64::MIN_POSITIVE);
        let velocity = if moves { moved / duration } else { 0.0 };
        let command = self.force[first];
        Start { time: self.time[first], command, ..Start::at(self.position[first], velocity) }
    }
}

/// The values of these parts, one after the other.
fn picked<T: Copy>(values: &[T], parts: &[Range<usize>]) -> Vec<T> {
    parts.iter().flat_map(|part| values[part.clone()].iter().copied()).collect()
}

#[cfg(test)]
mod tests;
