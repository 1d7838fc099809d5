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

mod came;
mod follow;
mod gain;
mod missing;
mod noise;
mod response;
mod rest;
mod stale;
mod strips;
mod surrogate;

use std::ops::Range;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use missing_physics::measurement::spread;
use missing_physics::{Hold, Recording};
use rayon::prelude::*;

pub use noise::Noise;
pub use response::Wave;

use crate::effects::Came;
use crate::model::Model;
use gain::{Gain, gains};
use strips::{Strip, teams};

/// Longest step of the simulation, s, and that with a second body.
const STEP: f64 = 1.25e-3;
const STEP_OF_TWO: f64 = 8e-4;
/// Most steps from sample to sample, and that with a second body; of slow samples a step is longer. What moves faster than they
/// are apart nobody saw.
const MOST_STEPS: f64 = 4.0;
const MOST_STEPS_OF_TWO: f64 = 8.0;
/// Samples of a search that follow each other faster are averaged: a step is no shorter.
const APART: f64 = 1e-3;
/// Fewest steps from sample to sample where the force comes late: a step heeds its mean alone, and a delay of part of a
/// sample is when within the sample it acts.
const LATE_STEPS: f64 = 2.0;
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
/// Fewest and most plants that advance together.
const LANES: (usize, usize) = (8, 40);
/// Why samples do not count.
const REPEATED: &str = "repeats the sample before it while the axis moves";
const UNSETTLED: &str = "start of a piece";
/// Plants in the widest vector.
const VECTOR: usize = 8;

/// Calls of [`Predictor::errors`] that are at work.
static AT_WORK: AtomicUsize = AtomicUsize::new(0);

/// One of them.
struct AtWork {
    /// Their number, this one among them, when it began.
    calls: usize,
}

impl AtWork {
    fn begin() -> Self {
        Self { calls: AT_WORK.fetch_add(1, Ordering::Relaxed) + 1 }
    }
}

impl Drop for AtWork {
    fn drop(&mut self) {
        AT_WORK.fetch_sub(1, Ordering::Relaxed);
    }
}

/// What is needed of a recording to predict it.
#[derive(Clone, Debug)]
pub struct Predictor {
    /// Where each sample stands in the recording.
    origin: Vec<usize>,
    time: Vec<f64>,
    position: Vec<f64>,
    force: Vec<f64>,
    /// By how much the slope of a force that was sampled changes at each sample, N/s; 0 where it is held or a piece ends.
    bends: Vec<f64>,
    hold: Hold,
    segments: Vec<Range<usize>>,
    noise: Noise,
    /// Samples that only repeat the one before.
    stale: Vec<bool>,
    /// How the axis came to each sample.
    came: Vec<Option<Came>>,
    /// Samples that count, in order.
    counted: Vec<usize>,
    /// Strips that are simulated side by side.
    teams: Vec<Vec<Strip>>,
    /// Process noise of the ladder, N.
    ladder: Vec<f64>,
    /// One for each process noise, made when it is first asked for: of a long recording that is searched in part few are.
    gains: Vec<OnceLock<Gain>>,
    /// Mass and damping that the gains are made for.
    plant: (f64, f64),
    fed_back: f64,
    rest_speed: f64,
    /// Typical time from sample to sample, s.
    interval: f64,
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
            bends: bends(recording, &force),
            hold: recording.hold(),
            segments: recording.segments().to_vec(),
            came: Vec::new(),
            counted: Vec::new(),
            teams: Vec::new(),
            ladder,
            gains: Vec::new(),
            plant: (mass, damping),
            fed_back: FED_BACK * (stroke.1 - stroke.0),
            rest_speed: REST * noise.position / recording.interval().max(f64::MIN_POSITIVE),
            interval: recording.interval(),
            position,
            force,
            noise,
            stale,
        };
        predictor.came = predictor.came();
        predictor.arrange();
        predictor.tune(mass, damping);
        (!predictor.counted.is_empty()).then_some(predictor)
    }

    /// The same where the recorded force has at least so much white noise, N or N m.
    #[must_use]
    pub fn with_force_noise(mut self, noise: f64) -> Self {
        let Noise { position, force, force_at_most } = self.noise;
        let (force, force_at_most) = (force.max(noise), force_at_most.max(noise));
        self.noise = Noise { position, force, force_at_most };
        let (mass, damping) = self.plant;
        self.tune(mass, damping);
        self
    }

    /// Finds which samples count, and what is simulated side by side.
    fn arrange(&mut self) {
        let settled = self.segments.iter().flat_map(|s| self.settled(s));
        self.counted = settled.filter(|k| !self.stale[*k]).collect();
        self.teams = teams(&self.segments, &self.time, |k| self.speed_around(k));
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

    fn samples(&self) -> usize {
        self.segments.iter().map(Range::len).sum()
    }

    /// Whether it has clearly more than so many samples.
    fn has_more_than(&self, most: usize) -> bool {
        self.samples() > most + most / 4
    }

    /// The same without samples that follow each other faster than `apart` s, where there are more than `most`.
    #[must_use]
    pub fn no_faster(self, apart: f64, most: usize) -> Self {
        let coarser = if self.has_more_than(most) { self.coarser(apart) } else { None };
        coarser.unwrap_or(self)
    }

    /// The same on pieces of about `length` s, spread over the recording, that have `most` samples together, of which none are
    /// needed that follow each other faster than a step; nothing where the recording has no more.
    pub fn thinned(&self, most: usize, length: f64) -> Option<Self> {
        if !self.has_more_than(most) {
            return None;
        }
        let coarser = self.coarser(APART);
        let thinned = coarser.as_ref().unwrap_or(self).pieces(most, length);
        thinned.or(coarser)
    }

    /// The same with every so many samples only, the force averaged in between; nothing where no two of them lie within
    /// `apart` s.
    fn coarser(&self, apart: f64) -> Option<Self> {
        let every = (apart / self.interval * (1.0 + 1e-6)) as usize;
        if every < 2 {
            return None;
        }
        let mut segments = Vec::new();
        let (mut kept, mut force) = (Vec::new(), Vec::new());
        for segment in &self.segments {
            let start = kept.len();
            for k in segment.clone().step_by(every) {
                kept.push(k);
                let next = (k + every).min(segment.end - 1);
                force.push(self.hold.mean(&self.time, &self.force, k, next));
            }
            segments.push(start..kept.len());
        }
        // A white force is as much less in a mean.
        let less = (every as f64).sqrt();
        let Noise { position, force: noise, force_at_most } = self.noise;
        let coarser = Self {
            bends: vec![0.0; kept.len()],
            hold: Hold::ZeroOrder,
            ladder: self.ladder.iter().map(|force| force / less).collect(),
            interval: self.interval * every as f64,
            noise: Noise { position, force: noise / less, force_at_most: force_at_most / less },
            force,
            ..self.at(&kept, segments)
        };
        Some(coarser.arranged())
    }

    /// The same on pieces; see [`Self::thinned`].
    fn pieces(&self, most: usize, length: f64) -> Option<Self> {
        if !self.has_more_than(most) {
            return None;
        }
        let share = most as f64 / self.samples() as f64;
        let parts = spread(&self.segments, share, |segment| {
            let interval =
                (self.time[segment.end - 1] - self.time[segment.start]) / segment.len() as f64;
            // A segment that is shorter is a piece.
            ((length / interval) as usize).clamp(50, most / 4).min(segment.len())
        });
        let mut end = 0;
        let segments = parts.iter().map(|part| {
            let start = end;
            end += part.len();
            start..end
        });
        let kept: Vec<usize> = parts.iter().flat_map(Range::clone).collect();
        let segments = segments.collect();
        Some(self.at(&kept, segments).arranged())
    }

    /// What is known at these samples, which are those of `segments`: not arranged yet.
    fn at(&self, samples: &[usize], segments: Vec<Range<usize>>) -> Self {
        Self {
            segments,
            origin: picked(&self.origin, samples),
            time: picked(&self.time, samples),
            position: picked(&self.position, samples),
            force: picked(&self.force, samples),
            bends: picked(&self.bends, samples),
            stale: picked(&self.stale, samples),
            came: picked(&self.came, samples),
            counted: Vec::new(),
            teams: Vec::new(),
            gains: Vec::new(),
            ladder: self.ladder.clone(),
            noise: self.noise,
            ..*self
        }
    }

    /// The same, ready.
    fn arranged(mut self) -> Self {
        self.arrange();
        self.tune(self.plant.0, self.plant.1);
        self
    }

    /// Time that the samples that count stand for, s.
    pub fn duration(&self) -> f64 {
        self.counted.len() as f64 * self.interval
    }

    /// Typical time from sample to sample, s.
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Instants of the samples that count, s, and the number of the piece that each belongs to.
    pub fn instants(&self) -> Vec<(f64, usize)> {
        self.counted.iter().map(|k| (self.time[*k], self.piece(*k))).collect()
    }

    fn piece(&self, sample: usize) -> usize {
        self.segments.partition_point(|segment| segment.end <= sample)
    }

    /// What each sample that counts is worth, at most 1: less where the position reads the same for long.
    pub fn worth(&self) -> Vec<f64> {
        let worth = rest::worth(&self.position, &self.segments);
        self.counted.iter().map(|k| worth[*k]).collect()
    }

    /// What is known of the noise.
    pub fn noise(&self) -> &Noise {
        &self.noise
    }

    /// Share of the samples that only repeat the one before although the axis moves.
    pub fn stale(&self) -> f64 {
        let stale = self.segments.iter().flat_map(|s| &self.stale[s.clone()]);
        stale.filter(|stale| **stale).count() as f64 / self.samples() as f64
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
        // Few lanes cost as much as many: where other calls keep the threads busy these are not dealt out among them.
        let work = AtWork::begin();
        let threads = (rayon::current_num_threads() / work.calls).max(1);
        let beside = self.teams.iter().map(Vec::len).max().unwrap_or(1);
        let each = models.len().div_ceil(threads);
        let each = each.clamp(LANES.0.div_ceil(beside), LANES.1.div_ceil(beside));
        let mut place = vec![None; self.time.len()];
        self.counted.iter().enumerate().for_each(|(k, n)| place[*n] = Some(k));
        let jobs: Vec<_> =
            models.chunks(each).flat_map(|m| self.teams.iter().map(move |t| (m, t))).collect();
        let done: Vec<Vec<Vec<f64>>> =
            jobs.par_iter().map(|(models, team)| self.batch(models, team, &place)).collect();
        // Team by team, in the order of time.
        let mut errors = Vec::with_capacity(models.len());
        for of_models in done.chunks(self.teams.len().max(1)) {
            let count = of_models.first().map_or(0, Vec::len);
            errors.extend((0..count).map(|i| {
                of_models.iter().flat_map(|team| &team[i]).copied().collect::<Vec<f64>>()
            }));
        }
        errors
    }

    /// The position that a model shows at each sample of the recording, one sample ahead; no number at the first of a
    /// piece, or anywhere where the model cannot be simulated.
    pub fn shown(&self, model: &Model, setting: usize) -> Vec<f64> {
        let mut shown = vec![f64::NAN; self.time.len()];
        let trial = [(model.clone(), setting)];
        let seen = self.teams.iter().try_for_each(|team| {
            self.side_by_side(team, &trial, self.missed(), |n, step| {
                shown[n] = self.position[n] - step.error[0];
            })
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

    /// Errors of models at the samples of a team that count; `place` is that of each sample among all that do.
    fn batch(
        &self,
        trials: &[(Model, usize)],
        team: &[Strip],
        place: &[Option<usize>],
    ) -> Vec<Vec<f64>> {
        let gain: Vec<&Gain> = trials.iter().map(|(_, setting)| self.gain(*setting)).collect();
        let told = team.iter().flat_map(|strip| place[strip.tells.clone()].iter().flatten());
        let (first, count) = (told.clone().next().copied().unwrap_or(0), told.count());
        // Sample by sample first.
        let mut rows = vec![f64::NAN; count * trials.len()];
        let plants = self.side_by_side(team, trials, self.missed(), |n, step| {
            if let Some(place) = place[n] {
                rows[(place - first) * trials.len()..][..trials.len()].copy_from_slice(step.error);
            }
        });
        let failed = plants.is_err();
        let scaled = |(i, gain): (usize, &&Gain)| -> Vec<f64> {
            let cut = LIMIT * gain.expected;
            let each = self.counted[first..first + count].iter().enumerate().map(|(k, n)| {
                // A model that runs away errs as much as can be, whatever it says.
                let scaled = rows[k * trials.len() + i] * gain.relative[*n];
                let error = if scaled.is_finite() { scaled.clamp(-cut, cut) } else { cut };
                if failed { f64::NAN } else { error }
            });
            each.collect()
        };
        gain.iter().enumerate().map(scaled).collect()
    }

    /// The gain of a setting while the axis moves.
    fn gain(&self, setting: usize) -> &Gain {
        self.gain_of(setting % self.ladder.len())
    }
}

/// By how much the slope of a sampled `force` changes at each sample.
fn bends(recording: &Recording, force: &[f64]) -> Vec<f64> {
    let mut bends = vec![0.0; force.len()];
    if recording.hold() == Hold::Sampled {
        let time = recording.time();
        let slope = |k: usize| (force[k + 1] - force[k]) / (time[k + 1] - time[k]);
        let inside = |segment: &Range<usize>| segment.start + 1..segment.end.saturating_sub(1);
        for k in recording.segments().iter().flat_map(inside) {
            bends[k] = slope(k) - slope(k - 1);
        }
    }
    bends
}

/// The values at these samples.
fn picked<T: Copy>(values: &[T], samples: &[usize]) -> Vec<T> {
    samples.iter().map(|k| values[*k]).collect()
}

#[cfg(test)]
mod tests;
