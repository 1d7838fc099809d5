//! One run of one method.

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use aep_core::methods::{ALL, Named, find};
use aep_core::{Budget, Driver, Outcome, Progress, Start};
use numpy::PyArray1;
use pyo3::exceptions::PyStopIteration;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::costs::Costs;
use crate::failure::{self, bad_input};
use crate::space::Space;

/// The method called `name`.
pub fn method(name: &str) -> PyResult<&'static Named> {
    find(name).ok_or_else(|| {
        let known: Vec<&str> = ALL.iter().map(|method| method.name).collect();
        bad_input(format!("there is no method '{name}'\n  choose one of: {}", known.join(", ")))
    })
}

/// Every method: its name and what it is.
#[pyfunction]
pub fn methods() -> Vec<(&'static str, &'static str)> {
    ALL.iter().map(|method| (method.name, method.summary)).collect()
}

/// What a run may use; None means no limit.
#[derive(FromPyObject)]
pub struct Limits {
    evaluations: Option<u64>,
    generations: Option<u64>,
    seconds: Option<f64>,
    target: Option<f64>,
    stagnation: Option<(u64, f64)>,
}

impl Limits {
    pub fn budget(&self) -> PyResult<Budget> {
        let time = self.seconds.map(Duration::try_from_secs_f64).transpose();
        let time = time.map_err(|error| bad_input(format!("the time limit: {error}")))?;
        let budget = Budget {
            evaluations: self.evaluations,
            generations: self.generations,
            time,
            target: self.target,
            stagnation: None,
        };
        Ok(match self.stagnation {
            Some((generations, tolerance)) => budget.with_stagnation(generations, tolerance),
            None => budget,
        })
    }
}

/// Where a run is kept: a file, every how many generations, and whether to go on from it.
#[derive(FromPyObject)]
pub struct Kept {
    path: PathBuf,
    every: u64,
    resume: bool,
}

/// Runs a method; returns what it found and what ended it early, if anything did.
#[pyfunction]
#[pyo3(signature = (space, evaluate, method_name, population, seed, initial, limits, identity, kept, callback))]
#[expect(clippy::too_many_arguments, reason = "the one call of the package's `minimize`")]
pub fn minimize<'py>(
    py: Python<'py>,
    space: &Space,
    evaluate: Py<PyAny>,
    method_name: &str,
    population: usize,
    seed: u64,
    initial: Vec<Vec<f64>>,
    limits: Limits,
    identity: String,
    kept: Option<Kept>,
    callback: Option<Py<PyAny>>,
) -> PyResult<(Bound<'py, PyDict>, Option<PyErr>)> {
    let stop = Arc::new(AtomicBool::new(false));
    let problem = Costs::new(space.clone(), identity, evaluate, Arc::clone(&stop));
    let start = Start::new(&space.domain, seed).with_initial(&initial);
    let mut algorithm =
        (method(method_name)?.build)(population).start(&start).map_err(bad_input)?;
    let budget = limits.budget()?;
    let run = || {
        let from_callback = RefCell::new(None);
        let mut driver = Driver::new(budget).with_stop_flag(&stop);
        if let Some(callback) = &callback {
            driver = driver.with_observer(|progress: &Progress<'_>| {
                match Python::attach(|py| tell(py, callback, space, progress)) {
                    Ok(false) => {}
                    Ok(true) => stop.store(true, Ordering::Relaxed),
                    Err(raised) => {
                        *from_callback.borrow_mut() = Some(raised);
                        stop.store(true, Ordering::Relaxed);
                    }
                }
            });
        }
        if let Some(kept) = &kept {
            driver = driver.with_checkpoint(&kept.path, kept.every);
        }
        let outcome = match &kept {
            Some(kept) if kept.resume => driver.resume(&mut *algorithm, &problem, &kept.path),
            _ => driver.run(&mut *algorithm, &problem),
        };
        drop(driver);
        (outcome, from_callback.into_inner())
    };
    let (outcome, from_callback) = py.detach(run);
    let outcome = outcome.map_err(|error| failure::run(&error))?;
    let raised = problem.take_raised().or(from_callback);
    Ok((told(py, space, &outcome)?, raised))
}

/// Calls back with a generation; whether the run is to end.
fn tell(
    py: Python<'_>,
    callback: &Py<PyAny>,
    space: &Space,
    progress: &Progress<'_>,
) -> PyResult<bool> {
    let facts = PyDict::new(py);
    let mut position = progress.best.map_or_else(Vec::new, |best| best.position.to_vec());
    space.round(&mut position);
    facts.set_item("x", PyArray1::from_vec(py, position))?;
    facts.set_item("fun", progress.best_cost())?;
    facts.set_item("nfev", progress.evaluations)?;
    facts.set_item("nit", progress.generation)?;
    facts.set_item("failures", progress.failures.total())?;
    facts.set_item("elapsed", progress.elapsed.as_secs_f64())?;
    match callback.call1(py, (facts,)) {
        Ok(answer) => Ok(answer.extract(py).unwrap_or(false)),
        Err(raised) if raised.is_instance_of::<PyStopIteration>(py) => Ok(true),
        Err(raised) => Err(raised),
    }
}

fn told<'py>(py: Python<'py>, space: &Space, outcome: &Outcome) -> PyResult<Bound<'py, PyDict>> {
    let facts = PyDict::new(py);
    let mut position = outcome.position.clone();
    space.round(&mut position);
    facts.set_item("x", PyArray1::from_vec(py, position))?;
    facts.set_item("fun", outcome.cost)?;
    facts.set_item("nfev", outcome.evaluations)?;
    facts.set_item("nit", outcome.generations)?;
    facts.set_item("elapsed", outcome.elapsed.as_secs_f64())?;
    facts.set_item("stop", stop_kind(&outcome.stop)?)?;
    facts.set_item("message", outcome.stop.to_string())?;
    facts.set_item("non_finite", outcome.failures.non_finite)?;
    facts.set_item("errors", outcome.failures.errors)?;
    facts.set_item("first_error", &outcome.failures.first_message)?;
    facts.set_item("checkpoint_error", &outcome.checkpoint_error)?;
    Ok(facts)
}

/// The name of a reason as it stands in JSON.
pub fn stop_kind(stop: &aep_core::StopReason) -> PyResult<String> {
    let json = serde_json::to_value(stop).map_err(bad_input)?;
    let kind = json.as_str().or_else(|| json.as_object()?.keys().next().map(String::as_str));
    Ok(kind.unwrap_or_default().to_owned())
}
