//! An identification task.

use aep_core::{Batch, LeastSquares, Problem, Scale};
use aep_problems::tasks::{self as suite, Identification, Parameter};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::failure::bad_input;

/// A parameter: name, unit, lower and upper limit, whether it is searched by its logarithm, the value that the recording was
/// made with.
type Row = (&'static str, &'static str, f64, f64, bool, f64);

/// A task of `aep_problems`.
#[pyclass(frozen, module = "aep._aep")]
pub struct Task {
    problem: Identification,
}

/// Every task: its name and what is identified.
#[pyfunction]
pub fn tasks() -> Vec<(&'static str, &'static str)> {
    suite::ALL.iter().map(|task| (task.name, task.subject)).collect()
}

impl Task {
    /// The rows of `points`, where they have one number for each parameter.
    fn rows(&self, points: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<f64>> {
        let (found, expected) = (points.as_array().ncols(), self.problem.task().parameters.len());
        if found == expected {
            return Ok(points.as_array().iter().copied().collect());
        }
        Err(bad_input(format!(
            "a position has {found} numbers\n  give {expected}, one for each of the task's parameters"
        )))
    }
}

#[pymethods]
impl Task {
    #[new]
    fn new(name: &str) -> PyResult<Self> {
        let task = suite::find(name).ok_or_else(|| {
            let known: Vec<&str> = suite::ALL.iter().map(|task| task.name).collect();
            bad_input(format!("there is no task '{name}'\n  choose one of: {}", known.join(", ")))
        })?;
        Ok(Self { problem: task.problem() })
    }

    fn costs<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let rows = self.rows(&points)?;
        let batch = Batch::new(self.problem.task().parameters.len(), &rows);
        let mut costs = vec![f64::NAN; batch.len()];
        py.detach(|| self.problem.evaluate_batch(batch, &mut costs));
        Ok(PyArray1::from_vec(py, costs))
    }

    fn residuals<'py>(
        &self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Vec<Bound<'py, PyArray1<f64>>>> {
        let rows = self.rows(&points)?;
        let batch = Batch::new(self.problem.task().parameters.len(), &rows);
        let residuals = self.problem.residuals_batch(batch);
        Ok(residuals.into_iter().map(|residuals| PyArray1::from_vec(py, residuals)).collect())
    }

    #[getter]
    fn parameters(&self) -> Vec<Row> {
        let row = |p: &Parameter| {
            (p.name, p.unit, p.limits.0, p.limits.1, p.scale == Scale::Log, p.truth)
        };
        self.problem.task().parameters.iter().map(row).collect()
    }

    /// The best that is known: parameters and cost; and the cost that counts as solved.
    #[getter]
    fn best(&self) -> (Vec<f64>, f64, f64) {
        let best = self.problem.task().best;
        (best.position.to_vec(), best.cost, self.problem.target())
    }
}
