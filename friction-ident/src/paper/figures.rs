//! What figures 8 and 12 show.

use aep_core::trials::{Plan, Trials};
use aep_core::{Aep, Budget, Method};
use rayon::prelude::*;

use super::PARAMETERS;
use crate::driven::{MeasuredMotion, MotionError, force_along};
use crate::identify::{Identification, IdentifyError, Refined};
use crate::model::Model;

/// Generations of the paper's identification.
pub const GENERATIONS: u64 = 250;
/// Individuals and generations of the search that [`refined`] begins with.
pub const SEARCH: (usize, u64) = (60, 200);

/// Way after which a contact slides, m.
const FAR: f64 = 1e-4;

/// Friction force (N) of `table` that slides steadily at each velocity (m/s).
///
/// # Errors
/// None: the motions are made here.
pub fn steady_friction(table: &Model, velocity: &[f64]) -> Result<Vec<f64>, MotionError> {
    let at = |v: &f64| {
        // Long enough for the memory, and far enough for the contact to slide.
        let long = (FAR / v.abs().max(f64::MIN_POSITIVE)).clamp(1.0, 1e9);
        let time = [0.0, long, 2.0 * long];
        let (position, velocity) = (time.map(|t| v * t), [*v; 3]);
        let motion = MeasuredMotion::new(&time, &position, &velocity, &[0.0; 3])?;
        Ok(force_along(table, &motion)[2])
    };
    velocity.iter().map(at).collect()
}

/// `trials` identifications as in the paper: `method` for [`GENERATIONS`] generations.
///
/// # Errors
/// The method does not fit the task.
pub fn trials(
    task: &Identification<'_>,
    method: &dyn Method,
    trials: usize,
    seed: u64,
) -> Result<Trials, IdentifyError> {
    let plan = Plan::new(trials, Budget::generations(GENERATIONS)).with_seed(seed);
    Ok(plan.run(method, |_| task)?)
}

/// `trials` identifications as they are done today: AEP finds the valley, least squares its bottom
/// and the valleys beside it.
///
/// # Errors
/// None: the method fits every task.
pub fn refined(
    task: &Identification<'_>,
    trials: usize,
    seed: u64,
) -> Result<Vec<Refined>, IdentifyError> {
    let (population, generations) = SEARCH;
    let plan = Plan::new(trials, Budget::generations(generations)).with_seed(seed);
    let found = plan.run(&Aep::practical().with_population(population), |_| task)?;
    Ok(found.trials.par_iter().map(|trial| task.refine_around(&trial.position)).collect())
}

/// Whether a set of parameters is the table's, as far as they can be known: all that have a tolerance
/// are within it.
pub fn is_found(position: &[f64]) -> bool {
    PARAMETERS.iter().zip(position).all(|(parameter, value)| parameter.accepts(*value))
}
