//! Ask and tell, for whoever owns the loop.

use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use aep_core::{Algorithm, Start, checkpoint};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::failure::{self, bad_input};
use crate::minimize::method;
use crate::space::Space;

/// An optimizer in the middle of a run.
#[pyclass(frozen, module = "aep._aep")]
pub struct Optimizer {
    algorithm: Mutex<Box<dyn Algorithm>>,
    space: Space,
}

impl Optimizer {
    fn algorithm(&self) -> MutexGuard<'_, Box<dyn Algorithm>> {
        self.algorithm.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Optimizer {
    #[new]
    fn new(
        space: &Space,
        method_name: &str,
        population: usize,
        seed: u64,
        initial: Vec<Vec<f64>>,
    ) -> PyResult<Self> {
        let start = Start::new(&space.domain, seed).with_initial(&initial);
        let algorithm =
            (method(method_name)?.build)(population).start(&start).map_err(bad_input)?;
        Ok(Self { algorithm: Mutex::new(algorithm), space: space.clone() })
    }

    fn ask<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut algorithm = self.algorithm();
        let batch = algorithm.ask();
        let shape = [batch.len(), batch.dimension()];
        let mut rows: Vec<f64> = batch.rows().flatten().copied().collect();
        self.space.round(&mut rows);
        PyArray1::from_vec(py, rows).reshape(shape)
    }

    fn tell(&self, costs: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let costs = costs.as_array().to_vec();
        self.algorithm().tell(&costs).map_err(bad_input)
    }

    /// The best position and its cost; None before the first finite cost.
    #[getter]
    fn best<'py>(&self, py: Python<'py>) -> Option<(Bound<'py, PyArray1<f64>>, f64)> {
        let algorithm = self.algorithm();
        let best = algorithm.best()?;
        let mut position = best.position.to_vec();
        self.space.round(&mut position);
        Some((PyArray1::from_vec(py, position), best.cost))
    }

    #[getter]
    fn generation(&self) -> u64 {
        self.algorithm().generation()
    }

    #[getter]
    fn exhausted(&self) -> Option<String> {
        self.algorithm().exhausted().map(str::to_owned)
    }

    fn save(&self, path: PathBuf) -> PyResult<()> {
        let algorithm = self.algorithm();
        let state = algorithm.save().map_err(|error| failure::checkpoint(&error))?;
        checkpoint::write(&path, &(algorithm.signature(), state))
            .map_err(|error| failure::checkpoint(&error))
    }

    fn restore(&self, path: PathBuf) -> PyResult<()> {
        let (saved, state): (String, Vec<u8>) =
            checkpoint::read(&path).map_err(|error| failure::checkpoint(&error))?;
        let mut algorithm = self.algorithm();
        let run = algorithm.signature();
        if saved != run {
            let error = checkpoint::CheckpointError::OtherRun { checkpoint: saved, run };
            return Err(failure::checkpoint(&error));
        }
        algorithm.restore(&state).map_err(|error| failure::checkpoint(&error))
    }
}
