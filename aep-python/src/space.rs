//! Where a cost is defined: a domain some of whose components are whole numbers.

use aep_core::{ConfigError, Domain, Scale, Whole};
use pyo3::prelude::*;

use crate::failure::bad_input;

/// A box with scales, names and whole components.
#[pyclass(frozen, module = "aep._aep")]
#[derive(Clone)]
pub struct Space {
    pub domain: Domain,
    whole: Whole,
}

impl Space {
    /// Rounds the whole components of each row of `points` (problem coordinates).
    pub fn round(&self, points: &mut [f64]) {
        self.whole.round(points);
    }
}

#[pymethods]
impl Space {
    #[new]
    fn new(
        lower: Vec<f64>,
        upper: Vec<f64>,
        log: Vec<bool>,
        whole: Vec<bool>,
        names: Vec<String>,
    ) -> PyResult<Self> {
        Self::build(lower, upper, &log, &whole, names).map_err(bad_input)
    }

    /// Number of components.
    #[getter]
    fn dimension(&self) -> usize {
        self.domain.dimension()
    }

    /// Names of the components.
    #[getter]
    fn names(&self) -> Vec<String> {
        (0..self.domain.dimension()).map(|component| self.domain.name(component)).collect()
    }
}

impl Space {
    fn build(
        mut lower: Vec<f64>,
        mut upper: Vec<f64>,
        log: &[bool],
        whole: &[bool],
        names: Vec<String>,
    ) -> Result<Self, ConfigError> {
        let whole = Whole::widening(&mut lower, &mut upper, whole)?;
        let scales = log.iter().map(|log| if *log { Scale::Log } else { Scale::Linear });
        let mut domain = Domain::new(lower, upper)?.with_scales(scales.collect())?;
        if !names.is_empty() {
            domain = domain.with_names(names)?;
        }
        Ok(Self { domain, whole })
    }
}
