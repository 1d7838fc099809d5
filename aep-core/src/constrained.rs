//! Constraints by the feasibility rule.

use std::fmt;

use crate::{Batch, Domain, Points, Problem, Scalar};

/// A problem with inequality constraints `g_i`(x) <= 0, by Deb's feasibility rule: what is feasible is
/// better than what is not, of two feasible positions the one with the lower cost is better, of two
/// infeasible ones that with the smaller violation, the sum of all `g_i` > 0.
///
/// The cost of an infeasible position is `ceiling` + violation. Deb takes for the ceiling the worst
/// feasible cost of the population; here it is given, since a cost must not depend on which other
/// positions are evaluated beside it. Nothing has to be weighed against the cost, as a penalty factor
/// would have to be, and the problem is never asked outside the constraints, so that a simulator need
/// not bear what they exclude.
///
/// **The ceiling** is a cost that no feasible position of interest exceeds. Much larger is harmless until
/// digits of the violation get lost beside it. Scale the constraints so that violations of 1 are about
/// equally bad. An equality h(x) = 0 is written |h(x)| - tolerance.
///
/// **Limits.** The cost jumps at the border of the feasible region, so methods whose steps follow the cost
/// ([`crate::Aep::paper`]) are out of place, and so is a region without volume.
///
/// ```
/// use aep_core::{Aep, Budget, Constrained, Domain, FnProblem, minimize};
/// // The point of the half-plane x + y >= 1 that is nearest to the origin.
/// let square = FnProblem::new(Domain::cube(2, -6.0, 6.0)?, |x: &[f64]| x[0].powi(2) + x[1].powi(2));
/// let nearest = Constrained::new(square, 100.0, |x: &[f64]| vec![1.0 - x[0] - x[1]]);
/// let outcome = minimize(&nearest, &Aep::practical(), Budget::evaluations(20_000), 1)?;
/// assert!((outcome.cost - 0.5).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Reference: K. Deb, "An efficient constraint handling method for genetic algorithms", Computer
/// Methods in Applied Mechanics and Engineering 186, 2000.
#[derive(Clone)]
pub struct Constrained<P, G, T: Scalar = f64> {
    problem: P,
    constraints: G,
    ceiling: T,
}

impl<T: Scalar, P: Problem<T>, G: Fn(&[T]) -> Vec<T> + Sync> Constrained<P, G, T> {
    /// `problem` where all `constraints` (problem coordinates) are 0 or negative.
    pub fn new(problem: P, ceiling: T, constraints: G) -> Self {
        Self { problem, constraints, ceiling }
    }

    /// By how much `x` (problem coordinates) violates the constraints: 0 where it is feasible,
    /// infinite where a constraint is NaN.
    pub fn violation(&self, x: &[T]) -> T {
        let over = |g: T| if g.is_nan() { T::infinity() } else { g.max(T::zero()) };
        (self.constraints)(x).into_iter().fold(T::zero(), |sum, g| sum + over(g))
    }

    /// Whether `x` (problem coordinates) meets all constraints.
    pub fn is_feasible(&self, x: &[T]) -> bool {
        self.violation(x) <= T::zero()
    }
}

impl<P: fmt::Debug, G, T: Scalar> fmt::Debug for Constrained<P, G, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut out = f.debug_struct("Constrained");
        out.field("problem", &self.problem).field("ceiling", &self.ceiling).finish_non_exhaustive()
    }
}

impl<T: Scalar, P: Problem<T>, G: Fn(&[T]) -> Vec<T> + Sync> Problem<T> for Constrained<P, G, T> {
    fn domain(&self) -> &Domain<T> {
        self.problem.domain()
    }

    fn evaluate(&self, x: &[T]) -> T {
        let violation = self.violation(x);
        if violation > T::zero() { self.ceiling + violation } else { self.problem.evaluate(x) }
    }

    fn evaluate_batch(&self, points: Batch<'_, T>, costs: &mut [T]) {
        let mut feasible = Vec::new();
        for (i, (x, cost)) in points.rows().zip(costs.iter_mut()).enumerate() {
            let violation = self.violation(x);
            *cost = self.ceiling + violation;
            if violation <= T::zero() {
                feasible.push(i);
            }
        }
        let mut inside = Points::zeros(feasible.len(), points.dimension());
        for (row, i) in feasible.iter().enumerate() {
            inside.row_mut(row).copy_from_slice(points.row(*i));
        }
        let mut found = vec![T::nan(); feasible.len()];
        self.problem.evaluate_batch(inside.batch(), &mut found);
        for (i, cost) in feasible.into_iter().zip(found) {
            costs[i] = cost;
        }
    }

    fn around(&self) -> Option<&dyn Problem<T>> {
        Some(&self.problem)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Budget, FnProblem, methods, minimize};

    fn found(problem: &dyn Problem, method: &str) -> Vec<f64> {
        let method = (methods::find(method).unwrap().build)(0);
        minimize(problem, &*method, Budget::evaluations(40_000), 3).unwrap().position
    }

    #[test]
    fn the_nearest_point_of_a_half_plane_is_found_by_every_practical_method() {
        let square = FnProblem::new(Domain::cube(2, -6.0, 6.0).unwrap(), |x: &[f64]| {
            x[0] * x[0] + x[1] * x[1]
        });
        // By Lagrange (a, b) c / (a^2 + b^2) for a x + b y >= c.
        let nearest = Constrained::new(square, 100.0, |x: &[f64]| vec![5.0 - x[0] - 2.0 * x[1]]);
        for method in ["aep-practical", "de", "cma-es"] {
            let x = found(&nearest, method);
            assert!(nearest.is_feasible(&x), "{method}: {x:?}");
            let away = (x[0] - 1.0).hypot(x[1] - 2.0);
            assert!(away < 1e-3, "{method}: {x:?}");
        }
    }

    #[test]
    fn where_two_constraints_meet_the_corner_is_found() {
        let plane = FnProblem::new(Domain::cube(2, 0.0, 10.0).unwrap(), |x: &[f64]| {
            -3.0 * x[0] - 5.0 * x[1]
        });
        // The linear programme with x <= 4, 2 y <= 12, 3 x + 2 y <= 18: (2, 6), -36.
        let constraints =
            |x: &[f64]| vec![x[0] - 4.0, 2.0 * x[1] - 12.0, 3.0 * x[0] + 2.0 * x[1] - 18.0];
        let programme = Constrained::new(plane, 1.0, constraints);
        for method in ["aep-practical", "de", "cma-es"] {
            let x = found(&programme, method);
            assert!((x[0] - 2.0).hypot(x[1] - 6.0) < 1e-2, "{method}: {x:?}");
        }
    }

    #[test]
    fn the_feasible_come_first_and_the_problem_is_never_asked_outside() {
        let domain = Domain::cube(1, -10.0, 10.0).unwrap();
        let inside = FnProblem::new(domain, |x: &[f64]| {
            assert!(x[0] >= 1.0, "asked outside");
            x[0]
        });
        let problem = Constrained::new(inside, 50.0, |x: &[f64]| {
            vec![if x[0] < -5.0 { f64::NAN } else { 1.0 - x[0] }, -1.0]
        });
        let x = [9.0, 1.0, 0.5, -4.0, -6.0];
        let mut costs = [0.0; 5];
        problem.evaluate_batch(Batch::new(1, &x), &mut costs);
        assert_eq!(costs, [9.0, 1.0, 50.5, 55.0, f64::INFINITY]);
        assert_eq!(costs.to_vec(), x.map(|x| problem.evaluate(&[x])).to_vec());
    }
}
