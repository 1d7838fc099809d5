//! What holds for every identification task.

use aep_core::random::Streams;
use aep_core::{Batch, Budget, LeastSquares, Problem, Purpose, Scale, methods, minimize, polish};
use aep_problems::tasks::{self, Identification, Task};

/// Positions anywhere in the domain.
fn somewhere(problem: &Identification, count: usize) -> Vec<Vec<f64>> {
    let domain = Problem::domain(problem);
    let streams = Streams::new(5, Purpose::Trial, 0);
    let place = |i: usize| {
        let (mut u, mut x) = (vec![0.0; domain.dimension()], vec![0.0; domain.dimension()]);
        domain.sample(&mut streams.stream(i), &mut u);
        domain.decode(&u, &mut x);
        x
    };
    (0..count).map(place).collect()
}

fn find(name: &str) -> &'static Task {
    tasks::find(name).unwrap()
}

#[test]
fn there_are_ten_or_more_and_each_name_stands_for_one() {
    assert!(tasks::ALL.len() >= 10);
    for (i, task) in tasks::ALL.iter().enumerate() {
        assert!(tasks::ALL[..i].iter().all(|other| other.name != task.name), "{}", task.name);
        assert!(aep_problems::find(task.name).is_none(), "{}", task.name);
    }
}

#[test]
fn the_truth_and_the_best_lie_inside_the_limits() {
    for task in tasks::ALL {
        let domain = task.domain();
        assert!(domain.contains(&task.truth()), "{}", task.name);
        assert!(domain.contains(task.best.position), "{}", task.name);
        for parameter in task.parameters {
            let decades = (parameter.limits.1 / parameter.limits.0).log10();
            let wide = parameter.scale == Scale::Linear || decades >= 1.0;
            assert!(!parameter.unit.is_empty() && wide, "{} {}", task.name, parameter.name);
        }
    }
}

#[test]
fn the_best_has_its_cost_and_nothing_beside_it_is_lower() {
    for task in tasks::ALL {
        let (problem, best) = (task.problem().without_noise(), task.best);
        let cost = problem.evaluate(best.position);
        assert!((cost / best.cost - 1.0).abs() < 1e-8, "{}: {cost} {}", task.name, best.cost);
        assert!(problem.evaluate(&task.truth()) >= cost, "{}", task.name);
        for start in [best.position, &task.truth()[..]] {
            let lower = polish(&problem, start).unwrap();
            assert!(lower.cost > best.cost * (1.0 - 1e-6), "{}: {lower:?}", task.name);
        }
    }
}

#[test]
fn no_method_finds_better_than_the_best_that_is_known() {
    for task in tasks::ALL {
        let problem = task.problem().without_noise();
        let evaluations = 300 * task.parameters.len() as u64;
        for name in ["cma-es", "de", "aep-practical"] {
            let method = (methods::find(name).unwrap().build)(0);
            let found = minimize(&problem, &*method, Budget::evaluations(evaluations), 11).unwrap();
            let found = polish(&problem, &found.position).unwrap();
            let least = task.best.cost * (1.0 - 1e-6);
            assert!(found.cost > least, "{}, {name}: {found:?}", task.name);
        }
    }
}

/// The sum of squares of N residuals with the true parameters has mean N and variance 2 N: five sigma.
/// Measured starts of the windows add to it.
#[test]
fn with_the_true_parameters_the_sensor_s_noise_remains() {
    for task in tasks::ALL.iter().filter(|task| task.name != "axis-in-windows") {
        let problem = task.problem();
        let count = problem.residuals(&task.truth()).len() as f64;
        let cost = problem.exact(&task.truth());
        assert!((cost - count).abs() < 5.0 * (2.0 * count).sqrt(), "{}: {cost}", task.name);
    }
}

#[test]
fn the_cost_is_the_sum_of_squared_residuals_and_a_batch_is_its_rows_to_the_bit() {
    for task in tasks::ALL {
        let problem = task.problem();
        let places = somewhere(&problem, 23);
        let one_by_one: Vec<f64> = places.iter().map(|x| problem.evaluate(x)).collect();
        for (x, cost) in places.iter().zip(&one_by_one) {
            let residuals = problem.residuals(x);
            assert_eq!(residuals.len(), problem.residuals(&task.truth()).len(), "{}", task.name);
            let sum: f64 = residuals.iter().map(|residual| residual * residual).sum();
            assert!(
                sum.to_bits() == cost.to_bits() || sum.is_nan() && cost.is_nan(),
                "{}",
                task.name
            );
        }
        let rows = places.concat();
        for size in [1, 3, 23] {
            let mut costs = Vec::new();
            for piece in rows.chunks(size * task.parameters.len()) {
                let batch = Batch::new(task.parameters.len(), piece);
                let mut found = vec![0.0; batch.len()];
                problem.evaluate_batch(batch, &mut found);
                costs.extend(found);
            }
            let bits = |costs: &[f64]| costs.iter().map(|cost| cost.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&costs), bits(&one_by_one), "{}", task.name);
        }
    }
}

#[test]
fn a_simulator_that_fails_in_half_of_the_domain_is_counted() {
    let problem = find("failing-rod").problem();
    let places = somewhere(&problem, 2_000);
    let failed = places.iter().filter(|x| problem.evaluate(x).is_nan()).count();
    // 0.45 to 0.55 is 4.5 sigma around one half.
    assert!((900..1_100).contains(&failed), "{failed}");
    let method = (methods::find("de").unwrap().build)(0);
    let found = minimize(&problem, &*method, Budget::evaluations(2_000), 1).unwrap();
    assert!(found.failures.non_finite > 20 && found.cost.is_finite(), "{:?}", found.failures);
}

#[test]
fn a_noisy_simulator_gives_another_cost_beside_and_the_same_one_again() {
    let problem = find("noisy-suspension").problem();
    let exact = problem.exact(problem.task().best.position);
    let beside = |i: usize| {
        let mut x = problem.task().best.position.to_vec();
        x[0] *= 1.0 + 1e-12 * i as f64;
        x
    };
    let noise: Vec<f64> = (0..1_000).map(|i| problem.evaluate(&beside(i)) - exact).collect();
    assert_eq!(problem.evaluate(&beside(7)) - exact, noise[7]);
    // Residuals r get w from N(0, s^2): their squares 2 r w + w^2 more, whose mean is N s^2 and whose
    // variance is 4 s^2 exact + 2 N s^4. Five sigma.
    let (count, s) = (600.0, problem.task().noise);
    let deviation = (4.0 * s * s * exact + 2.0 * count * s.powi(4)).sqrt();
    let mean = noise.iter().sum::<f64>() / noise.len() as f64;
    assert!((mean - count * s * s).abs() < 5.0 * deviation / 1_000_f64.sqrt(), "{mean}");
    assert_eq!(problem.exact(&beside(0)), exact);
    let still = find("noisy-suspension").problem().without_noise();
    assert_eq!(still.evaluate(still.task().best.position), exact);
}
