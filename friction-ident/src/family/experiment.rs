//! The motion that tells rival models apart, found by simulating them.
//!
//! Each motion of a small set is simulated in a closed loop once with each rival as the plant; every other
//! rival is then fitted to that recording. What it cannot imitate separates the two. The motion is taken
//! whose smallest separation over all pairs, per unit of time, is the largest.

mod motions;
mod told;

use missing_physics::diagnosis::noise;
use missing_physics::fit::{self, Fit};
use missing_physics::statistics::basis::dot;
use missing_physics::statistics::split::Split;
use missing_physics::{Channel, DiscoverError, Fitted, Recording, RecordingError, terms};
use rayon::prelude::*;
use serde::Serialize;

use self::motions::{Motion, Room, motions};
use super::{FrictionFamily, Options};
use crate::axis::Quantity;
use crate::closed_loop::{Controller, Pd, Sample, Setup, closed_loop};
use crate::driven::{MeasuredMotion, force_along};
use crate::model::Model;
use crate::reference::Reference;
use crate::signal::quantile;

/// A motion that brings less than this factor per root of time over the recording at hand is hardly worth running.
const MUCH: f64 = 1.5;
/// Share of the stroke that is kept free at either end.
const MARGIN: f64 = 0.05;
/// Speeds and accelerations above this quantile are not asked for again.
const USUAL: f64 = 0.995;
/// Bandwidth of the controller, rad per sample, and one to fall back to.
const BANDWIDTHS: [f64; 2] = [0.11, 0.03];
/// A plant that strays farther than this share of the stroke does not follow.
const STRAYS: f64 = 0.1;
/// The force may exceed the largest recorded one by this factor.
const FORCE: f64 = 1.5;
/// Share of the instants, those where rivals differ most, by which the difference is told.
const MOST_DIFFERENT: f64 = 0.05;

/// A motion to run next.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The effects that it separates.
    pub effects: Vec<String>,
    /// Name of the motion.
    pub motion: String,
    /// What it does, in words.
    pub about: String,
    /// The motion itself.
    pub reference: Reference,
    /// Separation of the two rivals that it separates least.
    pub separation: Separation,
    /// The same of the recording at hand.
    pub here: Separation,
    /// How many times as fast as in the recording at hand the standard deviations, which grow with the
    /// root of time, come together.
    pub gain: f64,
    /// Standard deviation of the force that no model explains, in `unit`.
    pub noise: f64,
    /// Unit of the forces.
    pub unit: &'static str,
    /// Unit of the reference's positions.
    pub position_unit: &'static str,
    /// Every motion that was tried.
    pub tried: Vec<Tried>,
}

/// A motion that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// Its name.
    pub motion: String,
    /// Standard deviations of its smallest separation; 0 where it could not be simulated.
    pub deviations: f64,
}

impl Experiment {
    /// Duration of the motion, s.
    pub fn duration(&self) -> f64 {
        self.reference.position.len() as f64 * self.reference.sample_time
    }

    /// How many times the noise the force of a separation is.
    pub fn noises(&self, separation: &Separation) -> f64 {
        separation.force / self.noise
    }

    /// Whether the motion tells them apart so much better than the recording at hand that it is worth running.
    pub fn is_worth_running(&self) -> bool {
        self.gain >= MUCH
    }

    /// The motion as a recording with the channel `position`.
    ///
    /// # Errors
    /// A motion that is too short or not finite.
    pub fn recording(&self) -> Result<Recording, RecordingError> {
        let step = self.reference.sample_time;
        let time = (0..self.reference.position.len()).map(|k| k as f64 * step).collect();
        let position = self.reference.position.clone();
        let channel = Channel::new("position", self.position_unit, position);
        Recording::new("experiment", time, vec![channel])
    }
}

/// How far the forces of two models differ after each has adapted its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Root mean square where they differ most (5 % of the instants), in the unit of the force.
    pub force: f64,
    /// All differences together in standard deviations of the noise: their root sum square, taken at
    /// independent instants, over the noise.
    pub deviations: f64,
}

/// Why there is no experiment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// Fewer than two effects.
    #[error("there is nothing to tell apart: {0} rival effects")]
    NoRivals(usize),
    /// An effect that the family does not have.
    #[error(transparent)]
    Unknown(#[from] DiscoverError),
    /// No motion could be simulated.
    #[error("no motion could be simulated with these models: {0}")]
    NoMotion(String),
}

impl FrictionFamily {
    /// The motion that separates `effects` best, each of them added to a model of the effects `below` that are not among
    /// them.
    ///
    /// # Errors
    /// See [`ExperimentError`].
    pub fn experiment_between(
        &self,
        below: &[String],
        effects: &[String],
        seed: u64,
    ) -> Result<Experiment, ExperimentError> {
        if effects.len() < 2 {
            return Err(ExperimentError::NoRivals(effects.len()));
        }
        let below: Vec<String> =
            below.iter().filter(|name| !effects.contains(name)).cloned().collect();
        let rivals = self.rivals(&below, effects, seed)?;
        let best = rivals.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        let residual = best.map_or(&[][..], |fit| fit.residual.as_slice());
        let size = (dot(residual, residual) / residual.len().max(1) as f64).sqrt();
        let noise = Some(noise::floor_of(self, residual)).filter(|floor| *floor > 0.0);
        let noise = noise.unwrap_or(size).max(f64::MIN_POSITIVE);
        let models: Vec<Fitted> = rivals.iter().map(|fit| fit.model.clone()).collect();
        let room = self.room();
        let tried: Vec<(Motion, Result<Separation, String>)> = motions(&room)
            .into_par_iter()
            .map(|motion| {
                let separation = self.least(&models, &motion, &room, noise);
                (motion, separation)
            })
            .collect();
        let rate = |(motion, separation): &(Motion, Result<Separation, String>)| {
            let time = (motion.reference.position.len() as f64).sqrt();
            separation.as_ref().map_or(0.0, |separation| separation.deviations / time)
        };
        let best = tried.iter().max_by(|a, b| rate(a).total_cmp(&rate(b)));
        let (motion, separation) = match best {
            Some((motion, Ok(separation))) => (motion.clone(), *separation),
            Some((_, Err(why))) => return Err(ExperimentError::NoMotion(why.clone())),
            None => return Err(ExperimentError::NoMotion(String::new())),
        };
        let mut here = Vec::new();
        for plant in &rivals {
            // As if the recording had been made by this rival.
            let shadow = Self { target: plant.prediction.clone(), ..self.clone() };
            here.extend(shadow.imitations(&models, &plant.model, noise));
        }
        let here = Separation::smallest(here);
        let time =
            (motion.reference.position.len() as f64 / self.prepared.time.len() as f64).sqrt();
        let gain = separation.deviations / here.deviations.max(f64::MIN_POSITIVE) / time;
        Ok(Experiment {
            effects: effects.to_vec(),
            motion: motion.name.to_owned(),
            about: motion.about.to_owned(),
            reference: motion.reference,
            separation,
            here,
            gain,
            noise,
            unit: self.effort.unit(self.axis, Quantity::Force),
            position_unit: self.axis.unit(Quantity::Length),
            tried: tried
                .iter()
                .map(|(motion, separation)| Tried {
                    motion: motion.name.to_owned(),
                    deviations: separation.as_ref().map_or(0.0, |s| s.deviations),
                })
                .collect(),
        })
    }

    /// The models that each have one of the effects, identified on the fitted blocks.
    fn rivals(
        &self,
        below: &[String],
        effects: &[String],
        seed: u64,
    ) -> Result<Vec<Fit>, ExperimentError> {
        let base = terms(self, below)?;
        let split = Split::new(self.target.len(), self.blocks.clone());
        let fitted: Vec<f64> =
            split.fit(self.target.len()).iter().map(|fit| f64::from(u8::from(*fit))).collect();
        let fit = fit::identify(self, &base, &fitted, seed).fit;
        effects
            .iter()
            .map(|effect| {
                let all = terms(self, std::slice::from_ref(effect))?;
                // Those of every model come first.
                let term = all[all.len() - 1];
                let start = fit::shaped(self, &fit, term, &fitted, seed);
                Ok(fit::refine(self, start, &fitted))
            })
            .collect()
    }

    /// What the recording has shown the axis to do.
    fn room(&self) -> Room {
        let p = &self.prepared;
        let stroke = self.stroke.1 - self.stroke.0;
        Room {
            start: self.stroke.0 + MARGIN * stroke,
            stroke: (1.0 - 2.0 * MARGIN) * stroke,
            speed: quantile(&p.velocity, USUAL),
            // By the heavier smoother: the lighter one leaves more noise in it.
            acceleration: quantile(&p.heavier.1, USUAL),
            resolution: (4.0 * p.position_noise).max(1e-6 * stroke),
            interval: p.interval,
        }
    }

    /// Separation of the two rivals that `motion` separates least.
    fn least(
        &self,
        models: &[Fitted],
        motion: &Motion,
        room: &Room,
        noise: f64,
    ) -> Result<Separation, String> {
        let bandwidth = Some(self.prepared.bandwidth);
        let options =
            Options { bandwidth, library: self.library.clone(), known: self.known.clone() };
        let mut all = Vec::new();
        for plant in models {
            let recording = self.simulated(plant, &motion.reference, room)?;
            let seen = Self::new(&recording, &options)
                .map_err(|error| error.to_string())?
                .with_stroke_of(self);
            all.extend(seen.imitations(models, plant, noise));
        }
        Ok(Separation::smallest(all))
    }

    /// How far every other model stays from `plant`, which made this recording, when all are fitted to it.
    fn imitations(&self, models: &[Fitted], plant: &Fitted, noise: f64) -> Vec<Separation> {
        let all = vec![1.0; self.target.len()];
        let fitted = |model: &Fitted| fit::refine(self, model.clone(), &all).prediction;
        let truth = fitted(plant);
        let others = models.iter().filter(|model| model.terms != plant.terms);
        others.map(|other| Separation::of(&truth, &fitted(other), noise)).collect()
    }

    /// A rival as the plant of a closed loop that follows `reference`.
    fn simulated(
        &self,
        fitted: &Fitted,
        reference: &Reference,
        room: &Room,
    ) -> Result<Recording, String> {
        let plant = self.model(fitted).map_err(|error| error.to_string())?;
        let ahead = required(&plant, reference);
        let mut why = String::new();
        for bandwidth in BANDWIDTHS {
            let (mass, w) = (plant.mass(), bandwidth / room.interval);
            let pd = Pd::new(mass * w * w, 1.6 * mass * w).with_smoothing(0.35);
            let mut controller = Follower { pd, ahead: &ahead, sample: 0 };
            let largest = self.prepared.force.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
            let setup = Setup {
                encoder_resolution: self.prepared.position_noise * 12.0f64.sqrt(),
                force_limit: FORCE * largest,
                max_step: 0.25 * room.interval,
                ..Setup::default()
            };
            match closed_loop(&plant, reference, &mut controller, &setup) {
                Ok(run) => {
                    let strays = run.position.iter().zip(&reference.position);
                    let strays = strays.fold(0.0, |most: f64, (x, r)| most.max((x - r).abs()));
                    if strays <= STRAYS * room.stroke {
                        return Ok(run.recording);
                    }
                    "the simulated plant does not follow".clone_into(&mut why);
                }
                Err(error) => why = error.to_string(),
            }
        }
        Err(why)
    }
}

/// Feeds the force that the reference requires forward, so that a plain controller follows.
struct Follower<'a> {
    pd: Pd,
    ahead: &'a [f64],
    sample: usize,
}

impl Controller for Follower<'_> {
    fn command(&mut self, sample: &Sample) -> f64 {
        let ahead = self.ahead.get(self.sample).copied().unwrap_or(0.0);
        self.sample += 1;
        ahead + self.pd.command(sample)
    }
}

/// The force that `plant` requires along a reference.
fn required(plant: &Model, reference: &Reference) -> Vec<f64> {
    let samples = reference.position.len();
    let time: Vec<f64> = (0..samples).map(|k| k as f64 * reference.sample_time).collect();
    MeasuredMotion::new(&time, &reference.position, &reference.velocity, &reference.acceleration)
        .map_or_else(|_| vec![0.0; samples], |motion| force_along(plant, &motion))
}

impl Separation {
    /// Of two predictions on one grid.
    fn of(one: &[f64], other: &[f64], noise: f64) -> Self {
        let mut squares: Vec<f64> = one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).collect();
        let deviations = squares.iter().sum::<f64>().sqrt() / noise;
        squares.sort_by(|a, b| b.total_cmp(a));
        squares.truncate(((squares.len() as f64 * MOST_DIFFERENT) as usize).max(1));
        let force = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
        Self { force, deviations }
    }

    fn smallest(all: Vec<Self>) -> Self {
        all.into_iter()
            .min_by(|a, b| a.deviations.total_cmp(&b.deviations))
            .unwrap_or(Self { force: 0.0, deviations: 0.0 })
    }
}
