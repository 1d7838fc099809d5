//! A formula evaluated on arrays.

use aep_formula::{Formula, constant};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::failure::bad_input;

/// The values of a formula at `samples` samples; `names` has as many values for each name in it.
#[pyfunction]
pub fn evaluate<'py>(
    py: Python<'py>,
    formula: &str,
    names: Vec<(String, PyReadonlyArray1<'py, f64>)>,
    samples: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let formula = Formula::parse(formula).map_err(bad_input)?;
    let column = |name: &String| {
        let given = names.iter().find(|(other, _)| other == name);
        let values = match given {
            Some((_, values)) => values.as_array().to_vec(),
            None => constant(name).map_or_else(Vec::new, |number| vec![number; samples]),
        };
        if values.len() == samples {
            return Ok(values);
        }
        Err(bad_input(format!("'{name}' has {} values for {samples} samples", values.len())))
    };
    let columns = formula.names().iter().map(column).collect::<PyResult<Vec<_>>>()?;
    let (mut at, mut stack) = (Vec::new(), Vec::new());
    let value = |k: usize| {
        at.clear();
        at.extend(columns.iter().map(|values| values[k]));
        formula.value_on(&at, &mut stack)
    };
    Ok(PyArray1::from_vec(py, (0..samples).map(value).collect()))
}
