//! The bottom of the valley that a search has found: least squares on the errors of all samples.
//!
//! [`LevenbergMarquardt`] on the scales of the search, with differences and trial steps simulated as
//! lanes of one batch. Limits only clip: holding components at them, as `aep_core::polish` does, would
//! change what every seed gives. Stick and slip make the errors rough: where a wide difference no longer leads
//! down a narrower one is taken.

use aep_core::{Batch, Domain, LeastSquares, LevenbergMarquardt, Problem, Refined};
use rayon::prelude::*;

use super::Identification;

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
/// Moves of one parameter alone that are tried, as shares of the width of the search.
const LEAPS: [f64; 3] = [2e-4, 2e-3, 1e-2];

/// How far a parameter is held aside, as shares of the width of the search.
const ASIDE: [f64; 4] = [3e-3, 8e-3, 1.8e-2, 4e-2];
/// Most valleys that are left for a lower one.
const MAX_ROUNDS: usize = 6;

impl Identification<'_> {
    /// Goes down from `x` to the nearest minimum, and out of dents beside it; never up.
    pub fn refine(&self, x: &[f64]) -> Refined {
        let mut descent = LevenbergMarquardt::new(self, x);
        let mut width = DIFFERENCE.0;
        for _ in 0..MAX_STEPS {
            if self.is_stopped() {
                break;
            }
            let before = descent.at().cost;
            descent.step(width);
            if before - descent.at().cost > WORTHWHILE * before {
                continue;
            }
            self.leap(&mut descent);
            if before - descent.at().cost > WORTHWHILE * before {
                continue;
            }
            width *= NARROWER;
            if width < DIFFERENCE.1 {
                break;
            }
        }
        descent.into_refined()
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
                from[k] = self.domain.shifted(k, from[k], by);
                self.refine_but(&from, k)
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
    pub(super) fn refine_but(&self, x: &[f64], held: usize) -> Refined {
        let mut descent = LevenbergMarquardt::new(self, x).holding(held);
        let mut width = 0.1 * DIFFERENCE.0;
        for _ in 0..FEW_STEPS {
            if self.is_stopped() {
                break;
            }
            let before = descent.at().cost;
            descent.step(width);
            let paid = before - descent.at().cost > 0.1 * before;
            if !paid {
                width *= 0.1;
            }
        }
        descent.into_refined()
    }

    /// Moves one parameter alone, near or far, to where the cost is lower, if there is such a place:
    /// out of a dent that no slope leads out of.
    fn leap(&self, descent: &mut LevenbergMarquardt<'_, Self>) {
        let at = &descent.at().position;
        let trials: Vec<Vec<f64>> = (0..at.len())
            .flat_map(|k| LEAPS.iter().flat_map(move |leap| [(k, *leap), (k, -*leap)]))
            .map(|(k, leap)| {
                let mut x = at.clone();
                x[k] = self.domain.shifted(k, x[k], leap);
                x
            })
            .collect();
        descent.take_best(&trials);
    }
}

impl LeastSquares for Identification<'_> {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        self.errors(x)
    }

    fn residuals_batch(&self, points: Batch<'_>) -> Vec<Vec<f64>> {
        let candidates: Vec<Vec<f64>> = points.rows().map(<[f64]>::to_vec).collect();
        Identification::residuals(self, &candidates)
    }

    fn objective(&self, x: &[f64]) -> f64 {
        self.evaluate(x)
    }

    fn objective_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        self.evaluate_batch(points, costs);
    }
}
