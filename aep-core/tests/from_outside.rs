//! No argument of the public functions panics: what cannot be done is an error that says why.

use std::time::Duration;

use aep_core::trials::{Plan, Trial, Trials, quantile, rank_test};
use aep_core::{
    Aep, Batch, Budget, CmaEs, ConfigError, Constrained, De, Domain, Driver, Evaluator, Failures,
    FnProblem, FnResiduals, Integers, LeastSquares, LevenbergMarquardt, Lineages, MetaEp, Method,
    Problem, Restarting, RunError, Scale, Serial, Stagnation, Start, StopReason, SumOfSquares,
    TellError, checkpoint, least_squares, methods, minimize, polish,
};
use proptest::prelude::*;

const EXTREMES: [f64; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.3,
    1e-308,
    5e-324,
    1e308,
    -1e308,
    f64::MAX,
    f64::MIN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(EXTREMES.to_vec()), -10.0..10.0f64, any::<f64>()]
}

fn count() -> impl Strategy<Value = usize> {
    prop_oneof![0..12usize, prop::sample::select(vec![40, usize::MAX, usize::MAX / 2, 1 << 40])]
}

/// A cost that is anything, by the bits of the position.
fn any_cost(x: &[f64], salt: usize) -> f64 {
    let hash = x.iter().fold(salt as u64, |hash, x| {
        (hash ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23)
    });
    match hash % 3 {
        0 => EXTREMES[(hash >> 8) as usize % EXTREMES.len()],
        _ => (hash >> 11) as f64 / 1e15 - 3.0,
    }
}

/// A method with settings in and out of their ranges.
fn method((which, a, b, n): (usize, f64, f64, usize)) -> Box<dyn Method> {
    match which {
        0 => Box::new(Aep::paper().with_beta(a, b).with_population(n)),
        1 => Box::new(Aep::practical().with_beta(a, b).with_population(n)),
        2 => Box::new(MetaEp::paper().with_sigma(a).with_population(n)),
        3 => Box::new(De::default().with_fixed(a, b).with_population(n)),
        4 => Box::new(CmaEs::default().with_sigma(a).with_population(n)),
        5 => Box::new(Lineages::default().with_sigma(a).with_population(n)),
        named => (methods::ALL[named % methods::ALL.len()].build)(n),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    /// What is accepted runs to its end, inside the domain.
    #[test]
    fn any_domain_method_and_cost_run_to_an_end_or_are_refused(
        limits in prop::collection::vec((number(), number(), any::<bool>()), 0..4),
        settings in (0..20usize, number(), number(), count()),
        seed in any::<u64>(),
        evaluations in 0..400u64,
        initial in prop::collection::vec(prop::collection::vec(number(), 0..4), 0..3),
        salt in any::<usize>(),
    ) {
        let lower: Vec<f64> = limits.iter().map(|limits| limits.0).collect();
        let upper: Vec<f64> = limits.iter().map(|limits| limits.1).collect();
        let scale = |log| if log { Scale::Log } else { Scale::Linear };
        let scales = limits.iter().map(|limits| scale(limits.2)).collect();
        let Ok(domain) = Domain::new(lower, upper).and_then(|d| d.with_scales(scales)) else {
            return Ok(());
        };
        let problem = FnProblem::new(domain.clone(), move |x: &[f64]| any_cost(x, salt));
        let start = Start::new(&domain, seed).with_initial(&initial);
        let Ok(mut run) = method(settings).start(&start) else { return Ok(()) };
        let outcome = Driver::new(Budget::evaluations(evaluations).with_generations(500))
            .run(&mut *run, &problem)
            .unwrap();
        prop_assert!(outcome.evaluations <= evaluations.max(run.ask().len() as u64).max(40));
        prop_assert!(outcome.position.is_empty() || domain.contains(&outcome.position), "{:?}", outcome);
    }

    /// Asked and told in any order, with costs of any number and kind.
    #[test]
    fn any_order_of_ask_and_tell_is_answered(
        name in 0..methods::ALL.len(),
        steps in prop::collection::vec((0..5u8, any::<usize>()), 1..60),
    ) {
        let domain = Domain::new(vec![-5.0, 1e-3], vec![5.0, 1e3]).unwrap();
        let domain = domain.with_scales(vec![Scale::Linear, Scale::Log]).unwrap();
        let mut run = (methods::ALL[name].build)(6).start(&Start::new(&domain, 3)).unwrap();
        let mut due = None;
        let mut saved = run.save().unwrap();
        for (step, salt) in steps {
            match step {
                0 => due = Some(run.ask().rows().map(|x| any_cost(x, salt)).collect::<Vec<_>>()),
                1 => {
                    let told = run.tell(due.as_deref().unwrap_or_default());
                    let expected = if due.take().is_some() { Ok(()) } else { Err(TellError::NotAsked) };
                    prop_assert_eq!(told, expected);
                }
                2 => prop_assert!(run.tell(&vec![1.0; 50 + salt % 50]).is_err()),
                3 => {
                    let rows = vec![vec![f64::NAN; salt % 3]; salt % 9];
                    let costs = due.clone().unwrap_or_default();
                    if run.tell_residuals(&costs, &rows).is_ok() {
                        due = None;
                    }
                }
                _ => {
                    run.restore(&saved).unwrap();
                    (saved, due) = (run.save().unwrap(), None);
                }
            }
        }
        prop_assert!(run.best().is_none_or(|best| domain.contains(best.position)));
    }

    /// Residuals of any number, the number another one at every position.
    #[test]
    fn residuals_of_any_length_and_kind_are_polished_and_searched(
        lengths in prop::collection::vec(0..4usize, 1..5),
        start in prop::collection::vec(number(), 0..4),
        width in number(),
        salt in any::<usize>(),
        seed in any::<u64>(),
    ) {
        let ragged = FnResiduals::new(Domain::cube(2, -3.0, 3.0).unwrap(), |x: &[f64]| {
            let at = x.iter().fold(salt, |sum, x| sum.wrapping_add(x.to_bits() as usize));
            let count = lengths[at % lengths.len()];
            (0..count).map(|k| any_cost(x, salt ^ k) + x.iter().sum::<f64>()).collect()
        });
        if let Ok(found) = polish(&ragged, &start) {
            prop_assert!(ragged.domain().contains(&found.position));
        }
        let mut descent = LevenbergMarquardt::new(&ragged, &start).holding(salt % 5);
        descent.step(width);
        descent.take_best(&[start.clone(), vec![]]);
        let found = least_squares(&ragged, Budget::evaluations(300), seed).unwrap();
        prop_assert!(found.evaluations <= 300);
    }

    #[test]
    fn statistics_take_any_numbers(
        costs in prop::collection::vec((number(), any::<u64>()), 0..6),
        (p, target) in (number(), number()),
        (step, last) in (any::<u64>(), any::<u64>()),
    ) {
        let trial = |(cost, evaluations): &(f64, u64)| Trial {
            seed: 1,
            cost: *cost,
            position: vec![*cost],
            evaluations: *evaluations,
            generations: u64::MAX,
            elapsed: Duration::MAX,
            stop: StopReason::Time,
            failures: Failures { non_finite: u64::MAX, errors: 1, ..Failures::default() },
            improvements: vec![(*evaluations, *cost)],
        };
        let trials = Trials { method: "any".into(), trials: costs.iter().map(trial).collect() };
        let summary = trials.summary(target);
        prop_assert_eq!(summary.trials, costs.len());
        prop_assert!(summary.successes <= costs.len());
        let test = rank_test(&trials.merits(target), &trials.merits(p));
        prop_assert!((0.0..=1.0).contains(&test.effect) && (0.0..=1.0).contains(&test.p_value));
        let last = if step == 0 { 7 } else { last.min(step.saturating_mul(50)) };
        prop_assert!(trials.curve(step, last).0.len() <= 50);
        let mut sorted: Vec<f64> = costs.iter().map(|(cost, _)| *cost).collect();
        sorted.sort_by(f64::total_cmp);
        let _ = quantile(&sorted, p);
    }
}

fn bowl(n: usize) -> impl Problem {
    FnProblem::new(Domain::cube(n, -1.0, 1.0).unwrap(), |x: &[f64]| x.iter().map(|x| x * x).sum())
}

#[test]
fn limits_that_enclose_nothing_are_refused_with_the_component() {
    let (inf, nan) = (f64::INFINITY, f64::NAN);
    for (lower, upper) in
        [(1.0, 1.0), (1.0, 0.0), (nan, 1.0), (0.0, nan), (-inf, 0.0), (0.0, inf), (-1e308, 1e308)]
    {
        let refused = Domain::new(vec![0.0, lower], vec![1.0, upper]);
        let at = matches!(refused, Err(ConfigError::Limits { component: 1, .. }));
        assert!(at, "[{lower}, {upper}]: {refused:?}");
    }
    assert_eq!(Domain::<f64>::new(vec![], vec![]), Err(ConfigError::EmptyDomain));
    assert!(Domain::new(vec![0.0], vec![1.0, 2.0]).is_err());
    assert_eq!(Domain::cube(0, 0.0, 1.0), Err(ConfigError::EmptyDomain));
    assert!(matches!(Domain::cube(usize::MAX, 0.0, 1.0), Err(ConfigError::TooLarge { .. })));
    // Two neighbouring numbers with the same logarithm.
    let close = Domain::new(vec![1e300], vec![1e300_f64.next_up()]).unwrap();
    let refused = close.with_scales(vec![Scale::Log]);
    assert!(matches!(refused, Err(ConfigError::Limits { component: 0, .. })), "{refused:?}");
}

#[test]
fn a_domain_that_is_read_is_checked_like_one_that_is_made() {
    let domain = Domain::new(vec![1.0], vec![3.0]).unwrap();
    let domain = domain.with_scales(vec![Scale::Log]).unwrap().with_names(["k"]).unwrap();
    let text = serde_json::to_string(&domain).unwrap();
    assert_eq!(serde_json::from_str::<Domain>(&text).unwrap(), domain);
    let bytes = checkpoint::encode(&domain).unwrap();
    assert_eq!(checkpoint::decode::<Domain>(&bytes).unwrap(), domain);
    for (from, to) in [("[3.0]", "[0.5]"), ("[3.0]", "[]"), ("[\"log\"]", "[]"), ("[1.0]", "[0.0]")]
    {
        let other = text.replacen(from, to, 1);
        assert_ne!(other, text);
        assert!(serde_json::from_str::<Domain>(&other).is_err(), "{other}");
    }
}

#[test]
fn ten_thousand_components_and_one_run_with_every_method() {
    for named in methods::ALL {
        for n in [1, 10_000] {
            // Their matrices take seconds at that size, and are tried by the next test.
            if n > 1 && ["cma-es", "aep-lineages"].contains(&named.name) {
                continue;
            }
            let outcome =
                minimize(&bowl(n), &*(named.build)(0), Budget::evaluations(100), 1).unwrap();
            assert!(outcome.position.len() == n && outcome.evaluations <= 100, "{}", named.name);
        }
    }
}

#[test]
fn what_fits_into_no_memory_is_refused() {
    let wide = Domain::cube(20_000, -1.0, 1.0).unwrap();
    for name in ["cma-es", "aep-lineages"] {
        let started = (methods::find(name).unwrap().build)(0).start(&Start::new(&wide, 1));
        let Err(ConfigError::TooLarge { what: "covariance", .. }) = started.map(|_| ()) else {
            panic!("{name} was started");
        };
    }
    for named in methods::ALL {
        for count in [1 << 40, usize::MAX] {
            let domain = Domain::cube(3, -1.0, 1.0).unwrap();
            let started = (named.build)(count).start(&Start::new(&domain, 1)).map(|_| ());
            let Err(ConfigError::TooLarge { .. }) = started else {
                panic!("{} of {count} was started", named.name);
            };
        }
    }
    let doubling = Restarting::doubling(Aep::paper(), |aep, n| aep.with_population(n << 40));
    assert!(minimize(&bowl(2), &doubling, Budget::evaluations(10), 1).is_err());
}

#[test]
fn a_constant_cost_outgrows_no_memory_in_a_thousand_generations() {
    let flat = FnProblem::new(Domain::cube(1, 0.0, 1.0).unwrap(), |_: &[f64]| 1.0);
    for named in methods::ALL {
        let outcome = minimize(&flat, &*(named.build)(0), Budget::generations(1_000), 1).unwrap();
        assert_eq!((outcome.generations, outcome.cost), (1_000, 1.0), "{}", named.name);
        assert!(outcome.evaluations < 10_000_000, "{} {}", named.name, outcome.evaluations);
    }
}

#[test]
fn a_budget_of_nothing_evaluates_the_initial_population_only() {
    for named in methods::ALL {
        let method = (named.build)(0);
        for budget in [Budget::evaluations(0), Budget::generations(0)] {
            let outcome = minimize(&bowl(2), &*method, budget, 1).unwrap();
            assert!(outcome.evaluations > 0 && outcome.generations == 0, "{}", named.name);
        }
        let none = minimize(&bowl(2), &*method, Budget::time(Duration::ZERO), 1).unwrap();
        assert_eq!((none.evaluations, none.stop), (0, StopReason::Time));
        let budget = Budget::evaluations(u64::MAX).with_time(Duration::MAX).with_target(f64::NAN);
        let all = budget.with_generations(20).with_stagnation(0, f64::NAN);
        assert_eq!(minimize(&bowl(2), &*method, all, 1).unwrap().stop, StopReason::Stagnation);
    }
}

#[test]
fn populations_of_none_and_one_are_refused_or_run() {
    for named in methods::ALL {
        // 0 is the method's own number.
        assert!(minimize(&bowl(2), &*(named.build)(0), Budget::evaluations(50), 1).is_ok());
        let one = minimize(&bowl(2), &*(named.build)(1), Budget::evaluations(50), 1);
        let wants_more = ["de", "de-fixed", "cma-es", "aep-lineages"].contains(&named.name);
        assert_eq!(one.is_err(), wants_more, "{}", named.name);
    }
    let never = Stagnation { generations: 0, tolerance: f64::NAN };
    let restarting = Restarting::doubling(Aep::paper(), Aep::with_population).with_patience(never);
    assert!(minimize(&bowl(2), &restarting, Budget::evaluations(50), 1).is_err());
}

#[test]
fn single_precision_at_its_limits_stays_inside() {
    fn runs(method: &dyn Method<f32>, lower: f32, upper: f32) {
        let domain = Domain::<f32>::cube(3, lower, upper).unwrap();
        let problem = FnProblem::new(domain.clone(), |x: &[f32]| x.iter().map(|x| x * x).sum());
        let outcome = minimize(&problem, method, Budget::evaluations(600), 1).unwrap();
        assert!(outcome.position.is_empty() || domain.contains(&outcome.position), "{outcome:?}");
    }
    assert!(Domain::<f32>::cube(2, -3e38, 3e38).is_err());
    for (lower, upper) in [(-1e38, 1e38), (0.0, 1e-45), (1.0, 1.000_000_1), (-1e-30, 1e38)] {
        runs(&Aep::paper(), lower, upper);
        runs(&Aep::practical(), lower, upper);
        runs(&MetaEp::practical(), lower, upper);
        runs(&De::default(), lower, upper);
        runs(&CmaEs::default(), lower, upper);
        runs(&Lineages::default(), lower, upper);
    }
}

#[test]
fn a_problem_of_another_dimension_is_refused() {
    let mut run = Aep::paper().start(&Start::new(bowl(2).domain(), 1)).unwrap();
    let refused = Driver::new(Budget::evaluations(50)).run(&mut *run, &bowl(3));
    let Err(RunError::Dimension { algorithm: 2, problem: 3 }) = refused else {
        panic!("{refused:?}");
    };
}

#[test]
fn whole_numbers_and_constraints_of_any_kind_are_refused_or_searched() {
    let integers = |lower, upper, whole: &[bool]| {
        let domain = Domain::new(vec![lower], vec![upper]).unwrap();
        Integers::new(FnProblem::new(domain, |x: &[f64]| x[0]), whole)
    };
    assert!(integers(0.1, 0.9, &[true]).is_err() && integers(0.0, 1.0, &[]).is_err());
    // Half beside a number this large is nothing.
    assert!(integers(1e300, 1e300_f64.next_up(), &[true]).is_ok());
    let whole = integers(-2.5, 7.5, &[true]).unwrap();
    for value in EXTREMES {
        let constrained = Constrained::new(&whole, value, |x: &[f64]| vec![value - x[0]]);
        for named in methods::ALL {
            let budget = Budget::evaluations(120);
            let outcome = minimize(&constrained, &*(named.build)(0), budget, 1).unwrap();
            let rounded = whole.rounded(&outcome.position);
            assert!(rounded.iter().all(|x| (-2.0..=7.0).contains(x)), "{outcome:?}");
        }
    }
    let mut few = [0.0; 1];
    let none = Constrained::new(&whole, 1.0, |_: &[f64]| vec![]);
    none.evaluate_batch(Batch::new(1, &[1.0, 2.0, 3.0]), &mut few);
    assert_eq!(few, [1.0]);
}

#[test]
fn evaluators_take_more_or_fewer_costs_than_positions() {
    let evaluators: &[&dyn Evaluator] = &[
        &Serial,
        #[cfg(feature = "parallel")]
        &aep_core::Parallel::new(),
    ];
    for evaluator in evaluators {
        for (positions, room) in [(0, 3), (3, 0), (2, 5), (5, 2)] {
            let data = vec![0.5; positions];
            let mut costs = vec![7.0; room];
            evaluator.evaluate(&bowl(1), Batch::new(1, &data), &mut costs);
            // What belongs to no position has no cost.
            let expected = |k| if k < positions { 0.25 } else { f64::INFINITY };
            assert!(costs.iter().enumerate().all(|(k, cost)| *cost == expected(k)), "{costs:?}");
        }
    }
}

#[test]
fn slices_of_positions_end_where_the_positions_do() {
    let data = [1.0, 2.0, 3.0, 4.0, 5.0];
    let batch = Batch::new(2, &data);
    assert_eq!((batch.len(), Batch::new(0, &data).len()), (2, 0));
    assert_eq!(batch.slice(1, 9).as_slice(), [3.0, 4.0]);
    assert!(batch.slice(9, 1).is_empty() && batch.slice(usize::MAX, usize::MAX).is_empty());
}

#[test]
fn plans_of_no_trials_and_methods_that_cannot_start_are_answered() {
    let problem = bowl(2);
    let plan = |trials| Plan::new(trials, Budget::evaluations(0));
    let none = plan(0).run(&Aep::paper(), |_| &problem).unwrap();
    assert!(none.trials.is_empty() && none.longest() == 0 && none.summary(0.0).median.is_nan());
    assert!(plan(3).run(&Aep::paper().with_population(0), |_| &problem).is_err());
    assert_eq!(plan(3).run(&Aep::paper(), |_| &problem).unwrap().trials.len(), 3);
}

#[test]
fn residuals_that_are_told_for_other_positions_are_refused_and_change_nothing() {
    let squares =
        SumOfSquares(FnResiduals::new(Domain::cube(2, -1.0, 1.0).unwrap(), |x: &[f64]| x.to_vec()));
    let mut run = Lineages::default().start(&Start::new(squares.domain(), 1)).unwrap();
    let costs: Vec<f64> = run.ask().rows().map(|x| squares.evaluate(x)).collect();
    let rows = vec![vec![1.0, 1.0]; costs.len() + 1];
    let refused = run.tell_residuals(&costs, &rows);
    let counts = TellError::Residuals { found: costs.len() + 1, expected: costs.len() };
    assert_eq!(refused, Err(counts));
    assert_eq!(run.tell(&costs), Ok(()));
}

#[test]
fn a_checkpoint_that_cannot_be_read_is_an_error_with_its_path() {
    let folder = tempfile::tempdir().unwrap();
    let mut driver = Driver::new(Budget::evaluations(50));
    let mut run = Aep::paper().start(&Start::new(bowl(2).domain(), 1)).unwrap();
    for path in [folder.path().to_path_buf(), folder.path().join("none"), "".into()] {
        let refused = driver.resume(&mut *run, &bowl(2), &path).unwrap_err();
        assert!(matches!(refused, RunError::Checkpoint(_)), "{refused}");
    }
    for bytes in [&[][..], &[0xff; 64], &[0; 3]] {
        assert!(run.restore(bytes).is_err());
    }
    // One that cannot be written is told, and the run goes on.
    let mut saving = Driver::new(Budget::evaluations(200)).with_checkpoint(folder.path(), 0);
    let outcome = saving.run(&mut *run, &bowl(2)).unwrap();
    assert!(outcome.checkpoint_error.is_some() && outcome.evaluations == 200, "{outcome:?}");
}
