//! Costs that are sums of squares, and the way to the bottom of their valleys.

mod descent;
mod noted;
mod polish;

pub use descent::{LevenbergMarquardt, Refined};
pub(crate) use noted::Noted;
pub use polish::polish;

use crate::{Batch, Budget, Domain, Lineages, Outcome, Problem, RunError, minimize};

/// A task whose cost is the sum of squared residuals: a fit of a curve, of a model, of a simulation.
///
/// One `impl` of two methods, or a closure in [`FnResiduals`]. [`SumOfSquares`] makes it a
/// [`Problem`], so that every method searches it; [`polish`] then goes from what a search found to
/// the bottom of that valley, in a few steps where a search needs thousands of evaluations.
///
/// ```
/// use aep_core::{Aep, Budget, Domain, FnResiduals, SumOfSquares, minimize, polish};
///
/// // y = a exp(-b t), measured at four times.
/// let (t, y) = ([0.0_f64, 1.0, 2.0, 3.0], [2.0, 1.213, 0.736, 0.446]);
/// let domain = Domain::new(vec![0.0, 0.0], vec![10.0, 5.0])?;
/// let decay = FnResiduals::new(domain, |x: &[f64]| {
///     t.iter().zip(&y).map(|(t, y)| x[0] * (-x[1] * t).exp() - y).collect()
/// });
///
/// let found = minimize(&SumOfSquares(&decay), &Aep::practical(), Budget::evaluations(400), 1)?;
/// let fit = polish(&decay, &found.position)?;
/// assert!(fit.cost <= found.cost && (fit.position[1] - 0.5).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait LeastSquares: Sync {
    /// Where the task is defined.
    fn domain(&self) -> &Domain;

    /// The residuals at `x` (problem coordinates), in one unit; their number is the same everywhere.
    /// One that is not finite makes `x` a place that no polish goes to.
    fn residuals(&self, x: &[f64]) -> Vec<f64>;

    /// The residuals of many positions, in their order. Override it where they are quicker together.
    fn residuals_batch(&self, points: Batch<'_>) -> Vec<Vec<f64>> {
        points.rows().map(|x| self.residuals(x)).collect()
    }

    /// The cost of residuals: the sum of their squares. Who overrides it may only scale that.
    fn cost(&self, residuals: &[f64]) -> f64 {
        residuals.iter().map(|residual| residual * residual).sum()
    }

    /// The cost at `x`: that of its residuals. Who overrides it may only scale that, as in [`LeastSquares::cost`].
    fn objective(&self, x: &[f64]) -> f64 {
        self.cost(&self.residuals(x))
    }

    /// The costs of many positions: `costs[i]` belongs to `points.row(i)`.
    fn objective_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        for (x, cost) in points.rows().zip(costs) {
            *cost = self.objective(x);
        }
    }
}

impl<P: LeastSquares + ?Sized> LeastSquares for &P {
    fn domain(&self) -> &Domain {
        (**self).domain()
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        (**self).residuals(x)
    }

    fn residuals_batch(&self, points: Batch<'_>) -> Vec<Vec<f64>> {
        (**self).residuals_batch(points)
    }

    fn cost(&self, residuals: &[f64]) -> f64 {
        (**self).cost(residuals)
    }

    fn objective(&self, x: &[f64]) -> f64 {
        (**self).objective(x)
    }

    fn objective_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        (**self).objective_batch(points, costs);
    }
}

/// A closure that gives the residuals of a position.
#[derive(Clone, Debug)]
pub struct FnResiduals<F> {
    domain: Domain,
    residuals: F,
}

impl<F: Fn(&[f64]) -> Vec<f64> + Sync> FnResiduals<F> {
    /// The task of making `residuals` small in `domain`.
    pub fn new(domain: Domain, residuals: F) -> Self {
        Self { domain, residuals }
    }
}

impl<F: Fn(&[f64]) -> Vec<f64> + Sync> LeastSquares for FnResiduals<F> {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        (self.residuals)(x)
    }
}

/// A [`LeastSquares`] task as a [`Problem`]: its cost is [`LeastSquares::objective`].
#[derive(Clone, Copy, Debug)]
pub struct SumOfSquares<P>(pub P);

impl<P: LeastSquares> Problem for SumOfSquares<P> {
    fn domain(&self) -> &Domain {
        self.0.domain()
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        self.0.objective(x)
    }

    fn evaluate_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        self.0.objective_batch(points, costs);
    }

    fn as_least_squares(&self) -> Option<&dyn LeastSquares> {
        Some(&self.0)
    }
}

/// Minimises a sum of squares within `budget` on the calling thread: descents on the residuals and a search beside
/// them, by [`Lineages`]. Every evaluation counts as one, those of finite differences, too.
///
/// It is [`minimize`] of [`SumOfSquares`]: a [`crate::Driver`] has the rest (threads, observers, checkpoints, a stop flag).
///
/// ```
/// use aep_core::{Budget, Domain, FnResiduals, least_squares};
/// // Two decays, from twenty samples.
/// let domain = Domain::new(vec![0.0, 0.0, 0.0, 0.0], vec![5.0, 5.0, 5.0, 5.0])?;
/// let sum = |x: &[f64], t: f64| x[0] * (-x[1] * t).exp() + x[2] * (-x[3] * t).exp();
/// let decays = FnResiduals::new(domain, |x: &[f64]| {
///     (0..20).map(|i| f64::from(i) / 4.0).map(|t| sum(x, t) - sum(&[2.0, 0.5, 1.0, 3.0], t)).collect()
/// });
/// let found = least_squares(&decays, Budget::evaluations(2_000).with_target(1e-12), 1)?;
/// assert!(found.cost <= 1e-12 && found.evaluations < 500);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`minimize`].
pub fn least_squares<P: LeastSquares + ?Sized>(
    problem: &P,
    budget: Budget,
    seed: u64,
) -> Result<Outcome, RunError> {
    minimize(&SumOfSquares(problem), &Lineages::default(), budget, seed)
}
