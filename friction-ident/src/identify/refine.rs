//! The bottom of the valley that a search has found: least squares on the errors of all samples.
//!
//! Levenberg-Marquardt on the scales of the search, with differences and trial steps simulated as
//! lanes of one batch. Stick and slip make the errors rough: where a wide difference no longer leads
//! down a narrower one is taken.

use aep_core::{Batch, Problem};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::{Free, Identification};
use crate::effects::Scale;

/// Most steps.
const MAX_STEPS: usize = 60;
/// Steps of a refit around a parameter that is held.
const FEW_STEPS: usize = 8;
/// First and last half-width of a difference, as a share of the width of the search.
const DIFFERENCE: (f64, f64) = (2e-2, 1e-6);
/// By how much a difference narrows where it no longer leads down.
const NARROWER: f64 = 0.3;
/// Relative fall of the cost that counts as leading down.
const WORTHWHILE: f64 = 1e-3;
/// Dampings that are tried at once, as multiples of the last one that led down.
const DAMPINGS: [f64; 8] = [1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e4, 1e6];
/// Least damping: below it nothing changes.
const LEAST_DAMPING: f64 = 1e-9;

/// Moves of one parameter alone that are tried, as shares of the width of the search.
const LEAPS: [f64; 3] = [2e-4, 2e-3, 1e-2];

/// How far a parameter is held aside, as shares of the width of the search.
const ASIDE: [f64; 4] = [3e-3, 8e-3, 1.8e-2, 4e-2];
/// Most valleys that are left for a lower one.
const MAX_ROUNDS: usize = 6;

/// A point and its cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// Values of the free parameters.
    pub position: Vec<f64>,
    /// Their cost.
    pub cost: f64,
}

impl Identification<'_> {
    /// Goes down from `x` to the nearest minimum, and out of dents beside it; never up.
    pub fn refine(&self, x: &[f64]) -> Refined {
        let active: Vec<usize> = (0..x.len()).collect();
        let mut at = Refined { position: x.to_vec(), cost: self.evaluate(x) };
        let (mut width, mut damping) = (DIFFERENCE.0, 1e-3);
        for _ in 0..MAX_STEPS {
            if self.is_stopped() {
                break;
            }
            let before = at.cost;
            self.step(&mut at, &active, width, &mut damping);
            if before - at.cost > WORTHWHILE * before {
                continue;
            }
            self.leap(&mut at, &active);
            if before - at.cost > WORTHWHILE * before {
                continue;
            }
            width *= NARROWER;
            if width < DIFFERENCE.1 {
                break;
            }
        }
        at
    }

    /// Looks for a lower valley beside that of `x`: each parameter in turn is held aside, near or far,
    /// while all others are fitted anew; from the best of these places it goes down again.
    pub fn refine_around(&self, x: &[f64]) -> Refined {
        let mut at = self.refine(x);
        for _ in 0..MAX_ROUNDS {
            if self.is_stopped() {
                break;
            }
            let places: Vec<(usize, f64)> = (0..x.len())
                .flat_map(|k| ASIDE.iter().flat_map(move |by| [(k, *by), (k, -*by)]))
                .collect();
            let beside = places.into_par_iter().map(|(k, by)| {
                let mut from = at.position.clone();
                from[k] = self.free[k].moved(from[k], by);
                self.refine_but(&from, Some(k))
            });
            let beside: Vec<Refined> = beside.collect();
            let Some(best) = beside.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost)) else {
                break;
            };
            let lower = best.cost < (1.0 - WORTHWHILE) * at.cost;
            if !lower {
                break;
            }
            at = self.refine(&best.position);
        }
        at
    }

    /// Goes down from `x` with parameter `held` where it is: a few steps, without leaps.
    pub(super) fn refine_but(&self, x: &[f64], held: Option<usize>) -> Refined {
        let active: Vec<usize> = (0..x.len()).filter(|k| Some(*k) != held).collect();
        let mut at = Refined { position: x.to_vec(), cost: self.evaluate(x) };
        let (mut width, mut damping) = (0.1 * DIFFERENCE.0, 1e-3);
        for _ in 0..FEW_STEPS {
            if self.is_stopped() {
                break;
            }
            let before = at.cost;
            self.step(&mut at, &active, width, &mut damping);
            let paid = before - at.cost > 0.1 * before;
            if !paid {
                width *= 0.1;
            }
        }
        at
    }

    /// One step down, if there is one.
    fn step(&self, at: &mut Refined, active: &[usize], width: f64, damping: &mut f64) {
        let Some((normal, moment)) = self.normal(&at.position, active, width) else { return };
        let tried: Vec<f64> =
            DAMPINGS.iter().map(|by| (by * *damping).max(LEAST_DAMPING)).collect();
        let trials: Vec<Vec<f64>> = tried
            .iter()
            .filter_map(|damping| self.moved(at, active, &normal, &moment, *damping))
            .collect();
        let mut costs = vec![f64::INFINITY; trials.len()];
        self.evaluate_batch(Batch::new(at.position.len(), &trials.concat()), &mut costs);
        let best = (0..trials.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        if let Some(best) = best.filter(|best| costs[*best] < at.cost) {
            *at = Refined { position: trials[best].clone(), cost: costs[best] };
            *damping = tried[best];
        }
    }

    /// Moves one parameter alone, near or far, to where the cost is lower, if there is such a place:
    /// out of a dent that no slope leads out of.
    fn leap(&self, at: &mut Refined, active: &[usize]) {
        let trials: Vec<Vec<f64>> = active
            .iter()
            .flat_map(|k| LEAPS.iter().flat_map(move |leap| [(*k, *leap), (*k, -*leap)]))
            .map(|(k, leap)| {
                let mut x = at.position.clone();
                x[k] = self.free[k].moved(x[k], leap);
                x
            })
            .collect();
        let mut costs = vec![f64::INFINITY; trials.len()];
        self.evaluate_batch(Batch::new(at.position.len(), &trials.concat()), &mut costs);
        let best = (0..trials.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]));
        if let Some(best) = best.filter(|best| costs[*best] < at.cost) {
            *at = Refined { position: trials[best].clone(), cost: costs[best] };
        }
    }

    /// Normal matrix and moment of the errors, in shares of the widths.
    fn normal(
        &self,
        x: &[f64],
        active: &[usize],
        width: f64,
    ) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let mut candidates = vec![x.to_vec()];
        for k in active {
            for sign in [1.0, -1.0] {
                let mut candidate = x.to_vec();
                candidate[*k] = self.free[*k].moved(x[*k], sign * width);
                candidates.push(candidate);
            }
        }
        let errors = self.residuals(&candidates);
        // A difference that a bound has cut short is as wide as it is.
        let widths: Vec<f64> = (0..active.len())
            .map(|j| {
                let free = &self.free[active[j]];
                free.share(candidates[2 * j + 1][active[j]])
                    - free.share(candidates[2 * j + 2][active[j]])
            })
            .collect();
        let samples = errors[0].len();
        let slopes = DMatrix::from_fn(samples, active.len(), |i, j| {
            let change = errors[2 * j + 1][i] - errors[2 * j + 2][i];
            if change.is_finite() && widths[j] > 0.0 { change / widths[j] } else { 0.0 }
        });
        let errors = DVector::from_column_slice(&errors[0]);
        let finite = errors.iter().all(|error| error.is_finite());
        finite.then(|| (slopes.tr_mul(&slopes), -slopes.tr_mul(&errors)))
    }

    fn moved(
        &self,
        at: &Refined,
        active: &[usize],
        normal: &DMatrix<f64>,
        moment: &DVector<f64>,
        damping: f64,
    ) -> Option<Vec<f64>> {
        let largest = normal.diagonal().max();
        let mut damped = normal.clone();
        for k in 0..active.len() {
            damped[(k, k)] *= 1.0 + damping;
            damped[(k, k)] += 1e-15 * largest + f64::MIN_POSITIVE;
        }
        let change = damped.cholesky()?.solve(moment);
        let mut x = at.position.clone();
        for (k, change) in active.iter().zip(change.iter()) {
            x[*k] = self.free[*k].moved(x[*k], change.clamp(-0.5, 0.5));
        }
        Some(x)
    }
}

impl Free {
    /// `value` moved by a `share` of the width of the search, on the search's scale, within bounds.
    pub(super) fn moved(&self, value: f64, share: f64) -> f64 {
        let moved = match self.scale {
            Scale::Linear => value + share * (self.high - self.low),
            Scale::Log => value * (self.high / self.low).powf(share),
        };
        moved.clamp(self.low, self.high)
    }

    /// Where `value` lies between the bounds: 0 at the lower, 1 at the upper one.
    pub(super) fn share(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log => (value / self.low).ln() / (self.high / self.low).ln(),
        }
    }
}
