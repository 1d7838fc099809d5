//! A cost that Python evaluates, as a problem of the engine.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use aep_core::{Batch, Domain, Errors, Problem};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::space::Space;

/// A cost of whole generations in Python: `evaluate(points)` takes an array of shape (n, d) and returns the costs, shape
/// (n,), how many evaluations ended in an error, and what the first one said.
pub struct Costs {
    space: Space,
    identity: String,
    evaluate: Py<PyAny>,
    /// Set together with [`State::raised`].
    stop: Arc<AtomicBool>,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    errors: Errors,
    raised: Option<PyErr>,
}

impl Costs {
    pub fn new(space: Space, identity: String, evaluate: Py<PyAny>, stop: Arc<AtomicBool>) -> Self {
        Self { space, identity, evaluate, stop, state: Mutex::default() }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What ended an evaluation: Ctrl-C, or that nobody is left who could evaluate.
    pub fn take_raised(&self) -> Option<PyErr> {
        self.state().raised.take()
    }

    fn ask_python(&self, points: Batch<'_>, costs: &mut [f64]) -> PyResult<()> {
        let mut rows: Vec<f64> = points.rows().flatten().copied().collect();
        self.space.round(&mut rows);
        Python::attach(|py| {
            let points =
                PyArray1::from_vec(py, rows).reshape([points.len(), points.dimension()])?;
            let answer = self.evaluate.call1(py, (points,))?;
            let (found, count, first): (PyReadonlyArray1<'_, f64>, u64, Option<String>) =
                answer.extract(py)?;
            // Python's side returns one cost a point; a copy of another length would panic.
            for (cost, found) in costs.iter_mut().zip(found.as_array()) {
                *cost = *found;
            }
            let mut state = self.state();
            state.errors.count += count;
            state.errors.first = state.errors.first.take().or(first);
            Ok(())
        })
    }
}

impl Problem for Costs {
    fn domain(&self) -> &Domain {
        &self.space.domain
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        let mut cost = [f64::NAN];
        self.evaluate_batch(Batch::new(x.len(), x), &mut cost);
        cost[0]
    }

    fn evaluate_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        costs.fill(f64::NAN);
        if let Err(raised) = self.ask_python(points, costs) {
            self.state().raised = Some(raised);
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    fn errors(&self) -> Errors {
        self.state().errors.clone()
    }

    fn is_broken_off(&self) -> bool {
        self.state().raised.is_some()
    }

    fn identity(&self) -> String {
        self.identity.clone()
    }
}
