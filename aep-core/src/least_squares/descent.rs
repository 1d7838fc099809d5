//! Levenberg-Marquardt, step by step, on the scales of the domain.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::LeastSquares;
use crate::Batch;

/// Dampings that are tried at once, as multiples of the last one that led down.
const DAMPINGS: [f64; 8] = [1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e4, 1e6];
/// Damping of the first step.
const FIRST_DAMPING: f64 = 1e-3;
/// Least damping: below it nothing changes.
const LEAST_DAMPING: f64 = 1e-9;
/// Longest change of a component in one step, as a share of the domain's width: beyond it no
/// linearisation holds.
const LONGEST: f64 = 0.5;

/// A point and its cost.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Refined {
    /// The position, in problem coordinates.
    pub position: Vec<f64>,
    /// Its cost.
    pub cost: f64,
}

/// A descent in damped Gauss-Newton steps; never up, never out of the domain.
///
/// With the Jacobian J of the residuals r by central differences, in shares of the domain's width
/// (on its scale: a logarithmic component is moved by factors), a step solves
///
/// (J'J + lambda diag J'J) s = -J'r
///
/// for eight lambda around the last one that led down, and takes the one with the lowest cost. All
/// differences are one batch, all trials another: a simulator that runs many lanes at once is asked
/// twice per step.
///
/// The loop around the steps is the caller's: [`super::polish`] has the usual one.
///
/// **Limits.** n + 1 columns of residuals in memory; differences of a rough cost need a width above
/// its roughness.
///
/// References: K. Levenberg, Quarterly of Applied Mathematics 2, 1944; D. Marquardt, J. SIAM 11, 1963.
#[derive(Debug)]
pub struct LevenbergMarquardt<'a, P: ?Sized> {
    problem: &'a P,
    at: Refined,
    active: Vec<usize>,
    damping: f64,
    bounds: Bounds,
}

/// What a step does at the limits of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bounds {
    /// Components are clipped after the step.
    Clip,
    /// Components that the step would push out are held, so that the others make up for it.
    Hold,
}

/// J'J and -J'r over the active components.
type Normal = (DMatrix<f64>, DVector<f64>);

impl<'a, P: LeastSquares + ?Sized> LevenbergMarquardt<'a, P> {
    /// A descent from `x`, one number per component of the domain, inside it.
    pub fn new(problem: &'a P, x: &[f64]) -> Self {
        let at = Refined { position: x.to_vec(), cost: problem.objective(x) };
        let active = (0..x.len().min(problem.domain().dimension())).collect();
        Self { problem, at, active, damping: FIRST_DAMPING, bounds: Bounds::Clip }
    }

    /// The same with `component` left where it is.
    #[must_use]
    pub fn holding(mut self, component: usize) -> Self {
        self.active.retain(|k| *k != component);
        self
    }

    /// The same with components held, for a step, that lie at a limit and would be pushed out.
    /// Otherwise a step is only clipped, which stalls where they go together with others.
    #[must_use]
    pub fn with_held_bounds(self) -> Self {
        Self { bounds: Bounds::Hold, ..self }
    }

    /// Where it stands.
    pub fn at(&self) -> &Refined {
        &self.at
    }

    /// Where it stands, at the end.
    pub fn into_refined(self) -> Refined {
        self.at
    }

    /// The components that it moves.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// One step down, if there is one, with differences of half-width `width`, a share of the domain's.
    pub fn step(&mut self, width: f64) {
        let mut active = self.active.clone();
        let Some(mut normal) = self.normal(&active, width) else { return };
        if self.bounds == Bounds::Hold {
            let kept: Vec<usize> =
                (0..active.len()).filter(|j| !self.pushed_out(active[*j], normal.1[*j])).collect();
            active = kept.iter().map(|j| active[*j]).collect();
            normal = (
                DMatrix::from_fn(kept.len(), kept.len(), |i, j| normal.0[(kept[i], kept[j])]),
                DVector::from_fn(kept.len(), |i, _| normal.1[kept[i]]),
            );
        }
        if active.is_empty() {
            return;
        }
        let tried: Vec<f64> =
            DAMPINGS.iter().map(|by| (by * self.damping).max(LEAST_DAMPING)).collect();
        let moved = |damping: &f64| Some((*damping, self.moved(&active, &normal, *damping)?));
        let (tried, trials): (Vec<f64>, Vec<Vec<f64>>) = tried.iter().filter_map(moved).unzip();
        if let Some(best) = self.take_best(&trials) {
            self.damping = tried[best];
        }
    }

    /// Goes to the best of `trials` if that is lower; its index then.
    pub fn take_best(&mut self, trials: &[Vec<f64>]) -> Option<usize> {
        let mut costs = vec![f64::INFINITY; trials.len()];
        let points = trials.concat();
        self.problem.objective_batch(Batch::new(self.at.position.len(), &points), &mut costs);
        // What is not a number is never lower, not even with the sign by which `total_cmp` puts it first.
        let lower = (0..trials.len()).filter(|k| costs[*k] < self.at.cost);
        let best = lower.min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
        self.at = Refined { position: trials[best].clone(), cost: costs[best] };
        Some(best)
    }

    /// Normal matrix and moment of the residuals, in shares of the widths; none where one is not
    /// finite, or not all positions have as many.
    fn normal(&self, active: &[usize], width: f64) -> Option<Normal> {
        let (x, domain) = (&self.at.position, self.problem.domain());
        let mut candidates = vec![x.clone()];
        for k in active {
            for sign in [1.0, -1.0] {
                let mut candidate = x.clone();
                candidate[*k] = domain.shifted(*k, x[*k], sign * width);
                candidates.push(candidate);
            }
        }
        let residuals = self.problem.residuals_batch(Batch::new(x.len(), &candidates.concat()));
        // Rows of another length make no matrix.
        let count = residuals.first()?.len();
        if residuals.len() != candidates.len() || residuals.iter().any(|row| row.len() != count) {
            return None;
        }
        // A difference that a bound has cut short is as wide as it is.
        let share = |candidate: usize, k: usize| domain.share(k, candidates[candidate][k]);
        let widths: Vec<f64> = (active.iter().enumerate())
            .map(|(j, k)| share(2 * j + 1, *k) - share(2 * j + 2, *k))
            .collect();
        let slopes = DMatrix::from_fn(count, active.len(), |i, j| {
            let change = residuals[2 * j + 1][i] - residuals[2 * j + 2][i];
            if change.is_finite() && widths[j] > 0.0 { change / widths[j] } else { 0.0 }
        });
        let residuals = DVector::from_column_slice(&residuals[0]);
        let finite = residuals.iter().all(|residual| residual.is_finite());
        finite.then(|| (slopes.tr_mul(&slopes), -slopes.tr_mul(&residuals)))
    }

    fn pushed_out(&self, k: usize, moment: f64) -> bool {
        let (x, domain) = (self.at.position[k], self.problem.domain());
        (x <= domain.lower()[k] && moment <= 0.0) || (x >= domain.upper()[k] && moment >= 0.0)
    }

    /// Where the step with `damping` leads, if it can be solved for.
    fn moved(&self, active: &[usize], (normal, moment): &Normal, damping: f64) -> Option<Vec<f64>> {
        let largest = normal.diagonal().max();
        let mut damped = normal.clone();
        for k in 0..active.len() {
            damped[(k, k)] *= 1.0 + damping;
            // A component that changes nothing must not make the matrix singular.
            damped[(k, k)] += 1e-15 * largest + f64::MIN_POSITIVE;
        }
        // Slopes near the largest numbers can leave none.
        let change = damped.cholesky()?.solve(moment);
        if !change.iter().all(|change| change.is_finite()) {
            return None;
        }
        let mut x = self.at.position.clone();
        for (k, change) in active.iter().zip(change.iter()) {
            let change = change.clamp(-LONGEST, LONGEST);
            x[*k] = self.problem.domain().shifted(*k, x[*k], change);
        }
        Some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;

    /// (x - 3)^2; beyond 4 not a number, with the sign bit set.
    struct Edge(Domain);

    impl LeastSquares for Edge {
        fn domain(&self) -> &Domain {
            &self.0
        }

        fn residuals(&self, x: &[f64]) -> Vec<f64> {
            vec![x[0] - 3.0]
        }

        fn objective(&self, x: &[f64]) -> f64 {
            if x[0] > 4.0 { f64::NAN.copysign(-1.0) } else { (x[0] - 3.0).powi(2) }
        }
    }

    #[test]
    fn a_cost_that_is_not_a_number_does_not_hide_a_lower_one() {
        let task = Edge(Domain::cube(1, 0.0, 10.0).unwrap());
        let mut descent = LevenbergMarquardt::new(&task, &[1.0]);
        assert_eq!(descent.take_best(&[vec![5.0], vec![2.0], vec![0.5]]), Some(1));
        assert_eq!(descent.take_best(&[vec![5.0], vec![1.0]]), None);
    }
}
