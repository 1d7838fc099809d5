//! Test functions for optimizers, with domain, optimum and reference, and identification tasks with a known best.
//!
//! [`ALL`] lists them; [`find`] gets one by name. A [`Definition`] becomes a problem with
//! [`Definition::usual`] or [`Definition::in_dimension`], and [`TestProblem`] can move its optimum
//! away from the middle of the domain, which flatters many methods. [`tasks`] are fits of models to recordings.
//!
//! ```
//! use aep_core::{Aep, Budget, minimize};
//!
//! let problem = aep_problems::F1.usual().with_random_shift(1);
//! let budget = Budget::generations(2_000).with_target(problem.target());
//! let outcome = minimize(&problem, &Aep::paper(), budget, 1)?;
//! assert!(outcome.cost < 1e-8);
//! # Ok::<(), aep_core::RunError>(())
//! ```

mod definition;
mod dejong;
mod known;
mod noise;
pub mod paper;
mod problem;
mod suite;
pub mod tasks;

pub use definition::{Definition, Dimension, Shift};
pub use dejong::{F1, F2, F3, F4, F5};
pub use known::Known;
pub use problem::{ProblemError, TestProblem};
pub use suite::{
    ACKLEY, ELLIPSOID, GRIEWANK, LEVY, POWERS, RASTRIGIN, ROSENBROCK, SCHWEFEL, SCHWEFEL_1_2,
    SPHERE,
};

/// All functions, in the order they are listed.
pub const ALL: &[Definition] = &[
    F1,
    F2,
    F3,
    F4,
    F5,
    SPHERE,
    ELLIPSOID,
    SCHWEFEL_1_2,
    POWERS,
    ROSENBROCK,
    RASTRIGIN,
    ACKLEY,
    GRIEWANK,
    SCHWEFEL,
    LEVY,
];

/// The function called `name`.
pub fn find(name: &str) -> Option<&'static Definition> {
    ALL.iter().find(|definition| definition.name == name)
}

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests {
    use aep_core::Problem;

    use super::*;

    #[test]
    fn no_sampled_position_is_better_than_the_stated_optimum() {
        for definition in ALL {
            for problem in [definition.usual(), definition.usual().with_random_shift(3)] {
                let best = problem.evaluate(problem.optimum());
                assert!((best - problem.optimal_cost()).abs() < 1e-9, "{}", definition.name);
                assert!(problem.domain().contains(problem.optimum()), "{}", definition.name);
                let mut z = problem.optimum().to_vec();
                let streams = aep_core::Streams::new(1, aep_core::Purpose::Trial, 9);
                for i in 0..2_000 {
                    let mut rng = streams.stream(i);
                    problem.domain().sample(&mut rng, &mut z);
                    assert!(problem.evaluate(&z) >= best - 1e-9, "{} {z:?}", definition.name);
                }
            }
        }
    }

    #[test]
    fn the_optimum_of_f5_is_the_published_one() {
        assert!((F5.usual().optimal_cost() - 0.998_003_838).abs() < 1e-9);
    }

    #[test]
    fn aep_finds_the_deepest_foxhole_in_every_trial_with_both_of_the_papers_settings() {
        let figure = paper::find("fig6").unwrap();
        for (beta1, beta2) in [(5.0, 0.05), (30.0, 0.3)] {
            let aep = aep_core::Aep::paper().with_beta(beta1, beta2);
            let summary = figure.run(&aep, 50, 1).unwrap().summary(figure.target);
            assert_eq!(summary.successes, 50, "{beta1} {beta2}");
        }
    }

    #[test]
    fn names_are_unique() {
        for (i, definition) in ALL.iter().enumerate() {
            assert!(ALL[..i].iter().all(|other| other.name != definition.name));
        }
    }

    #[test]
    fn noise_is_standard_normal_and_repeatable() {
        let noisy = F4.usual().with_noise(5);
        let z = |i: usize| vec![i as f64 * 1e-6; 30];
        let noise: Vec<f64> =
            (0..20_000).map(|i| noisy.evaluate(&z(i)) - F4.usual().evaluate(&z(i))).collect();
        let mean = noise.iter().sum::<f64>() / noise.len() as f64;
        let variance = noise.iter().map(|x| x * x).sum::<f64>() / noise.len() as f64;
        // Five sigma: fails once in 10^6 changes of the seed.
        assert!(mean.abs() < 5.0 / 141.0, "{mean}");
        assert!((variance - 1.0).abs() < 5.0 * 1.42 / 141.0, "{variance}");
        assert_eq!(noisy.evaluate(&z(1)), noisy.evaluate(&z(1)));
    }

    #[test]
    fn a_dimension_that_is_not_defined_is_refused() {
        let error = find("f5").unwrap().in_dimension(3).unwrap_err();
        assert!(error.to_string().contains("defined for 2"));
    }
}
