//! Damped Gauss-Newton on the prediction errors, with Huber's weights.
//!
//! Differences are lanes of one batch, and so are the trial steps of several dampings.

use super::node::Node;
use super::{Ahead, scales, statistics};
use crate::basis::{dot, solve};
use crate::family::{Fitted, ModelFamily};

/// Dampings that are tried at once, as multiples of the one that led down last.
const DAMPINGS: [f64; 5] = [0.03, 0.6, 12.0, 300.0, 3e4];
/// Least damping.
const LEAST: f64 = 1e-7;
/// A fall of the loss below this share of it, or below one nat, ends a fit.
const CONVERGED: f64 = 3e-4;
/// By how much a setting must lower the error to be preferred to a smaller process noise.
const PREFERRED: f64 = 0.985;
/// Cut of squares where settings are compared.
const SETTING_CUT: f64 = 25.0;

/// Fits a model at a setting in at most `steps` steps.
pub fn fit<F: ModelFamily + ?Sized>(
    family: &F,
    ahead: &dyn Ahead,
    start: Fitted,
    setting: usize,
    steps: usize,
) -> Node {
    let mut node = evaluated(ahead, start, setting);
    let mut damping = 1e-3;
    for _ in 0..steps {
        let Some((next, fall)) = step(family, ahead, &node, &mut damping) else { break };
        node = next;
        if fall {
            break;
        }
    }
    node
}

/// A model as it is.
pub fn evaluated(ahead: &dyn Ahead, model: Fitted, setting: usize) -> Node {
    let errors = ahead.errors(&[(model.clone(), setting)]).swap_remove(0);
    Node::new(model, setting, errors)
}

/// The next node and whether the fit has converged; nothing where no damping leads down.
fn step<F: ModelFamily + ?Sized>(
    family: &F,
    ahead: &dyn Ahead,
    node: &Node,
    damping: &mut f64,
) -> Option<(Node, bool)> {
    let scale = node.weighing(ahead.expected(node.setting));
    let before = statistics::total(&node.errors, scale);
    let moved = scales::of(family, &node.model);
    let normal = Normal::of(node.jacobian(family, ahead), &node.errors, scale);
    let active: Vec<usize> =
        (0..moved.len()).filter(|&k| !moved[k].is_held(normal.moment[k])).collect();
    let tried: Vec<f64> = DAMPINGS.iter().map(|by| (by * *damping).max(LEAST)).collect();
    let trials: Vec<(Fitted, usize)> = tried
        .iter()
        .map(|damping| {
            let mut damped = normal.matrix.clone();
            for (k, row) in damped.iter_mut().enumerate() {
                row[k] += damping * (row[k] + moved[k].prior());
            }
            let by = solve(&damped, &normal.moment, &active);
            let values = moved.iter().zip(&by).map(|(moved, by)| moved.by(*by)).collect();
            (Fitted { terms: node.model.terms.clone(), values }, node.setting)
        })
        .collect();
    let errors = ahead.errors(&trials);
    let losses: Vec<f64> = errors.iter().map(|e| statistics::total(e, scale)).collect();
    let best = (0..losses.len()).min_by(|a, b| losses[*a].total_cmp(&losses[*b]))?;
    let fall = before - losses[best];
    if fall.is_nan() || fall <= 0.0 {
        return None;
    }
    *damping = tried[best];
    let (model, errors) = (trials[best].0.clone(), errors[best].clone());
    Some((Node::new(model, node.setting, errors), fall < (CONVERGED * before).max(1.0)))
}

/// Normal equations of the weighed errors in units of their scale.
pub struct Normal {
    /// The matrix.
    pub matrix: Vec<Vec<f64>>,
    /// The right side of the step that lowers the loss.
    pub moment: Vec<f64>,
}

impl Normal {
    /// From the derivatives of the errors.
    pub fn of(jacobian: &[Vec<f64>], errors: &[f64], scale: f64) -> Self {
        let weight: Vec<f64> =
            errors.iter().map(|e| statistics::weight(e / scale).sqrt() / scale).collect();
        let columns: Vec<Vec<f64>> =
            jacobian.iter().map(|c| crate::basis::weighed(c, &weight)).collect();
        let target = crate::basis::weighed(errors, &weight);
        Self {
            matrix: crate::basis::gram(&columns),
            moment: columns.iter().map(|c| -dot(c, &target)).collect(),
        }
    }
}

/// The setting of the process noise at which a model predicts best.
pub fn best_setting(ahead: &dyn Ahead, model: &Fitted) -> usize {
    let trials: Vec<(Fitted, usize)> = (0..ahead.settings()).map(|s| (model.clone(), s)).collect();
    let mut best = (0, f64::INFINITY);
    for (setting, errors) in ahead.errors(&trials).iter().enumerate() {
        let rms = statistics::rms(errors, SETTING_CUT);
        if rms < best.1 * PREFERRED {
            best = (setting, rms);
        }
    }
    best.0
}

/// The node at the setting that suits it best, refitted there.
pub fn settled<F: ModelFamily + ?Sized>(
    family: &F,
    ahead: &dyn Ahead,
    mut node: Node,
    steps: usize,
) -> Node {
    for _ in 0..2 {
        let setting = best_setting(ahead, &node.model);
        if setting == node.setting {
            break;
        }
        node = fit(family, ahead, node.model, setting, steps);
    }
    node
}
