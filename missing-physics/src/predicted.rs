//! A model with its prediction errors as a fit, for whoever asks what the errors say of its parameters together.

use aep_core::Scale;

use crate::ahead::fit::best_setting;
use crate::family::{Ahead, Fitted, ModelFamily};
use crate::fit::Fit;

/// Steps of differences: of logarithms, and in values.
const STEP: (f64, f64) = (2e-3, 1e-3);
/// Least size of a value whose share a step is, of its typical size.
const LEAST: f64 = 0.2;

/// A model at given values by its prediction errors at the setting that suits it best: residuals, and derivatives of the
/// prediction by each parameter on its own scale. It has no prediction.
pub fn prediction_fit(family: &dyn ModelFamily, ahead: &dyn Ahead, model: &Fitted) -> Fit {
    let setting = best_setting(ahead, model);
    let moved = |sign: f64| {
        model.parameters(family).enumerate().map(move |(k, (_, parameter))| {
            let mut near = model.clone();
            let value = near.values[k];
            near.values[k] = match parameter.scale {
                Scale::Log => value * (sign * STEP.0).exp(),
                Scale::Linear => {
                    value + sign * STEP.1 * value.abs().max(LEAST * parameter.start.abs())
                }
            };
            (near, setting)
        })
    };
    let all: Vec<(Fitted, usize)> =
        std::iter::once((model.clone(), setting)).chain(moved(1.0)).chain(moved(-1.0)).collect();
    let mut errors = ahead.errors(&all);
    let count = model.values.len();
    let lower = errors.split_off(1 + count);
    let upper = errors.split_off(1);
    let residual = errors.swap_remove(0);
    let jacobian = model.parameters(family).enumerate().map(|(k, (_, parameter))| {
        let width = match parameter.scale {
            Scale::Log => 2.0 * STEP.0,
            Scale::Linear => all[1 + k].0.values[k] - all[1 + count + k].0.values[k],
        };
        upper[k].iter().zip(&lower[k]).map(|(above, below)| (below - above) / width).collect()
    });
    let jacobian = jacobian.collect();
    Fit { model: model.clone(), prediction: Vec::new(), residual, jacobian, cost: 0.0 }
}
