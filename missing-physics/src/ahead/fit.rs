//! Damped Gauss-Newton on the prediction errors, with Huber's weights.
//!
//! Differences are lanes of one batch, and so are the trial steps of several dampings.

use super::node::Node;
use super::{Ahead, scales, statistics};
use crate::family::{Fitted, ModelFamily};
use crate::statistics::basis::{dot, solve};

/// Dampings that are tried at once, as multiples of the one that led down last.
const DAMPINGS: [f64; 5] = [0.03, 0.6, 12.0, 300.0, 3e4];
/// Least damping.
const LEAST: f64 = 1e-7;
/// A fall of the loss below this share of it, or below one nat, ends a fit.
const CONVERGED: f64 = 3e-4;
/// By how much a setting must lower the error to be preferred to a smaller process noise.
const PREFERRED: f64 = 0.985;
/// How far a fitted model looks for a better setting at once: on its own ladder, and on the other one.
const REACH: (usize, usize) = (2, 1);
/// Most times that it moves on.
const MOVES: usize = 3;
/// Cut of squares where settings are compared.
const SETTING_CUT: f64 = 25.0;

/// Fits models of a family to one recording, as long as nobody asks it to stop.
#[derive(Clone, Copy)]
pub struct Fitter<'a> {
    family: &'a dyn ModelFamily,
    ahead: &'a dyn Ahead,
    stop: &'a (dyn Fn() -> bool + Sync),
    held: bool,
}

impl<'a> Fitter<'a> {
    /// One that nothing stops.
    pub fn new(family: &'a dyn ModelFamily, ahead: &'a dyn Ahead) -> Self {
        Self { family, ahead, stop: &|| false, held: false }
    }

    /// The family that its models are of.
    pub fn family(&self) -> &'a dyn ModelFamily {
        self.family
    }

    /// One that goes no further once `stop` says so.
    #[must_use]
    pub fn stopped_by(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop, ..self }
    }

    /// One that leaves what every model has where it is.
    #[must_use]
    pub fn holding(self) -> Self {
        Self { held: true, ..self }
    }

    /// Fits a model at a setting in at most `steps` steps.
    pub fn fit(&self, start: Fitted, setting: usize, steps: usize) -> Node {
        let mut node = evaluated(self.ahead, start, setting).holding(self.held);
        let mut damping = 1e-3;
        for _ in 0..steps {
            if (self.stop)() {
                break;
            }
            let Some((next, fall)) = step(self.family, self.ahead, &node, &mut damping) else {
                break;
            };
            node = next;
            if fall {
                break;
            }
        }
        node
    }

    /// The node at the setting that suits it best, refitted there.
    pub fn settled(&self, mut node: Node, steps: usize) -> Node {
        for _ in 0..MOVES {
            if (self.stop)() {
                break;
            }
            let setting = better_setting(self.ahead, &node);
            if setting == node.setting {
                break;
            }
            node = self.fit(node.model, setting, steps);
        }
        node
    }

    /// A fit that ends at the setting that suits it best.
    pub fn refit(&self, start: Fitted, setting: usize, steps: usize) -> Node {
        self.settled(self.fit(start, setting, steps), steps)
    }
}

/// A model as it is.
pub fn evaluated(ahead: &dyn Ahead, model: Fitted, setting: usize) -> Node {
    let errors = ahead.errors(&[(model.clone(), setting)]).swap_remove(0);
    Node::new(ahead, model, setting, errors)
}

/// The next node and whether the fit has converged; nothing where no damping leads down.
fn step(
    family: &dyn ModelFamily,
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
    let next = Node::new(ahead, model, node.setting, errors).holding(node.is_held());
    Some((next, fall < (CONVERGED * before).max(1.0)))
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
            jacobian.iter().map(|c| crate::statistics::basis::weighed(c, &weight)).collect();
        let target = crate::statistics::basis::weighed(errors, &weight);
        Self {
            matrix: crate::statistics::basis::gram(&columns),
            moment: columns.iter().map(|c| -dot(c, &target)).collect(),
        }
    }
}

/// The setting of the process noise at which a model predicts best.
pub fn best_setting(ahead: &dyn Ahead, model: &Fitted) -> usize {
    best_of(ahead, model, &(0..ahead.settings()).collect::<Vec<_>>())
}

/// The best setting among those near to a node's own, on either ladder.
fn better_setting(ahead: &dyn Ahead, node: &Node) -> usize {
    let rungs = (ahead.settings() / 2).max(1);
    let (ladder, rung) = (node.setting / rungs, node.setting % rungs);
    let near = |setting: &usize| {
        let reach = if setting / rungs == ladder { REACH.0 } else { REACH.1 };
        (setting % rungs).abs_diff(rung) <= reach
    };
    best_of(ahead, &node.model, &(0..ahead.settings()).filter(near).collect::<Vec<_>>())
}

/// The first of `settings` that no later one betters clearly.
fn best_of(ahead: &dyn Ahead, model: &Fitted, settings: &[usize]) -> usize {
    let trials: Vec<(Fitted, usize)> = settings.iter().map(|s| (model.clone(), *s)).collect();
    let mut best = (0, f64::INFINITY);
    for (setting, errors) in settings.iter().zip(ahead.errors(&trials)) {
        let rms = statistics::rms(&errors, SETTING_CUT);
        if rms < best.1 * PREFERRED {
            best = (*setting, rms);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::testing::{NOISE, Plant, SAMPLES, TONE, TONES, WAVE};

    #[test]
    fn what_is_held_stays_and_all_else_is_fitted() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let far = Fitted { terms: vec![0, WAVE], values: vec![0.9, -2.0] };
        let node = Fitter::new(&plant, &plant).holding().refit(far.clone(), 0, 10);
        assert!(node.is_held() && node.model.values[0] == 0.9);
        assert!(node.jacobian(&plant, &plant)[0].iter().all(|change| *change == 0.0));
        assert!((node.model.values[1] - 0.05).abs() < 0.1, "{:?}", node.model);
        let free = Fitter::new(&plant, &plant).refit(far, 0, 10);
        assert!(!free.is_held() && (free.model.values[0] - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_fit_of_a_linear_model_ends_at_its_least_squares() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let far = Fitted { terms: vec![0, WAVE], values: vec![0.4, -2.0] };
        let node = Fitter::new(&plant, &plant).fit(far, 0, 10);
        // One exact step from anywhere, as the errors are linear.
        let unit = |k: usize| {
            let mut model = node.model.clone();
            model.values[k] += 1.0;
            let moved = plant.errors(&[(model, 0)]).swap_remove(0);
            moved.iter().zip(&node.errors).map(|(e, old)| e - old).collect::<Vec<f64>>()
        };
        let columns = [unit(0), unit(1)];
        let matrix = crate::statistics::basis::gram(&columns);
        let moment: Vec<f64> = columns.iter().map(|c| -dot(c, &node.errors)).collect();
        for (k, step) in solve(&matrix, &moment, &[0, 1]).iter().enumerate() {
            let deviation = NOISE / matrix[k][k].sqrt();
            assert!(step.abs() < 0.1 * deviation, "{k}: {step:e} {deviation:e}");
        }
        assert!((node.scale / NOISE - 1.0).abs() < 0.06, "{}", node.scale);
    }

    #[test]
    fn a_few_wild_samples_hardly_move_a_fit() {
        let mut plant = Plant::new(2, &[(WAVE, &[0.05])]);
        let size = |plant: &Plant| {
            let node = Fitter::new(plant, plant).fit(Plant::model(&[(WAVE, &[0.0])]), 0, 10);
            node.model.values[1]
        };
        let clean = size(&plant);
        (0..SAMPLES).step_by(200).for_each(|k| plant.disturb(k, 100.0 * NOISE));
        // Least squares would be off by several times that.
        assert!((size(&plant) / clean - 1.0).abs() < 0.03, "{clean} {}", size(&plant));
    }

    #[test]
    fn a_model_that_lacks_nothing_is_judged_without_process_noise_and_another_with_some() {
        let plant = Plant::new(3, &[(WAVE, &[0.1])]);
        assert_eq!(best_setting(&plant, &Plant::model(&[(WAVE, &[0.1])])), 0);
        let lacking = evaluated(&plant, Plant::model(&[]), 0);
        let settled = Fitter::new(&plant, &plant).settled(lacking.clone(), 6);
        assert!(settled.setting > 0 && settled.scale < 0.9 * lacking.scale);
    }

    #[test]
    fn a_frequency_is_found_from_beside_and_one_out_of_reach_stops_at_the_limit() {
        for (truth, limit) in [(5.0, false), (1.004 * TONES.1, true)] {
            let plant = Plant::new(4, &[(TONE, &[0.05, truth])]);
            let start = Plant::model(&[(TONE, &[0.03, 0.995 * truth.min(TONES.1)])]);
            let node = Fitter::new(&plant, &plant).fit(start, 2, 20);
            let moved = scales::of(&plant, &node.model);
            assert_eq!(moved[2].is_at_far_limit(), limit, "{:?}", node.model);
            let expected = truth.min(TONES.1);
            assert!((node.model.values[2] / expected - 1.0).abs() < 2e-3, "{:?}", node.model);
        }
    }
}
