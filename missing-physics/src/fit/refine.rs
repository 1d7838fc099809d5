//! Least-squares refinement of all parameters of a model within their bounds.
//!
//! Levenberg-Marquardt on the weighted residual with a finite-difference Jacobian. Parameters on a
//! logarithmic scale move by their logarithm; one that sits on a bound and is pushed outwards is
//! frozen for the step. The search that finds the right valley is [`crate::fit`]'s work.

use aep_core::Scale;
use rayon::prelude::*;

use crate::family::{Fitted, ModelFamily, TermParameter};
use crate::statistics::basis::{dot, gram, solve, weighed};

const MAX_STEPS: usize = 25;
/// Relative fall of the cost below which the fit has converged.
const CONVERGED: f64 = 1e-7;
/// Pull towards the start, relative to the curvature of each parameter: what the data do not
/// determine (an offset against a direction-dependent level) stays where it was, what they do is
/// not noticeably moved.
const ANCHOR: f64 = 1e-6;
/// Step of the finite differences, relative to the size of a parameter.
const DIFFERENCE: f64 = 1e-4;

/// A fitted model with all that its local analysis needs.
#[derive(Clone, Debug)]
pub struct Fit {
    /// Terms and values.
    pub model: Fitted,
    /// Prediction on the whole grid.
    pub prediction: Vec<f64>,
    /// Target minus prediction on the whole grid.
    pub residual: Vec<f64>,
    /// Derivative of the prediction with respect to each parameter (its logarithm on a logarithmic
    /// scale) on the whole grid.
    pub jacobian: Vec<Vec<f64>>,
    /// Sum of the squared weighted residuals.
    pub cost: f64,
}

/// Target minus prediction.
pub fn residual(family: &dyn ModelFamily, prediction: &[f64]) -> Vec<f64> {
    family.target().iter().zip(prediction).map(|(target, value)| target - value).collect()
}

/// Sum of the squares of `values`, each times its weight.
pub fn weighted_square(values: &[f64], weights: &[f64]) -> f64 {
    values.iter().zip(weights).map(|(value, weight)| (value * weight).powi(2)).sum()
}

/// The prediction of `model` on the whole grid.
pub fn predict(family: &dyn ModelFamily, model: &Fitted) -> Vec<f64> {
    let mut prediction = vec![0.0; family.target().len()];
    family.predict(model, &mut prediction);
    prediction
}

/// Refines `start` on the grid points with a weight; `weights` multiplies the residual.
pub fn refine(family: &dyn ModelFamily, start: Fitted, weights: &[f64]) -> Fit {
    let anchor = start.values.clone();
    let mut fit = evaluate(family, start, weights);
    let mut damping = 1e-8;
    for _ in 0..MAX_STEPS {
        let before = fit.cost;
        let Some(better) = step(family, &fit, weights, &anchor, &mut damping) else { break };
        fit = better;
        if before - fit.cost <= CONVERGED * before {
            break;
        }
    }
    fit
}

/// Prediction, residual, Jacobian and cost of `model` as it is.
pub fn evaluate(family: &dyn ModelFamily, model: Fitted, weights: &[f64]) -> Fit {
    let prediction = predict(family, &model);
    let residual = residual(family, &prediction);
    let cost = weighted_square(&residual, weights);
    let jacobian = jacobian(family, &model, &prediction);
    Fit { model, prediction, residual, jacobian, cost }
}

/// A model at given values, evaluated on the whole grid.
pub fn as_given(family: &dyn ModelFamily, model: Fitted) -> Fit {
    let weights = vec![1.0; family.target().len()];
    evaluate(family, model, &weights)
}

/// One accepted step, or nothing where no damping makes the cost fall.
fn step(
    family: &dyn ModelFamily,
    fit: &Fit,
    weights: &[f64],
    anchor: &[f64],
    damping: &mut f64,
) -> Option<Fit> {
    let parameters: Vec<&TermParameter> = fit.model.parameters(family).map(|(_, p)| p).collect();
    let weigh = |column: &[f64]| weighed(column, weights);
    let columns: Vec<Vec<f64>> = fit.jacobian.iter().map(|column| weigh(column)).collect();
    let target = weigh(&fit.residual);
    let mut moment: Vec<f64> = columns.iter().map(|column| dot(column, &target)).collect();
    let mut normal = gram(&columns);
    for (k, parameter) in parameters.iter().enumerate() {
        let pull = ANCHOR * normal[k][k];
        moment[k] -= pull * away(parameter, fit.model.values[k], anchor[k]);
        normal[k][k] += pull;
    }
    let active: Vec<usize> = (0..parameters.len())
        .filter(|&k| !pushed_out(parameters[k], fit.model.values[k], moment[k]))
        .collect();
    while *damping < 1e8 {
        let mut damped = normal.clone();
        (0..damped.len()).for_each(|k| damped[k][k] *= 1.0 + *damping);
        let move_by = solve(&damped, &moment, &active);
        let values: Vec<f64> = fit
            .model
            .values
            .iter()
            .enumerate()
            .map(|(k, value)| moved(parameters[k], *value, move_by[k]))
            .collect();
        let trial = Fitted { terms: fit.model.terms.clone(), values };
        let prediction = predict(family, &trial);
        let cost = weighted_square(&residual(family, &prediction), weights);
        if cost < fit.cost {
            *damping = (*damping * 0.1).max(1e-12);
            return Some(evaluate(family, trial, weights));
        }
        *damping *= 10.0;
    }
    None
}

/// How far a value is from `anchor`, on the parameter's own scale.
fn away(parameter: &TermParameter, value: f64, anchor: f64) -> f64 {
    match parameter.scale {
        Scale::Linear => value - anchor,
        Scale::Log => (value / anchor).ln(),
    }
}

fn pushed_out(parameter: &TermParameter, value: f64, moment: f64) -> bool {
    (value <= parameter.lower && moment < 0.0) || (value >= parameter.upper && moment > 0.0)
}

/// A value after a step on its own scale, kept within bounds. A step on a logarithmic scale is at
/// most a factor of three: farther away the linearisation says nothing.
fn moved(parameter: &TermParameter, value: f64, step: f64) -> f64 {
    let new = match parameter.scale {
        Scale::Linear => value + step,
        Scale::Log => value * step.clamp(-1.1, 1.1).exp(),
    };
    new.clamp(parameter.lower, parameter.upper)
}

fn jacobian(family: &dyn ModelFamily, model: &Fitted, prediction: &[f64]) -> Vec<Vec<f64>> {
    let parameters: Vec<&TermParameter> = model.parameters(family).map(|(_, p)| p).collect();
    (0..parameters.len())
        .into_par_iter()
        .map(|k| {
            let (values, step) = perturbed(parameters[k], &model.values, k);
            let mut column = predict(family, &Fitted { terms: model.terms.clone(), values });
            column.iter_mut().zip(prediction).for_each(|(new, old)| *new = (*new - old) / step);
            column
        })
        .collect()
}

/// The values with the k-th one moved inwards from the nearer bound, and the step on its scale.
fn perturbed(parameter: &TermParameter, values: &[f64], k: usize) -> (Vec<f64>, f64) {
    let mut moved = values.to_vec();
    let step = match parameter.scale {
        Scale::Log => {
            let factor: f64 = DIFFERENCE.exp();
            let up = values[k] * factor <= parameter.upper;
            moved[k] = if up { values[k] * factor } else { values[k] / factor };
            if up { DIFFERENCE } else { -DIFFERENCE }
        }
        Scale::Linear => {
            let size = values[k].abs().max(parameter.start.abs()).max(1e-12) * DIFFERENCE;
            let up = values[k] + size <= parameter.upper;
            moved[k] += if up { size } else { -size };
            moved[k] - values[k]
        }
    };
    (moved, step)
}
