//! Where a cost is defined: a domain some of whose components are whole numbers.

use aep_core::{ConfigError, Domain, Scale};
use pyo3::prelude::*;

use crate::failure::bad_input;

/// A box with scales, names and whole components.
///
/// An algorithm searches a whole component as a number from half below its lower to half above its upper limit, and the
/// cost sees it rounded: every whole number gets the same share.
#[pyclass(frozen, module = "aep._aep")]
#[derive(Clone)]
pub struct Space {
    pub domain: Domain,
    whole: Vec<Option<(f64, f64)>>,
}

impl Space {
    /// Rounds the whole components of each row of `points` (problem coordinates).
    pub fn round(&self, points: &mut [f64]) {
        if self.whole.iter().all(Option::is_none) {
            return;
        }
        for row in points.chunks_exact_mut(self.whole.len()) {
            for (x, limits) in row.iter_mut().zip(&self.whole) {
                if let Some((lower, upper)) = limits {
                    *x = x.round().clamp(*lower, *upper);
                }
            }
        }
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
        let limits: Vec<(f64, f64)> = lower.iter().copied().zip(upper.iter().copied()).collect();
        let whole: Vec<Option<(f64, f64)>> = (limits.iter().zip(whole))
            .map(|((lower, upper), whole)| whole.then(|| (lower.ceil(), upper.floor())))
            .collect();
        for (component, limits) in whole.iter().enumerate() {
            if let Some((low, high)) = limits {
                if low > high {
                    let (lower, upper) = (lower[component], upper[component]);
                    return Err(ConfigError::Limits { component, lower, upper });
                }
                lower[component] = low - 0.5;
                upper[component] = high + 0.5;
            }
        }
        let scales = log.iter().map(|log| if *log { Scale::Log } else { Scale::Linear });
        let mut domain = Domain::new(lower, upper)?.with_scales(scales.collect())?;
        if !names.is_empty() {
            domain = domain.with_names(names)?;
        }
        Ok(Self { domain, whole })
    }
}
