//! Models beside a force that another model gives for every sample of the recording.
//!
//! There is no mass here and nothing to simulate: the given force already holds the inertia. What is predicted is the
//! recorded force at an instant, from the motion that was measured (a known input), from the given force, and from
//! what the model missed at the instants before:
//!
//! ```text
//! r_k = L [u - D^-1(F_given + sum of effects along the measured motion)]_k     D: what the drive does (delay, lag)
//! e_k = r_k - a_1 r_k-1 - ... - a_p r_k-p                                      one step ahead
//! ```
//!
//! `L` is the low-pass of the comparison; it and the mask at rest act on both sides alike, so that a given force that
//! lacks nothing leaves nothing, whatever a smoother does at reversals. The coefficients `a` are those of
//! [`missing_physics::ahead::whitening`], as for every family that only gives residuals.

mod errors;

use std::ops::Range;

use missing_physics::ahead::whitening::Whitening;
use missing_physics::report::Refusal;
use missing_physics::statistics::basis::{gram, solve};
use missing_physics::{Fitted, ModelFamily, Term};

pub(super) use errors::View;

use super::FrictionFamily;
use crate::driven::force_along;
use crate::effects::beside::{MODEL_FORCE, ModelForce};
use crate::effects::{Effect, Signal, Slot};
use crate::model::{Model, ModelError, Timing};

/// Bandwidth of the comparison, Hz: velocities and accelerations that others make of positions are hardly known beyond;
/// and within which shares of the sampling frequency it is kept.
const BANDWIDTH: f64 = 15.0;
const SHARES: (f64, f64) = (0.01, 0.05);
/// Most samples by which the given force may be ahead of the recorded one or behind it: half a sample where a command
/// is held, a sample where it was written before it acted.
pub(super) const MOST_SHIFT: f64 = 1.5;
/// Most variance of a smoothing, in squared samples.
pub(super) const MOST_SMOOTHING: f64 = 900.0;
/// Shares below which an effect is what filters and differentiation leave: of the inertia or the whole given force, and
/// of the recorded force.
const LEAST_OF_GIVEN: f64 = 0.02;
const LEAST_OF_FORCE: f64 = 0.005;
/// What noise that moves the axis can make of effects that act with its acceleration, or on all of the force, in units of
/// the noise. The recorded acceleration holds that noise, so that a least-squares fit takes part of it for less inertia:
/// at most as much as there is.
const LEAST_OF_NOISE: f64 = 1.0;
/// Trial shifts by which the noise is judged.
const SHIFTS: i32 = 6;
/// Forces below this share of the recorded one are not looked for: no two programs agree better.
const FLOOR: f64 = 1e-3;

/// What is known of the given force.
#[derive(Clone)]
pub(super) struct Given {
    /// The force as a term of a model.
    effect: &'static dyn Effect,
    /// Inertia, Coulomb and viscous friction that it seems to have.
    pub mass: f64,
    pub level: f64,
    pub damping: f64,
    instants: Vec<(f64, usize)>,
    whitening: Whitening,
}

impl Given {
    /// The channel `model_force` of the family's recording, if it has one.
    pub fn of(family: &FrictionFamily) -> Option<Self> {
        let effect = ModelForce.bound(&family.recording)?;
        let signal = Signal::of(&family.recording, MODEL_FORCE)?;
        let p = &family.prepared;
        let mut near = 0;
        let force: Vec<f64> = p.time.iter().map(|t| signal.at(*t, &mut near)).collect();
        #[expect(
            clippy::redundant_closure_for_method_calls,
            reason = "the method is for one lifetime only"
        )]
        let sliding = family.driven(|motion| motion.sliding());
        let columns = [&p.acceleration, &sliding, &p.velocity, &vec![1.0; p.time.len()]]
            .map(|column| p.compare(column));
        let given = p.compare(&force);
        let moment: Vec<f64> =
            columns.iter().map(|c| missing_physics::statistics::basis::dot(c, &given)).collect();
        let simple = solve(&gram(&columns), &moment, &[0, 1, 2, 3]);
        Some(Self {
            effect,
            mass: simple[0].max(f64::MIN_POSITIVE),
            level: simple[1].max(0.0),
            damping: simple[2].max(0.0),
            instants: instants(family),
            whitening: Whitening::default(),
        })
    }

    /// The force that this one and `model` require together along the measured motion, sample by sample.
    pub fn required(&self, family: &FrictionFamily, model: &Model) -> Result<Vec<f64>, ModelError> {
        let Timing { shift, smoothing } = model.timing().unwrap_or_default();
        let mut plant = model.clone().with_effect(self.effect)?;
        plant.set("model-force.smoothing", smoothing)?;
        let mut force = family.driven(|motion| force_along(&plant, motion));
        if shift != 0.0 {
            let p = &family.prepared;
            for segment in &p.segments {
                advance(&mut force[segment.clone()], shift / p.interval);
            }
        }
        Ok(force)
    }

    /// What is no effect as it was fitted: smaller than what filters and differentiation make of a force that lacks
    /// nothing, or no longer than the timing of samples.
    pub fn vanishes(&self, family: &FrictionFamily, model: &Fitted) -> Option<(usize, Refusal)> {
        self.too_small(family, model).or_else(|| Self::too_short(family, model))
    }

    fn too_small(&self, family: &FrictionFamily, model: &Fitted) -> Option<(usize, Refusal)> {
        let rms = |values: &[f64]| {
            let square: f64 = values.iter().map(|value| value * value).sum();
            (square / values.len().max(1) as f64).sqrt()
        };
        let all = missing_physics::fit::predict(family, model);
        let size = rms(family.target());
        model.terms.iter().enumerate().skip(1).find_map(|(place, term)| {
            let name = family.terms[*term].name.as_str();
            let effect = family.effects[term.checked_sub(1)?];
            let values = &model.values[model.range(family, place)];
            let of_given = effect.share_of_given(values, self.mass).filter(|_| !values.is_empty());
            let of_given = of_given.unwrap_or(f64::INFINITY);
            if of_given < LEAST_OF_GIVEN {
                let (share, least) = (of_given, LEAST_OF_GIVEN);
                return Some((
                    *term,
                    Refusal::ShareOfGiven { effect: name.to_owned(), share, least },
                ));
            }
            let without = missing_physics::fit::predict(family, &model.without(family, *term));
            let change: Vec<f64> = all.iter().zip(&without).map(|(a, b)| a - b).collect();
            let change = rms(&change);
            let share = change / size;
            let slots = effect.about().slots;
            let moves = of_given.is_finite()
                || slots.contains(&Slot::Drive)
                || slots.contains(&Slot::Attached);
            let effect = name.to_owned();
            let noise = LEAST_OF_NOISE * self.whitening.budget;
            if moves && change < noise {
                let unit = family.quantity().unit;
                return Some((*term, Refusal::WithinNoise { effect, change, noise, unit }));
            }
            let least = LEAST_OF_FORCE;
            let refusal = Refusal::ShareOfQuantity { effect, share, least };
            (share < least).then_some((*term, refusal))
        })
    }

    fn too_short(family: &FrictionFamily, model: &Fitted) -> Option<(usize, Refusal)> {
        let most = MOST_SHIFT * family.prepared.interval;
        model.terms.iter().enumerate().find_map(|(place, term)| {
            let about = family.effects[term.checked_sub(1)?].about();
            if !about.acts_on(Slot::Drive) {
                return None;
            }
            let values = &model.values[model.range(family, place)];
            let parameters = family.terms[*term].parameters.iter().zip(values);
            let times: Vec<f64> =
                parameters.filter(|(p, _)| p.unit == "s").map(|(_, value)| *value).collect();
            let short = !times.is_empty() && times.iter().sum::<f64>() <= most;
            let effect = about.name.to_owned();
            short.then_some((*term, Refusal::WithinSamples { effect, samples: MOST_SHIFT }))
        })
    }
}

impl FrictionFamily {
    /// Whether a term can be told beside the given force; the timing of that force always can.
    fn shows_beside_given_force(&self, term: usize) -> bool {
        term.checked_sub(1).is_none_or(|index| self.effects[index].shows_beside_given_force())
    }

    /// Learns how the prediction errors beside the given force are to be whitened, and what noise makes of them.
    pub(super) fn weigh_given(&mut self) {
        let interval = self.prepared.interval;
        let trials = (-SHIFTS..=SHIFTS).map(|k| {
            let shift = MOST_SHIFT * interval * f64::from(k) / f64::from(SHIFTS);
            let model = self.timed(Timing { shift, smoothing: 0.0 });
            missing_physics::fit::residual(self, &missing_physics::fit::predict(self, &model))
        });
        let size =
            |residual: &Vec<f64>| missing_physics::statistics::basis::dot(residual, residual);
        let least = trials.min_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or_default();
        let (runs, colour) = (runs(self), self.prepared.colour());
        let whitening = Whitening::of(self.target(), &least, runs, &colour, FLOOR);
        if let Some(given) = &mut self.given {
            given.whitening = whitening;
        }
    }
}

/// Instants of the grid, and the piece that each belongs to.
fn instants(family: &FrictionFamily) -> Vec<(f64, usize)> {
    let p = &family.prepared;
    let piece = |k: usize| p.segments.partition_point(|segment| segment.end <= k);
    p.grid.iter().map(|k| (p.time[*k], piece(*k))).collect()
}

/// Points of the grid that follow each other without a gap.
fn runs(family: &FrictionFamily) -> Vec<Range<usize>> {
    let p = &family.prepared;
    let mut runs: Vec<Range<usize>> = Vec::new();
    for k in 0..p.grid.len() {
        match runs.last_mut() {
            Some(run) if p.grid[k] - p.grid[k - 1] == p.stride => run.end = k + 1,
            _ => runs.push(k..k + 1),
        }
    }
    runs
}

/// Bandwidth of the comparison with samples every `interval` s, Hz.
pub(super) fn bandwidth(interval: f64) -> f64 {
    BANDWIDTH.clamp(SHARES.0 / interval, SHARES.1 / interval)
}

/// Lets the amplitudes of effects that the given force has already be negative; the first of `terms` is no effect.
pub(super) fn as_deviations(terms: &mut [Term], effects: &[&dyn Effect]) {
    let overrated = terms.iter_mut().skip(1).zip(effects);
    for (term, _) in overrated.filter(|(_, effect)| effect.may_be_overrated()) {
        for parameter in &mut term.parameters {
            if parameter.role == missing_physics::Role::Amplitude {
                parameter.lower = -parameter.upper;
            }
        }
    }
}

/// Evenly sampled values `by` samples later: cubic between samples, the last value beyond the end.
fn advance(values: &mut [f64], by: f64) {
    let given = values.to_vec();
    let last = given.len() as i64 - 1;
    let (whole, part) = (by.floor() as i64, by - by.floor());
    let weights = [
        -part * (part - 1.0) * (part - 2.0) / 6.0,
        (part + 1.0) * (part - 1.0) * (part - 2.0) / 2.0,
        -(part + 1.0) * part * (part - 2.0) / 2.0,
        (part + 1.0) * part * (part - 1.0) / 6.0,
    ];
    for (k, value) in values.iter_mut().enumerate() {
        let at = |offset: i64| given[(k as i64 + whole + offset).clamp(0, last) as usize];
        *value = (0..4).map(|i| weights[i as usize] * at(i - 1)).sum();
    }
}

#[cfg(test)]
mod tests;
