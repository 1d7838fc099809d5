//! The global part of a fit: accelerated evolutionary programming finds the valley, the refinement
//! in [`crate::fit`] its bottom.
//!
//! Amplitudes enter a prediction (nearly) linearly, so that for given shapes the best ones follow
//! from least squares (variable projection, Golub and Pereyra 1973). A model without shapes is
//! searched over its amplitudes, a model with shapes over the shapes alone.

use aep_core::{Aep, Budget, Domain, Driver, FnProblem, Method, Scale, Start};

use crate::family::shapes::{amplitudes, assemble};
use crate::family::{Fitted, ModelFamily, Role, TermParameter};
use crate::fit::{self, Fit, Until, weighted_square};
use crate::statistics::basis::{Basis, constrained, dot, gram, weighed};

/// Budget of the search over a model's own parameters.
const GENERATIONS: u64 = 200;
/// Generations without progress after which a search ends.
const STAGNATION: u64 = 25;
/// Individuals and generations of the search over one candidate's shapes.
const CANDIDATE: (usize, u64) = (12, 20);
/// A column whose square falls below this share when the model's own freedom is taken out says nothing that the model does
/// not say.
const NOTHING_NEW: f64 = 1e-6;
/// Of two trial shapes that remove nearly as much, this close, the one tried first is taken.
const AS_GOOD: f64 = 0.97;

/// An identified model.
pub struct Found {
    /// The refined model.
    pub fit: Fit,
    /// Evaluations of the search before the refinement.
    pub evaluations: usize,
}

/// Identifies a model of these terms on the points with a weight, by AEP and refinement.
pub fn identify(family: &dyn ModelFamily, terms: &[usize], weights: &[f64], seed: u64) -> Found {
    identify_by(family, terms, weights, (&Aep::practical(), seed), Until::default())
}

/// Like [`identify`], with another optimizer; once `until` is over the best of the search so far is refined.
pub fn identify_by(
    family: &dyn ModelFamily,
    terms: &[usize],
    weights: &[f64],
    (method, seed): (&dyn Method<f64>, u64),
    until: Until<'_>,
) -> Found {
    let budget = Budget::generations(GENERATIONS);
    let values = terms
        .iter()
        .flat_map(|&term| family.terms()[term].parameters.iter().map(|p| p.start))
        .collect();
    let start = Fitted { terms: terms.to_vec(), values };
    let roles: Vec<Role> = start.parameters(family).map(|(_, p)| p.role).collect();
    let searched = if roles.contains(&Role::Shape) { Role::Shape } else { Role::Amplitude };
    let free: Vec<usize> = (0..roles.len()).filter(|&k| roles[k] == searched).collect();
    let parameters: Vec<TermParameter> = start.parameters(family).map(|(_, p)| p.clone()).collect();
    let domain: Vec<&TermParameter> = free.iter().map(|&k| &parameters[k]).collect();
    let total = weighted_square(family.target(), weights).max(f64::MIN_POSITIVE);
    let (position, evaluations) = if searched == Role::Amplitude {
        let cost = quadratic(family, &start, &parameters, weights);
        minimise(&domain, &|x: &[f64]| cost(x) / total, (method, seed), budget, until)
    } else {
        let cost = |x: &[f64]| {
            projected(family, &with_free(&start, &free, x), &parameters, weights).1 / total
        };
        minimise(&domain, &cost, (method, seed), budget, until)
    };
    let best = with_free(&start, &free, &position);
    let best = match searched {
        Role::Amplitude => best,
        Role::Shape => projected(family, &best, &parameters, weights).0,
    };
    Found { fit: fit::refine(family, best, weights), evaluations }
}

/// The model of `fit` with a term added: the trial shape that removes most of what the fit leaves, searched on between
/// its neighbours.
pub fn shaped(
    family: &dyn ModelFamily,
    fit: &Fit,
    term: usize,
    weights: &[f64],
    seed: u64,
) -> Fitted {
    let about = &family.terms()[term];
    let weigh = |column: &[f64]| weighed(column, weights);
    let own = Basis::of(&fit.jacobian.iter().map(|column| weigh(column)).collect::<Vec<_>>());
    let mut residual = weigh(&fit.residual);
    own.project_out(&mut residual);
    let positive: Vec<bool> = match amplitudes(about).as_slice() {
        [] => vec![true],
        some => some.iter().map(|parameter| parameter.lower >= 0.0).collect(),
    };
    let total = dot(&residual, &residual).max(f64::MIN_POSITIVE);
    let profiled = |mut columns: Vec<Vec<f64>>| {
        for column in &mut columns {
            *column = weigh(column);
            let before = dot(column, column);
            own.project_out(column);
            // Only rounding noise is left.
            if dot(column, column) < NOTHING_NEW * before {
                column.fill(0.0);
            }
        }
        let moment: Vec<f64> = columns.iter().map(|column| dot(column, &residual)).collect();
        let beta = constrained(&gram(&columns), &moment, &positive);
        let fall: f64 = beta.iter().zip(&moment).map(|(b, m)| b * m).sum();
        (1.0 - fall / total, beta)
    };
    let profile =
        |shape: &[f64]| profiled(family.columns(&fit.model, &fit.prediction, term, shape));
    let tried = family.shapes(term);
    let left: Vec<f64> = family
        .columns_of_shapes(&fit.model, &fit.prediction, term, &tried)
        .into_iter()
        .map(|columns| profiled(columns).0)
        .collect();
    let least = left.iter().copied().fold(f64::INFINITY, f64::min);
    // Of shapes that remove nearly as much the first one.
    let as_good = left.iter().position(|left| 1.0 - left >= AS_GOOD * (1.0 - least));
    let Some(shape) = as_good.filter(|_| least < 1.0).map(|k| tried[k].clone()) else {
        let starts: Vec<f64> = about.parameters.iter().map(|parameter| parameter.start).collect();
        return fit.model.with(term, &starts);
    };
    let limits = neighbours(&tried, &shape);
    let shapes = about.parameters.iter().filter(|p| p.role == Role::Shape);
    let window: Vec<TermParameter> = shapes
        .zip(limits)
        .map(|(parameter, (lower, upper))| TermParameter { lower, upper, ..parameter.clone() })
        .collect();
    let (population, generations) = CANDIDATE;
    let method = Aep::practical().with_population(population);
    let domain: Vec<&TermParameter> = window.iter().collect();
    let (cost, budget) = (|x: &[f64]| profile(x).0, Budget::generations(generations));
    let (found, _) = minimise(&domain, &cost, (&method, seed), budget, Until::default());
    let searched = !shape.is_empty() && profile(&found).0 < profile(&shape).0;
    let shape = if searched { found } else { shape };
    let amplitude = profile(&shape).1;
    let amplitude: &[f64] = if amplitudes(about).is_empty() { &[] } else { &amplitude };
    fit.model.with(term, &assemble(about, &shape, amplitude))
}

/// On each axis the nearest values that were tried below and above.
fn neighbours(tried: &[Vec<f64>], shape: &[f64]) -> Vec<(f64, f64)> {
    (0..shape.len())
        .map(|axis| {
            let here = shape[axis];
            let values = || tried.iter().map(|point| point[axis]);
            let below = values().filter(|v| *v < here).fold(f64::NEG_INFINITY, f64::max);
            let above = values().filter(|v| *v > here).fold(f64::INFINITY, f64::min);
            let finite = |value: f64| if value.is_finite() { value } else { here };
            (finite(below), finite(above))
        })
        .collect()
}

fn with_free(start: &Fitted, free: &[usize], x: &[f64]) -> Fitted {
    let mut model = start.clone();
    free.iter().zip(x).for_each(|(&k, value)| model.values[k] = *value);
    model
}

/// The best position and the evaluations it took; the start where a domain has no extent or there was no time.
fn minimise(
    parameters: &[&TermParameter],
    cost: &(dyn Fn(&[f64]) -> f64 + Sync),
    (method, seed): (&dyn Method<f64>, u64),
    budget: Budget,
    until: Until<'_>,
) -> (Vec<f64>, usize) {
    let start: Vec<f64> = parameters.iter().map(|p| p.start.clamp(p.lower, p.upper)).collect();
    let lower = parameters.iter().map(|p| p.lower).collect();
    let upper = parameters.iter().map(|p| p.upper).collect();
    let scales = parameters.iter().map(|p| p.scale).collect();
    let run = || {
        let domain = Domain::new(lower, upper)?.with_scales(scales)?;
        let problem = FnProblem::new(domain.clone(), |x: &[f64]| cost(x));
        let mut algorithm = method.start(&Start::new(&domain, seed))?;
        let budget = budget.with_stagnation(STAGNATION, 1e-6);
        let budget = until.left().into_iter().fold(budget, Budget::with_time);
        let driver = Driver::new(budget).in_parallel();
        let mut driver = until.stop.into_iter().fold(driver, Driver::with_stop_flag);
        driver.run(&mut *algorithm, &problem)
    };
    match run() {
        Ok(outcome) if !outcome.position.is_empty() => {
            (outcome.position, outcome.evaluations as usize)
        }
        _ => (start, 0),
    }
}

/// Derivatives of the prediction with respect to the values themselves, not their logarithms.
fn natural(fit: &Fit, parameters: &[TermParameter]) -> Vec<Vec<f64>> {
    fit.jacobian
        .iter()
        .zip(parameters)
        .zip(&fit.model.values)
        .map(|((column, parameter), value)| match parameter.scale {
            Scale::Linear => column.clone(),
            Scale::Log => column.iter().map(|entry| entry / value).collect(),
        })
        .collect()
}

/// The squared error as a function of all amplitudes, exact where the prediction is linear in them.
fn quadratic<'a>(
    family: &dyn ModelFamily,
    start: &'a Fitted,
    parameters: &[TermParameter],
    weights: &[f64],
) -> impl Fn(&[f64]) -> f64 + 'a {
    let fit = fit::evaluate(family, start.clone(), weights);
    let weigh = |column: &Vec<f64>| weighed(column, weights);
    let columns: Vec<Vec<f64>> = natural(&fit, parameters).iter().map(weigh).collect();
    let residual = weigh(&fit.residual);
    let moment: Vec<f64> = columns.iter().map(|column| dot(column, &residual)).collect();
    let normal = gram(&columns);
    move |x: &[f64]| {
        let step: Vec<f64> = x.iter().zip(&start.values).map(|(x, start)| x - start).collect();
        let linear: f64 = step.iter().zip(&moment).map(|(s, m)| s * m).sum();
        let square: f64 = step.iter().zip(&normal).map(|(s, row)| s * dot(row, &step)).sum();
        (fit.cost - 2.0 * linear + square).max(0.0)
    }
}

/// The model with the shapes of `start` and the best amplitudes, and its cost.
fn projected(
    family: &dyn ModelFamily,
    start: &Fitted,
    parameters: &[TermParameter],
    weights: &[f64],
) -> (Fitted, f64) {
    let fit = fit::evaluate(family, start.clone(), weights);
    let amplitudes: Vec<usize> =
        (0..parameters.len()).filter(|&k| parameters[k].role == Role::Amplitude).collect();
    let natural = natural(&fit, parameters);
    let weigh = |column: &Vec<f64>| weighed(column, weights);
    let columns: Vec<Vec<f64>> = amplitudes.iter().map(|&k| weigh(&natural[k])).collect();
    // The residual as it would be with all amplitudes at 0, to first order, so that the solution
    // is the amplitudes themselves and their signs can be constrained.
    let mut residual = weigh(&fit.residual);
    for (column, &k) in columns.iter().zip(&amplitudes) {
        crate::statistics::basis::add_scaled(&mut residual, start.values[k], column);
    }
    let moment: Vec<f64> = columns.iter().map(|column| dot(column, &residual)).collect();
    let positive: Vec<bool> = amplitudes.iter().map(|&k| parameters[k].lower >= 0.0).collect();
    let solution = constrained(&gram(&columns), &moment, &positive);
    let mut best = start.clone();
    for (&k, value) in amplitudes.iter().zip(solution) {
        best.values[k] = value.clamp(parameters[k].lower, parameters[k].upper);
    }
    let prediction = fit::predict(family, &best);
    let cost = weighted_square(&fit::residual(family, &prediction), weights);
    (best, cost)
}
