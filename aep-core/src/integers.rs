//! Components that are whole numbers.

use crate::{Batch, ConfigError, Domain, Points, Problem, Scalar};

/// Which components of a box are whole numbers, and between which.
///
/// An algorithm searches a whole component as a number from half below its lower to half above its upper limit, and the
/// cost sees it rounded: every whole number gets the same share.
#[derive(Clone, Debug)]
pub struct Whole<T: Scalar = f64> {
    limits: Vec<Option<(T, T)>>,
}

impl<T: Scalar> Whole<T> {
    /// The components between `lower` and `upper` that are `whole`, and the limits widened to what is searched.
    ///
    /// # Errors
    /// When the lengths differ, or there is no whole number between two limits.
    pub fn widening(lower: &mut [T], upper: &mut [T], whole: &[bool]) -> Result<Self, ConfigError> {
        let expected = lower.len();
        for (what, found) in [("upper limits", upper.len()), ("whole components", whole.len())] {
            if found != expected {
                return Err(ConfigError::Length { what, found, expected });
            }
        }
        let half = T::of(0.5);
        let mut limits = Vec::with_capacity(expected);
        for component in 0..expected {
            let (low, high) = (lower[component].ceil(), upper[component].floor());
            limits.push(whole[component].then_some((low, high)));
            if !whole[component] {
                continue;
            }
            // Limits that are NaN or infinite enclose none, either.
            if !(low <= high && (high - low).is_finite()) {
                let (lower, upper) = (lower[component].as_f64(), upper[component].as_f64());
                return Err(ConfigError::Limits { component, lower, upper });
            }
            (lower[component], upper[component]) = (low - half, high + half);
        }
        Ok(Self { limits })
    }

    /// Rounds the whole components of each row of `points` (problem coordinates).
    pub fn round(&self, points: &mut [T]) {
        if self.limits.iter().all(Option::is_none) {
            return;
        }
        for row in points.chunks_exact_mut(self.limits.len()) {
            for (x, limits) in row.iter_mut().zip(&self.limits) {
                if let Some((lower, upper)) = limits {
                    *x = x.round().max(*lower).min(*upper);
                }
            }
        }
    }
}

/// A problem some of whose components are whole numbers: it is only asked there.
///
/// Every method can search it. What a method finds is rounded by [`Integers::rounded`].
///
/// ```
/// use aep_core::{Aep, Budget, Domain, FnProblem, Integers, minimize};
/// // A ratio of 2.71 from two gears of 12 to 60 teeth each.
/// let ratio = FnProblem::new(Domain::cube(2, 12.0, 60.0)?, |x: &[f64]| (x[0] / x[1] - 2.71).abs());
/// let gears = Integers::new(ratio, &[true, true])?;
/// let outcome = minimize(&gears, &Aep::practical(), Budget::evaluations(4_000), 1)?;
/// let teeth = gears.rounded(&outcome.position);
/// assert_eq!(teeth, [46.0, 17.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// **Limits.** The cost is flat between whole numbers, so methods whose steps follow the cost ([`crate::Aep::paper`]) are out of
/// place, and residuals are not told: a descent sees no slope.
#[derive(Clone, Debug)]
pub struct Integers<P, T: Scalar = f64> {
    problem: P,
    domain: Domain<T>,
    whole: Whole<T>,
}

impl<T: Scalar, P: Problem<T>> Integers<P, T> {
    /// `problem`, whose components are whole numbers where `whole` says so.
    ///
    /// # Errors
    /// When there is not one entry per component, there is no whole number between two limits, or the limit of a logarithmic
    /// component is below 1.
    pub fn new(problem: P, whole: &[bool]) -> Result<Self, ConfigError> {
        let domain = problem.domain();
        let (mut lower, mut upper) = (domain.lower().to_vec(), domain.upper().to_vec());
        let whole = Whole::widening(&mut lower, &mut upper, whole)?;
        let names: Vec<String> = (0..domain.dimension()).map(|k| domain.name(k)).collect();
        let scales = domain.scales().to_vec();
        let domain = Domain::new(lower, upper)?.with_scales(scales)?.with_names(names)?;
        Ok(Self { problem, domain, whole })
    }

    /// A position (problem coordinates) as the cost sees it.
    pub fn rounded(&self, x: &[T]) -> Vec<T> {
        let mut x = x.to_vec();
        self.whole.round(&mut x);
        x
    }
}

impl<T: Scalar, P: Problem<T>> Problem<T> for Integers<P, T> {
    fn domain(&self) -> &Domain<T> {
        &self.domain
    }

    fn evaluate(&self, x: &[T]) -> T {
        self.problem.evaluate(&self.rounded(x))
    }

    fn evaluate_batch(&self, points: Batch<'_, T>, costs: &mut [T]) {
        let mut rounded = Points::zeros(points.len(), points.dimension());
        for (k, x) in points.rows().enumerate() {
            let row = rounded.row_mut(k);
            row.copy_from_slice(x);
            self.whole.round(row);
        }
        self.problem.evaluate_batch(rounded.batch(), costs);
    }

    fn around(&self) -> Option<&dyn Problem<T>> {
        Some(&self.problem)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Budget, Constrained, Errors, FnProblem, methods, minimize};
    use proptest::prelude::*;

    fn integers<F: Fn(&[f64]) -> f64 + Sync>(cost: F, whole: &[bool]) -> Integers<FnProblem<F>> {
        let domain = Domain::cube(whole.len(), -10.3, 7.8).unwrap();
        Integers::new(FnProblem::new(domain, cost), whole).unwrap()
    }

    #[test]
    fn the_best_whole_numbers_are_found_by_every_practical_method() {
        // Of the valley the whole numbers beside its minimum cost more than (3, -2).
        let cost = |x: &[f64]| {
            let (a, b) = (x[0] - 3.2, x[1] + 1.9);
            a * a + b * b + 1.5 * a * b + (x[2] - 0.25).powi(2)
        };
        let problem = integers(cost, &[true, true, false]);
        for method in ["aep-practical", "aep-lineages", "de", "cma-es"] {
            let method_of = (methods::find(method).unwrap().build)(0);
            let budget = Budget::evaluations(20_000);
            let found = minimize(&problem, &*method_of, budget, 5).unwrap();
            let x = problem.rounded(&found.position);
            assert_eq!((x[0], x[1]), (3.0, -2.0), "{method}: {x:?}");
            assert!((x[2] - 0.25).abs() < 1e-3, "{method}: {x:?}");
        }
    }

    #[test]
    fn every_whole_number_within_the_limits_has_the_same_share_and_none_beyond_is_asked() {
        let problem = integers(|x| x[0], &[true]);
        assert_eq!(
            (problem.domain().lower(), problem.domain().upper()),
            (&[-10.5][..], &[7.5][..])
        );
        let at = |share: f64| problem.evaluate(&[-10.5 + 18.0 * share]);
        let mut counts = std::collections::BTreeMap::new();
        for k in 0..1800 {
            *counts.entry(at((f64::from(k) + 0.5) / 1800.0) as i64).or_insert(0) += 1;
        }
        assert_eq!(counts.keys().copied().collect::<Vec<_>>(), (-10..=7).collect::<Vec<_>>());
        assert!(counts.values().all(|count| *count == 100), "{counts:?}");
    }

    #[test]
    fn limits_without_a_whole_number_between_them_are_refused() {
        let domain = Domain::new(vec![0.2, 0.0], vec![0.9, 5.0]).unwrap();
        let of = |whole: &[bool]| {
            Integers::new(FnProblem::new(domain.clone(), |x: &[f64]| x[0]), whole).map(|_| ())
        };
        let limits = ConfigError::Limits { component: 0, lower: 0.2, upper: 0.9 };
        assert_eq!(of(&[true, true]), Err(limits));
        assert_eq!(of(&[false, true]), Ok(()));
        assert!(matches!(of(&[true]), Err(ConfigError::Length { found: 1, expected: 2, .. })));
    }

    #[test]
    fn what_is_not_said_here_is_asked_of_the_problem_within() {
        struct Broken(Domain);
        impl Problem for Broken {
            fn domain(&self) -> &Domain {
                &self.0
            }
            fn evaluate(&self, _: &[f64]) -> f64 {
                f64::NAN
            }
            fn batch_size(&self) -> usize {
                7
            }
            fn errors(&self) -> Errors {
                Errors { count: 3, first: Some("broken".into()) }
            }
            fn is_broken_off(&self) -> bool {
                true
            }
            fn identity(&self) -> String {
                "within".into()
            }
        }
        let told = |problem: &dyn Problem| {
            let (size, errors) = (problem.batch_size(), problem.errors());
            (size, errors, problem.is_broken_off(), problem.identity())
        };
        let broken = || Broken(Domain::cube(1, 0.0, 3.0).unwrap());
        let whole = Integers::new(broken(), &[true]).unwrap();
        assert_eq!(told(&whole), told(&broken()));
        assert_eq!(told(&Constrained::new(&whole, 1.0, |_: &[f64]| vec![])), told(&broken()));
    }

    proptest! {
        #[test]
        fn a_batch_costs_what_its_rows_cost(rows in prop::collection::vec(-10.5..7.5, 9)) {
            let problem = integers(|x| x[0] + 100.0 * x[1] + 1e4 * x[2], &[true, false, true]);
            let mut costs = [0.0; 3];
            problem.evaluate_batch(Batch::new(3, &rows), &mut costs);
            for (row, cost) in rows.chunks(3).zip(costs) {
                prop_assert_eq!(problem.evaluate(row), cost);
                prop_assert_eq!(problem.rounded(row)[1], row[1]);
            }
        }
    }
}
