//! Optimizers of other crates, ready to be run in a box.

use std::ops::RangeInclusive;

use aep_core::{Domain, Start};
use cmaes::DVector;
use cmaes::restart::{BIPOP, RestartOptions, RestartStrategy};
use fcmaes_core::{Cmaes, CmaesParams, Fitness};

/// BIPOP-CMA-ES of the crate `cmaes` in `[lower, upper]^dimension`, run until `budget` evaluations are used or a cost is at
/// `target`. Its restarts choose their places themselves, from the seed.
///
/// # Errors
/// When the crate refuses a setting.
pub fn cmaes_bipop(
    (dimension, limits): (usize, RangeInclusive<f64>),
    budget: u64,
    target: Option<f64>,
    seed: u64,
    mut cost: impl FnMut(&[f64]) -> f64,
) -> Result<(), Box<dyn std::error::Error>> {
    let strategy = RestartStrategy::BIPOP(BIPOP::default());
    let budget = usize::try_from(budget)?;
    let mut options =
        RestartOptions::new(dimension, limits, strategy).max_function_evals(budget).seed(seed);
    if let Some(target) = target {
        options = options.fun_target(target);
    }
    let restarts = options.build().map_err(|error| format!("{error:?}"))?;
    restarts.run_with_reuse(|x: &DVector<f64>| cost(x.as_slice()));
    Ok(())
}

/// The initial population that our methods have from a seed, in the cube of width 1.
///
/// # Errors
/// When there is no such population.
pub fn population(
    domain: &Domain,
    seed: u64,
    count: usize,
) -> Result<Vec<Vec<f64>>, Box<dyn std::error::Error>> {
    let points = Start::new(domain, seed).population(count)?;
    let (lower, upper) = (domain.search_lower(), domain.search_upper());
    let unit = |row: &[f64]| {
        (row.iter().zip(lower).zip(upper)).map(|((x, lo), hi)| (x - lo) / (hi - lo)).collect()
    };
    Ok(points.batch().rows().map(unit).collect())
}

/// CMA-ES of the crate `fcmaes-core` from `start` with first steps of `sigma`: one run.
pub fn fcmaes_cma(
    (lower, upper): (&[f64], &[f64]),
    start: &[f64],
    sigma: f64,
    settings: &CmaesParams,
) -> Cmaes {
    Cmaes::new(Fitness::bounded(lower.len(), 1, lower, upper), start, &[sigma], settings)
}
