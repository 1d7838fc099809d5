//! To the bottom of the valley that a search has found.

use super::{LeastSquares, LevenbergMarquardt, Refined};
use crate::ConfigError;

/// Most steps.
const MOST_STEPS: usize = 60;
/// First and last half-width of a difference, as a share of the domain's width. Wide ones see over
/// roughness, narrow ones are exact.
const WIDTHS: (f64, f64) = (2e-2, 1e-6);
/// By how much a difference narrows where it no longer leads down.
const NARROWER: f64 = 0.3;
/// Relative fall of the cost that counts as leading down.
const WORTHWHILE: f64 = 1e-3;

/// Goes down from `x`, such as [`crate::Outcome::position`], to the nearest minimum of a sum of
/// squares by [`LevenbergMarquardt`]. Limits of the domain are respected: a component that lies at
/// one and would be pushed out is held there while the others are fitted. The cost never rises.
///
/// `x` is in problem coordinates; what lies outside the domain is moved to its limit first. At most
/// 60 steps of 2 n + 9 evaluations for n components.
///
/// ```
/// use aep_core::{Domain, FnResiduals, polish};
/// // Rosenbrock's valley, whose bottom is at (1, 1).
/// let valley = FnResiduals::new(Domain::cube(2, -6.0, 6.0)?, |x: &[f64]| {
///     vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]
/// });
/// let bottom = polish(&valley, &[-1.2, 1.0])?;
/// assert!(bottom.cost < 1e-20);
/// # Ok::<(), aep_core::ConfigError>(())
/// ```
///
/// # Errors
/// When `x` does not have one finite number per component of the domain.
pub fn polish<P: LeastSquares + ?Sized>(problem: &P, x: &[f64]) -> Result<Refined, ConfigError> {
    let domain = problem.domain();
    let expected = domain.dimension();
    if x.len() != expected {
        return Err(ConfigError::Length { what: "start of a polish", found: x.len(), expected });
    }
    if let Some(component) = x.iter().position(|x| !x.is_finite()) {
        return Err(ConfigError::InitialPoint { point: 0, component, value: x[component] });
    }
    let inside: Vec<f64> = (x.iter().enumerate())
        .map(|(k, x)| x.clamp(domain.lower()[k], domain.upper()[k]))
        .collect();
    let mut descent = LevenbergMarquardt::new(problem, &inside).with_held_bounds();
    let mut width = WIDTHS.0;
    for _ in 0..MOST_STEPS {
        let before = descent.at().cost;
        descent.step(width);
        if before - descent.at().cost > WORTHWHILE * before {
            continue;
        }
        width *= NARROWER;
        if width < WIDTHS.1 {
            break;
        }
    }
    Ok(descent.into_refined())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, FnResiduals, Scale};

    /// Residuals of a straight line a + b t through four points.
    fn line(domain: Domain) -> FnResiduals<impl Fn(&[f64]) -> Vec<f64> + Sync> {
        let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 4.0), (3.0, 4.0)];
        FnResiduals::new(domain, move |x: &[f64]| {
            points.iter().map(|(t, y)| x[0] + x[1] * t - y).collect()
        })
    }

    fn close(found: &[f64], expected: &[f64]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-9 * expected.abs().max(1.0),
                "{found} {expected}"
            );
        }
    }

    #[test]
    fn a_straight_line_gets_the_coefficients_of_the_normal_equations() {
        // b = (n sum ty - sum t sum y) / (n sum tt - (sum t)^2) = (92 - 72) / (56 - 36) = 1,
        // a = (12 - 6 b) / 4 = 1.5; every residual that is left is 0.5 or -0.5.
        let line = line(Domain::cube(2, -10.0, 10.0).unwrap());
        let found = polish(&line, &[-7.0, 9.0]).unwrap();
        close(&found.position, &[1.5, 1.0]);
        close(&[found.cost], &[1.0]);
    }

    #[test]
    fn at_a_limit_the_other_components_are_the_best_for_it() {
        // With b at most 0.5: a = (12 - 6 b) / 4 = 2.25.
        let domain = Domain::new(vec![-10.0, -10.0], vec![10.0, 0.5]).unwrap();
        let found = polish(&line(domain), &[-7.0, 0.4]).unwrap();
        assert_eq!(found.position[1], 0.5);
        close(&found.position, &[2.25, 0.5]);
    }

    #[test]
    fn a_logarithmic_component_is_found_over_decades() {
        let domain = Domain::new(vec![1e-6, 0.0], vec![1e6, 10.0]).unwrap();
        let domain = domain.with_scales(vec![Scale::Log, Scale::Linear]).unwrap();
        let decay = FnResiduals::new(domain, |x: &[f64]| {
            (0..20)
                .map(|i| x[1] * (-f64::from(i) / x[0]).exp() - 2.0 * (-f64::from(i) / 5.0).exp())
                .collect()
        });
        close(&polish(&decay, &[300.0, 9.0]).unwrap().position, &[5.0, 2.0]);
    }

    #[test]
    fn a_component_without_influence_stays_and_does_not_stop_the_others() {
        let blind = FnResiduals::new(Domain::cube(2, -4.0, 4.0).unwrap(), |x: &[f64]| {
            vec![x[0] - 3.0, 0.1 * (x[0] - 3.0).powi(2)]
        });
        let found = polish(&blind, &[-1.0, 2.0]).unwrap();
        close(&found.position, &[3.0, 2.0]);
    }

    #[test]
    fn where_residuals_are_not_finite_it_stays() {
        let broken =
            FnResiduals::new(Domain::cube(1, 0.0, 1.0).unwrap(), |_: &[f64]| vec![f64::NAN]);
        assert_eq!(polish(&broken, &[0.3]).unwrap().position, [0.3]);
    }

    #[test]
    fn a_start_that_is_none_is_refused() {
        let line = line(Domain::cube(2, -10.0, 10.0).unwrap());
        assert!(matches!(polish(&line, &[1.0]), Err(ConfigError::Length { .. })));
        let start = polish(&line, &[1.0, f64::NAN]);
        assert!(matches!(start, Err(ConfigError::InitialPoint { component: 1, .. })));
    }
}
