//! What a method promises that is told residuals.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use aep_core::{
    Algorithm, Budget, Domain, Driver, FnProblem, FnResiduals, Ingredient, LeastSquares, Lineages,
    Method, Outcome, Problem, Progress, Start, StopReason, SumOfSquares, least_squares, minimize,
};

/// Two decays with amplitudes and rates, sampled without noise.
fn decays() -> FnResiduals<impl Fn(&[f64]) -> Vec<f64> + Sync> {
    let sum = |x: &[f64], t: f64| x[0] * (-x[1] * t).exp() + x[2] * (-x[3] * t).exp();
    FnResiduals::new(Domain::cube(4, 0.0, 5.0).unwrap(), move |x: &[f64]| {
        let at = |i: i32| f64::from(i) / 5.0;
        (0..30).map(at).map(|t| sum(x, t) - sum(&[2.0, 0.5, 1.0, 3.0], t)).collect()
    })
}

/// The same with residuals in steps: no difference narrower than a step tells a slope.
fn stairs() -> FnResiduals<impl Fn(&[f64]) -> Vec<f64> + Sync> {
    let domain = Domain::cube(3, -5.0, 5.0).unwrap();
    FnResiduals::new(domain, |x: &[f64]| {
        let step = |v: f64| (10.0 * v).round() / 10.0;
        vec![step(x[0] - 1.0), 3.0 * step(x[1] + x[0]), step(x[2] * x[1] - 2.0)]
    })
}

fn without_time(mut outcome: Outcome) -> Outcome {
    outcome.elapsed = Duration::ZERO;
    outcome
}

fn median(mut numbers: Vec<u64>) -> u64 {
    numbers.sort_unstable();
    numbers[numbers.len() / 2]
}

#[test]
fn residuals_save_most_of_the_evaluations() {
    let budget = || Budget::evaluations(20_000).with_target(1e-8);
    let told = |seed| least_squares(&decays(), budget(), seed).unwrap();
    let blind = Lineages::default().without(Ingredient::Descents);
    let searched = |seed| minimize(&SumOfSquares(decays()), &blind, budget(), seed).unwrap();
    let used = |run: &dyn Fn(u64) -> Outcome| {
        let outcomes = (1..=9).map(run);
        let solved = outcomes.inspect(|outcome| assert_eq!(outcome.stop, StopReason::Target));
        median(solved.map(|outcome| outcome.evaluations).collect())
    };
    let (told, searched) = (used(&told), used(&searched));
    assert!(3 * told < searched, "{told} {searched}");
}

#[test]
fn where_slopes_tell_nothing_the_search_still_arrives() {
    let budget = || Budget::evaluations(20_000).with_target(1e-8);
    for seed in 1..=5 {
        let found = least_squares(&stairs(), budget(), seed).unwrap();
        assert_eq!(found.stop, StopReason::Target, "{seed}");
    }
}

#[test]
fn every_evaluation_counts_those_of_differences_too() {
    let (asked, inner) = (AtomicU64::new(0), decays());
    let counted = FnResiduals::new(inner.domain().clone(), |x: &[f64]| {
        asked.fetch_add(1, Ordering::Relaxed);
        inner.residuals(x)
    });
    let found = least_squares(&counted, Budget::evaluations(1_500), 3).unwrap();
    assert_eq!(found.evaluations, asked.load(Ordering::Relaxed));
    assert!(found.evaluations <= 1_500 && found.cost < 1e-8, "{found:?}");
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for problem in [&SumOfSquares(decays()) as &dyn Problem, &SumOfSquares(stairs())] {
        let run = |threads| {
            let mut driver = Driver::new(Budget::evaluations(3_000));
            if threads > 0 {
                driver = driver.with_evaluator(aep_core::Parallel::with_threads(threads).unwrap());
            }
            let mut run = Lineages::default().start(&Start::new(problem.domain(), 5)).unwrap();
            without_time(driver.run(&mut *run, problem).unwrap())
        };
        let serial = run(0);
        for threads in [1, 2, 7] {
            assert_eq!(run(threads), serial, "{threads} threads");
        }
    }
}

#[test]
fn a_resumed_run_equals_the_uninterrupted_one_in_a_descent_too() {
    let problem = SumOfSquares(stairs());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    let start = || Lineages::default().start(&Start::new(problem.domain(), 5)).unwrap();
    let whole = Driver::new(Budget::generations(200)).run(&mut *start(), &problem).unwrap();
    for after in [1, 3, 20, 150] {
        let flag = AtomicBool::new(false);
        let first = Driver::new(Budget::generations(200))
            .with_stop_flag(&flag)
            .with_checkpoint(&path, 1_000_000)
            .with_observer(|p: &Progress| flag.store(p.generation >= after, Ordering::Relaxed))
            .run(&mut *start(), &problem)
            .unwrap();
        assert_eq!((first.stop, first.generations), (StopReason::Interrupted, after));
        let resumed =
            Driver::new(Budget::generations(200)).resume(&mut *start(), &problem, &path).unwrap();
        assert_eq!(without_time(resumed), without_time(whole.clone()), "after {after}");
    }
}

#[test]
fn who_tells_costs_only_gets_the_search_alone() {
    let task = decays();
    let blind = FnProblem::new(task.domain().clone(), |x: &[f64]| task.objective(x));
    let found = minimize(&blind, &Lineages::default(), Budget::evaluations(2_000), 2).unwrap();
    let mut run: Box<dyn Algorithm> =
        Lineages::default().start(&Start::new(task.domain(), 2)).unwrap();
    for _ in 0..=found.generations {
        let costs: Vec<f64> = run.ask().rows().map(|x| task.objective(x)).collect();
        run.tell(&costs).unwrap();
    }
    assert_eq!(run.best().unwrap().position, found.position);
    // Without the ingredient a problem with residuals is searched like any other.
    let without = Lineages::default().without(Ingredient::Descents);
    let left = minimize(&SumOfSquares(&task), &without, Budget::evaluations(2_000), 2).unwrap();
    assert_eq!((left.position, left.cost), (found.position, found.cost));
}

#[test]
fn residuals_that_fail_or_panic_are_counted_and_gone_around() {
    let task = decays();
    let failing = FnResiduals::new(task.domain().clone(), |x: &[f64]| {
        assert!(x[3] < 4.5, "too fast to be simulated");
        let residuals = task.residuals(x);
        if x[0] > 3.5 { residuals.iter().map(|_| f64::NAN).collect() } else { residuals }
    });
    let budget = Budget::evaluations(20_000).with_target(1e-8);
    for seed in 1..=5 {
        let found = least_squares(&failing, budget.clone(), seed).unwrap();
        assert_eq!(found.stop, StopReason::Target);
    }
    let nowhere = FnResiduals::new(Domain::cube(2, 0.0, 1.0).unwrap(), |_: &[f64]| vec![f64::NAN]);
    let found = least_squares(&nowhere, Budget::evaluations(500), 1).unwrap();
    assert!(found.position.is_empty() && found.failures.non_finite == found.evaluations);
}

#[test]
fn a_corner_of_the_domain_and_an_exact_fit_end_a_descent() {
    let domain = Domain::cube(2, 1.0, 4.0).unwrap();
    let corner = FnResiduals::new(domain.clone(), |x: &[f64]| vec![x[0], x[1] * x[0]]);
    let found = least_squares(&corner, Budget::evaluations(300), 1).unwrap();
    assert_eq!((found.position, found.cost), (vec![1.0, 1.0], 2.0));
    let line = FnResiduals::new(domain, |x: &[f64]| vec![x[0] - 2.0, x[1] - 3.0]);
    let found = least_squares(&line, Budget::evaluations(300), 1).unwrap();
    assert!(found.cost < 1e-20 && found.evaluations > 250, "{found:?}");
}
