//! Ask and tell one position at a time, for whoever waits for nobody.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use aep_core::{CheckpointError, Start, SteadyState, StopReason, checkpoint, methods::ALL};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::failure::{self, bad_input};
use crate::minimize::method;
use crate::space::Space;

/// An asynchronous optimizer in the middle of a run.
#[pyclass(frozen, module = "aep._aep")]
pub struct Steady {
    run: Mutex<Box<dyn SteadyState>>,
    space: Space,
}

/// The run of a checkpoint: the cost's identity, the method's signature, its state, and what the loop counts, as JSON.
type Saved = (String, String, Vec<u8>, String);

impl Steady {
    fn run(&self) -> MutexGuard<'_, Box<dyn SteadyState>> {
        self.run.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn rounded<'py>(&self, py: Python<'py>, position: &[f64]) -> Bound<'py, PyArray1<f64>> {
        let mut position = position.to_vec();
        self.space.round(&mut position);
        PyArray1::from_vec(py, position)
    }
}

#[pymethods]
impl Steady {
    #[new]
    fn new(
        space: &Space,
        method_name: &str,
        population: usize,
        seed: u64,
        initial: Vec<Vec<f64>>,
    ) -> PyResult<Self> {
        let start = Start::new(&space.domain, seed).with_initial(&initial);
        let chosen = (method(method_name)?.build)(population);
        let run = chosen.start_steady_state(&start).ok_or_else(|| {
            let domain = Start::new(&space.domain, seed);
            let known = ALL.iter().filter(|named| (named.build)(0).start_steady_state(&domain).is_some());
            let known: Vec<&str> = known.map(|named| named.name).collect();
            bad_input(format!(
                "'{method_name}' needs whole generations: it has no asynchronous mode\n  choose one of: {}",
                known.join(", ")
            ))
        })?;
        Ok(Self { run: Mutex::new(run.map_err(bad_input)?), space: space.clone() })
    }

    /// An individual and its position; None while a cost of every one is awaited.
    fn ask<'py>(&self, py: Python<'py>) -> Option<(usize, Bound<'py, PyArray1<f64>>)> {
        let mut run = self.run();
        let (individual, position) = run.ask()?;
        Some((individual, self.rounded(py, position)))
    }

    fn tell(&self, individual: usize, cost: f64) -> PyResult<()> {
        self.run().tell(individual, cost).map_err(|_| {
            bad_input(format!(
                "no cost of individual {individual} is awaited\n  ask, evaluate the position, then tell its cost once"
            ))
        })
    }

    /// The best position and its cost; None before the first finite cost.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> Option<(Bound<'py, PyArray1<f64>>, f64)> {
        let run = self.run();
        let best = run.best()?;
        Some((self.rounded(py, best.position), best.cost))
    }

    #[getter]
    fn individuals(&self) -> usize {
        self.run().individuals()
    }

    #[getter]
    fn told(&self) -> u64 {
        self.run().told()
    }

    fn save(&self, path: PathBuf, identity: String, counts: String) -> PyResult<()> {
        let run = self.run();
        let state = run.save().map_err(|error| failure::checkpoint(&error))?;
        let saved: Saved = (identity, run.signature(), state, counts);
        checkpoint::write(&path, &saved).map_err(|error| failure::checkpoint(&error))
    }

    /// Goes on from a file; returns what the loop had counted.
    fn restore(&self, path: PathBuf, identity: String) -> PyResult<String> {
        let wrong = |error: CheckpointError| failure::checkpoint(&error);
        let (problem, saved, state, counts): Saved = checkpoint::read(&path).map_err(wrong)?;
        let mut own = self.run();
        if problem != identity {
            return Err(wrong(CheckpointError::OtherProblem {
                checkpoint: problem,
                run: identity,
            }));
        }
        let run = own.signature();
        if saved != run {
            return Err(wrong(CheckpointError::OtherRun { checkpoint: saved, run }));
        }
        own.restore(&state).map_err(wrong)?;
        Ok(counts)
    }
}

/// What a reason to stop says, by its name in JSON.
#[pyfunction]
pub fn stop_message(kind: &str) -> PyResult<String> {
    let stop: StopReason = serde_json::from_value(kind.into()).map_err(bad_input)?;
    Ok(stop.to_string())
}
