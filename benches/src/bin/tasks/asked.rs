//! A case as methods of Python ask for it.

use benches::python::{self, INDIVIDUALS, Request};

use crate::Result;
use crate::case::{Case, Tally};

/// First step, in widths of the domain: that of our CMA-ES.
const SIGMA: f64 = 0.3;

pub struct Asked<'a> {
    pub case: &'a Case,
    pub tally: &'a Tally<'a>,
}

impl Asked<'_> {
    pub fn request<'a>(&self, peer: &'a str, seed: u64) -> Result<Request<'a>> {
        let population =
            self.case.population(seed, INDIVIDUALS * self.case.domain().dimension())?;
        let (budget, residuals) = (self.tally.left(), self.case.residuals());
        Ok(Request { peer, seed, budget, residuals, sigma: SIGMA, whole: &[], population })
    }
}

impl python::Asked for Asked<'_> {
    fn cost(&mut self, unit: &[f64]) -> f64 {
        self.tally.cost_in_cube(unit)
    }

    fn residuals(&mut self, unit: &[f64]) -> Vec<f64> {
        self.tally.residuals(&self.case.in_domain(unit))
    }

    fn is_over(&self) -> bool {
        self.tally.is_over()
    }
}
