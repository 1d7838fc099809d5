//! AEP with lineages.

mod archive;
mod companions;
mod components;
mod descent;
mod descents;
mod distribution;
mod exchange;
mod guess;
mod ingredient;
mod line;
mod lineage;
mod model;
mod repeats;
mod run;
mod schedule;
mod triangular;
mod weights;

use serde::{Deserialize, Serialize};

pub use ingredient::Ingredient;

use crate::{Algorithm, ConfigError, Method, Scalar, Start};

/// A descendant of AEP for costs that take time: few evaluations, on one minimum or on many.
///
/// What AEP remembers of an individual (a direction per component, an age since its last success, a
/// contest between child and parent) becomes what is remembered of a *lineage*: a parent position m
/// with a normal distribution N(m, sigma^2 C) of its children. A generation ranks lambda children, moves m to the
/// weighted mean of the better half, and adapts C and sigma.
///
/// - **Direction**: where m has been going, a faded sum of its steps, one number per component. C is
///   stretched along it.
/// - **Age**: generations since the lineage has last become better. At the limit of
///   3 (10 + 30 n / lambda) the lineage ends and another begins.
/// - **Contest**: a lineage that follows others is given up as soon as its costs differ by less than
///   it is behind the best of them.
///
/// **Noise.** Where the best position of a lineage that has aged has another cost when it is evaluated once more, age is told by
/// the median of a generation from then on, and there is no contest. Where costs repeat, at most ten evaluations of a run are
/// spent on that, and nothing else changes.
///
/// To these come, each an [`Ingredient`] that can be left out: negative weights of bad children, a
/// quadratic model of the cost that takes the place of evaluations while it ranks well, a search
/// along the components where the cost is a sum over them (told by two evaluations where it is not),
/// descents on the residuals where the problem tells them ([`crate::Problem::as_least_squares`]), and
/// three regimes of lineages that share the evaluations: large ones, small ones, and populations of
/// individuals by the rules of [`crate::Aep::practical`].
///
/// | setting | default | meaning |
/// |---|---|---|
/// | population | 0: 4 + 3 ln n | children of a generation of the first lineage, at least 4 |
/// | `sigma` | 0.2 | first step size in widths of the domain |
/// | [`Ingredient`] | all | what is left out |
///
/// **Residuals.** Descents by Levenberg-Marquardt come first, from the best of as many random places as a generation has
/// children; after 100 n evaluations they and the search get as many each, and every second descent begins at the best that
/// the search has found since. Where differences mislead (a rough, noisy or discontinuous cost) the search is what finds.
///
/// It works in search coordinates scaled to the domain's width and mirrors what leaves the domain back
/// into it. The first generation is the same random population that the other methods start from.
///
/// **Limits.** n^2 / 2 numbers of memory per matrix and n^3 / 6 multiplications per generation: up to a few
/// hundred components. While the quadratic model is in use (up to 20 components) a generation is asked in parts
/// of a few positions: who evaluates hundreds at once leaves [`Ingredient::Model`] out.
///
/// ```
/// use aep_core::{Budget, Domain, FnProblem, Lineages, minimize};
/// let valley = FnProblem::new(Domain::cube(5, -5.0, 5.0)?, |x: &[f64]| {
///     x.windows(2).map(|x| 100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2)).sum()
/// });
/// let budget = Budget::evaluations(3_000).with_target(1e-8);
/// assert!(minimize(&valley, &Lineages::default(), budget, 1)?.cost <= 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// References: N. Hansen, "The CMA Evolution Strategy: A Tutorial", arXiv:1604.00772, 2016 (the
/// distribution); O. Krause, D. R. Arbones, C. Igel, NIPS 2016 (its Cholesky factor); N. Hansen, "A Global Surrogate
/// Assisted CMA-ES", GECCO 2019 (the model); S. Swarzberg, G. Seront, H. Bersini, "S.T.E.P.: the easiest way
/// to optimize a function", 1994 (the search along a component); N. Hansen, "Benchmarking a
/// BI-population CMA-ES", GECCO 2009 (large and small lineages).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lineages {
    /// Children of a generation of the first lineage; 0 for 4 + 3 ln n.
    pub population: usize,
    /// First step size in widths of the domain.
    pub sigma: f64,
    /// What is left out.
    pub left_out: Vec<Ingredient>,
}

impl Default for Lineages {
    fn default() -> Self {
        Self { population: 0, sigma: 0.2, left_out: Vec::new() }
    }
}

impl Lineages {
    /// The same with another population size.
    #[must_use]
    pub fn with_population(self, population: usize) -> Self {
        Self { population, ..self }
    }

    /// The same with another first step size.
    #[must_use]
    pub fn with_sigma(self, sigma: f64) -> Self {
        Self { sigma, ..self }
    }

    /// The same without `ingredient`.
    #[must_use]
    pub fn without(mut self, ingredient: Ingredient) -> Self {
        if self.uses(ingredient) {
            self.left_out.push(ingredient);
        }
        self
    }

    /// Whether `ingredient` is in.
    pub fn uses(&self, ingredient: Ingredient) -> bool {
        !self.left_out.contains(&ingredient)
    }

    /// Children of a generation of the first lineage in `dimension` components.
    fn lambda(&self, dimension: usize) -> usize {
        let usual = 4 + (3.0 * (dimension as f64).ln()) as usize;
        if self.population == 0 { usual } else { self.population }
    }

    fn check(&self, dimension: usize) -> Result<(), ConfigError> {
        let lambda = self.lambda(dimension);
        let hint = "at least four children are needed (0 takes 4 + 3 ln n)";
        ConfigError::require(lambda >= 4, NAME, "population", lambda as f64, hint)?;
        let valid = self.sigma > 0.0 && self.sigma.is_finite();
        ConfigError::require(valid, NAME, "sigma", self.sigma, "must be positive and finite")?;
        ConfigError::require_fits("covariance", dimension, dimension)
    }
}

const NAME: &str = "aep-lineages";

impl<T: Scalar> Method<T> for Lineages {
    fn name(&self) -> String {
        NAME.into()
    }

    fn start(&self, start: &Start<'_, T>) -> Result<Box<dyn Algorithm<T>>, ConfigError> {
        self.check(start.domain.dimension())?;
        Ok(Box::new(run::Run::new(self, start)?))
    }
}
