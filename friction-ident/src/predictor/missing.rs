//! The force that a model lacks, over time.
//!
//! Beside the model acts a force that wanders at random. What it does to the distance between the true state and the
//! predicted one is linear: a mass with damping, moved back by every correction of the predictor, which is known.
//! A Kalman filter over that distance and the force, with the prediction errors as measurements, and a smoother behind
//! it tell the force that would have to be added so that the model follows, and how well it is known.

mod smoother;

use std::ops::Range;

use missing_physics::ahead::node::CUT;
use missing_physics::ahead::statistics::{loss, rms};
use missing_physics::family::Series;
use rayon::prelude::*;

use super::Predictor;
use super::gain::Motion;
use crate::model::Model;
use smoother::{Moments, Step, Transition};

/// The ladder of the force's wandering: its smallest variance gained per second as a share of the recorded force's mean
/// square, the factor from rung to rung, and the number of rungs.
const LEAST: f64 = 1e-6;
const FACTOR: f64 = 10.0;
const RUNGS: i32 = 12;
/// A force is known where the data leave at most this share of the variance that it had before them.
const KNOWN: f64 = 0.01;

/// What the predictor did at a sample.
#[derive(Clone, Copy, Debug, Default)]
struct Past {
    error: f64,
    fed: (f64, f64),
    rests: bool,
}

/// A recording as a model passed it, and a force beside it.
struct Beside<'a> {
    predictor: &'a Predictor,
    past: Vec<Past>,
    /// Variance of the force before anything is measured: the mean square of the recorded one.
    prior: f64,
}

impl Predictor {
    /// The force that `model` lacks, by what it errs at a setting; nothing where it runs away.
    ///
    /// The setting to take is the one at which the model predicts best. Below it the predicted state strays so far from
    /// the true one that friction acts in another direction, above it the noise of the sensor turns it around.
    pub fn missing_force(&self, model: &Model, setting: usize) -> Option<Series> {
        let mut past = vec![Past::default(); self.time.len()];
        self.follow(&[(model.clone(), setting)], |n, step| {
            let rests = step.velocity[0].abs() < self.rest_speed;
            past[n] = Past { error: step.error[0], fed: (step.dx[0], step.dv[0]), rests };
        })
        .ok()?;
        let prior = self.force.iter().map(|f| f * f).sum::<f64>() / self.force.len() as f64;
        let beside = Beside { predictor: self, past, prior };
        let rungs: Vec<(f64, f64)> = (0..RUNGS)
            .into_par_iter()
            .map(|k| prior * LEAST * FACTOR.powi(k))
            .map(|wandering| (beside.misfit(wandering), wandering))
            .collect();
        let (misfit, wandering) = rungs.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
        misfit.is_finite().then(|| beside.smoothed(wandering))
    }
}

impl Beside<'_> {
    /// Negative log-likelihood of the errors that count, but for a constant; the force gains the variance `wandering`
    /// per second.
    fn misfit(&self, wandering: f64) -> f64 {
        let of = |(surprise, variance): (f64, f64)| {
            loss(surprise / variance.sqrt()) + 0.5 * variance.ln()
        };
        self.surprises(wandering).into_iter().map(of).sum()
    }

    /// What the errors that count say beyond those before them, and its variances.
    fn surprises(&self, wandering: f64) -> Vec<(f64, f64)> {
        let mut counted = self.predictor.counted.iter().peekable();
        let mut surprises = Vec::with_capacity(counted.len());
        for segment in &self.predictor.segments {
            self.filter(segment, wandering, |k, step| {
                if counted.next_if_eq(&&k).is_some() {
                    surprises.extend(step.surprise);
                }
            });
        }
        surprises
    }

    fn smoothed(&self, wandering: f64) -> Series {
        let mut told = Series::default();
        // Where the errors are larger than even the best rung says, so is the band.
        let ratios: Vec<f64> = self
            .surprises(wandering)
            .into_iter()
            .map(|(s, variance)| s / variance.sqrt())
            .collect();
        let wider = rms(&ratios, CUT).max(1.0);
        for segment in &self.predictor.segments {
            let mut steps = Vec::with_capacity(segment.len());
            self.filter(segment, wandering, |_, step| steps.push(*step));
            let settled = self.predictor.settled(segment);
            for (k, (force, variance)) in (segment.start + 1..).zip(smoother::forces(&steps)) {
                if !settled.contains(&k) {
                    continue;
                }
                // While the model rests, any force up to the friction level would leave it there.
                let known = !self.past[k].rests && variance <= KNOWN * self.prior;
                told.time.push(self.predictor.time[k]);
                told.force.push(if known { force } else { 0.0 });
                told.deviation.push(if known {
                    wider * variance.sqrt()
                } else {
                    self.prior.sqrt()
                });
                told.recorded.push(self.predictor.force[k - 1]);
                told.known.push(known);
            }
        }
        told
    }

    /// Passes a piece; tells every sample and what the ones before say of it.
    fn filter(&self, segment: &Range<usize>, wandering: f64, mut see: impl FnMut(usize, &Step)) {
        let noise = self.predictor.noise.position.powi(2);
        let mut at = self.unknown(segment.start);
        for k in segment.start + 1..segment.end {
            let transition = self.transition(k, wandering);
            at = at.predicted(&transition);
            let past = &self.past[k];
            let measured = !self.predictor.stale[k] && past.error.is_finite();
            let surprise = measured.then(|| at.surprise(past.error, noise));
            see(k, &Step { transition, predicted: at, surprise });
            if let Some((surprise, variance)) = surprise {
                at = at.updated(surprise, variance);
            }
            at = at.moved(past.fed);
        }
    }

    /// What is known where a piece starts: the position alone.
    fn unknown(&self, k: usize) -> Moments {
        let noise = self.predictor.noise.position;
        let first = self.interval_before(k + 1);
        let speed = if first > 0.0 { 10.0 * noise / first } else { 0.0 };
        Moments::independent([noise * noise, speed * speed, self.prior])
    }

    fn interval_before(&self, k: usize) -> f64 {
        let at = |k: usize| self.predictor.time.get(k).copied().unwrap_or(0.0);
        (at(k) - at(k.saturating_sub(1))).max(0.0)
    }

    /// From the sample before `k` to `k`.
    fn transition(&self, k: usize, wandering: f64) -> Transition {
        let (p, t) = (self.predictor, self.interval_before(k));
        if self.past[k].rests {
            // The true axis may move while the model rests: as fast as it is seen to.
            let speed = p.speed_around(k).hypot(p.rest_speed);
            return Transition::at_rest(t, speed, self.prior);
        }
        Transition::moving(&Motion::over(t, p.plant), wandering * t, p.noise.force.powi(2))
    }
}

#[cfg(test)]
mod tests;
