//! The simulator against closed forms, energy balance, step halving, and random plants.

mod closed_forms;
mod convergence;
mod random_plants;
mod two_masses;

use missing_physics::Hold;

use super::*;
use crate::axis::Axis;
use crate::model::Model;

/// A plant of `mass` with effects and parameters.
fn plant(mass: f64, effects: &[(&str, &[(&str, f64)])]) -> Model {
    effects.iter().fold(Model::new(Axis::Linear, mass).unwrap(), |model, (effect, values)| {
        model.with(effect, values).unwrap()
    })
}

/// Times from 0 with `step` s between them.
fn times(samples: usize, step: f64) -> Vec<f64> {
    (0..samples).map(|k| k as f64 * step).collect()
}

/// Simulates under `force` of time, held between samples.
fn run(model: &Model, time: &[f64], start: Start, force: impl Fn(f64) -> f64) -> Trajectory {
    let force: Vec<f64> = time.iter().map(|t| force(*t)).collect();
    simulate(model, &Input::new(time, &force, Hold::ZeroOrder), &start).unwrap()
}
