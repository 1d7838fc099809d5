//! Many runs of a method, and what they come to.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use aep_core::trials::{Merit, Plan, Trials, rank_test as compare};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::costs::Costs;
use crate::failure::{self, bad_input};
use crate::minimize::{Limits, method, stop_kind};
use crate::space::Space;

/// Trials of a method one after the other, in the calling thread: a cost written in Python need not bear two at once.
/// Returns the summary, the trials, and what ended them early, if anything did.
#[pyfunction]
#[pyo3(signature = (space, evaluate, method_name, population, seed, count, limits, target))]
#[expect(clippy::too_many_arguments, reason = "the one call of the package's `trials`")]
#[expect(clippy::type_complexity, reason = "three things that Python takes apart at once")]
pub fn trials<'py>(
    py: Python<'py>,
    space: &Space,
    evaluate: Py<PyAny>,
    method_name: &str,
    population: usize,
    seed: u64,
    count: usize,
    limits: Limits,
    target: f64,
) -> PyResult<(Bound<'py, PyDict>, Vec<Bound<'py, PyDict>>, Option<PyErr>)> {
    let stop = Arc::new(AtomicBool::new(false));
    let problem = Costs::new(space.clone(), String::new(), evaluate, Arc::clone(&stop));
    let method = (method(method_name)?.build)(population);
    let plan = Plan::new(count, limits.budget()?).with_seed(seed);
    let found = py.detach(|| plan.run_in_turn(&*method, |_| &problem, &stop, &|| {}));
    let found = found.map_err(|error| failure::run(&error))?;
    let each = each(py, space, &found)?;
    Ok((summary(py, method_name, &found, target)?, each, problem.take_raised()))
}

fn summary<'py>(
    py: Python<'py>,
    name: &str,
    found: &Trials,
    target: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let summary = found.summary(target);
    let facts = PyDict::new(py);
    facts.set_item("method", name)?;
    facts.set_item("trials", summary.trials)?;
    facts.set_item("successes", summary.successes)?;
    facts.set_item("mean", summary.mean)?;
    facts.set_item("median", summary.median)?;
    facts.set_item("quartiles", summary.quartiles)?;
    facts.set_item("range", summary.range)?;
    facts.set_item("evaluations_to_target", summary.evaluations_to_target)?;
    facts.set_item("expected_running_time", summary.expected_running_time)?;
    facts.set_item("failures", summary.failures)?;
    facts.set_item("seconds", summary.seconds)?;
    Ok(facts)
}

fn each<'py>(py: Python<'py>, space: &Space, found: &Trials) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let trials = found.trials.iter().map(|trial| {
        let facts = PyDict::new(py);
        let mut position = trial.position.clone();
        space.round(&mut position);
        facts.set_item("seed", trial.seed)?;
        facts.set_item("x", position)?;
        facts.set_item("fun", trial.cost)?;
        facts.set_item("nfev", trial.evaluations)?;
        facts.set_item("nit", trial.generations)?;
        facts.set_item("stop", stop_kind(&trial.stop)?)?;
        facts.set_item("improvements", trial.improvements.clone())?;
        Ok(facts)
    });
    trials.collect()
}

/// Which of two methods is ahead, by the evaluations to the target (None: not reached) and the final cost of their trials:
/// the probability that a trial of the first is better than one of the second, and the two-sided p-value of "no
/// difference".
#[pyfunction]
pub fn rank_test(
    first: Vec<(Option<u64>, f64)>,
    second: Vec<(Option<u64>, f64)>,
) -> PyResult<(f64, f64)> {
    if first.is_empty() || second.is_empty() {
        return Err(bad_input("a rank test needs trials of both methods"));
    }
    let merits = |trials: Vec<(Option<u64>, f64)>| -> Vec<Merit> {
        trials.into_iter().map(|(reached, cost)| Merit::new(reached, cost)).collect()
    };
    let test = compare(&merits(first), &merits(second));
    Ok((test.effect, test.p_value))
}
