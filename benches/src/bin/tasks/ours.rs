//! Our methods, asked and told.

use aep_core::{Domain, LeastSquares, Method, Start, polish};

use crate::Result;
use crate::case::{Case, Tally};

/// One run, until it is over or the method gives up.
pub fn run(method: &dyn Method, case: &Case, seed: u64, tally: &Tally<'_>) -> Result<()> {
    let mut optimizer = method.start(&Start::new(case.domain(), seed))?;
    while !tally.is_over() && optimizer.exhausted().is_none() {
        let points = optimizer.ask();
        let cost = |x: &[f64]| Some(tally.cost(x)).filter(|cost| cost.is_finite());
        let costs: Vec<f64> = points.rows().map(|x| cost(x).unwrap_or(f64::INFINITY)).collect();
        optimizer.tell(&costs)?;
    }
    Ok(())
}

/// The same with the residuals told, where they are wanted.
pub fn run_told(method: &dyn Method, case: &Case, seed: u64, tally: &Tally<'_>) -> Result<()> {
    let mut optimizer = method.start(&Start::new(case.domain(), seed))?;
    while !tally.is_over() && optimizer.exhausted().is_none() {
        if !optimizer.wants_residuals() {
            let costs: Vec<f64> = optimizer.ask().rows().map(|x| tally.cost(x)).collect();
            optimizer.tell(&costs)?;
            continue;
        }
        let residuals: Vec<Vec<f64>> = optimizer.ask().rows().map(|x| tally.residuals(x)).collect();
        let costs: Vec<f64> = residuals.iter().map(|r| r.iter().map(|r| r * r).sum()).collect();
        optimizer.tell_residuals(&costs, &residuals)?;
    }
    Ok(())
}

/// A descent on the residuals from the first individual of `seed`.
pub fn descend(case: &Case, seed: u64, tally: &Tally<'_>) -> Result<()> {
    let start = case.in_domain(&case.population(seed, 1)?[0]);
    polish(&Told { case, tally }, &start)?;
    Ok(())
}

/// The residuals of a task, counted.
struct Told<'a> {
    case: &'a Case,
    tally: &'a Tally<'a>,
}

impl LeastSquares for Told<'_> {
    fn domain(&self) -> &Domain {
        self.case.domain()
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        self.tally.residuals(x)
    }
}
