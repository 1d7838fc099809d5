//! What a run promises: reproducible to the bit, resumable, tolerant of failing problems.

use std::sync::atomic::{AtomicBool, Ordering};

use aep_core::{
    Aep, Algorithm, Budget, CheckpointError, CmaEs, De, Domain, Driver, Failures, FallibleProblem,
    FnProblem, Lineages, MetaEp, Method, Outcome, Problem, Progress, RunError, Scale, Start,
    StopReason, minimize,
};

fn rosenbrock() -> impl Problem {
    let domain = Domain::cube(2, -6.0, 6.0).unwrap();
    FnProblem::new(domain, |x: &[f64]| 100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2))
}

/// The same problem under a name.
struct Named<P>(P);

impl<P: Problem> Problem for Named<P> {
    fn domain(&self) -> &Domain {
        self.0.domain()
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        self.0.evaluate(x)
    }

    fn identity(&self) -> String {
        "valley".into()
    }
}

fn methods() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(Aep::paper()),
        Box::new(Aep::practical()),
        Box::new(MetaEp::paper()),
        Box::new(MetaEp::practical()),
        Box::new(De::default()),
        Box::new(CmaEs::default()),
        (aep_core::methods::find("aep-practical-restarts").unwrap().build)(20),
        Box::new(Lineages::default()),
    ]
}

fn start(method: &dyn Method, problem: &dyn Problem) -> Box<dyn Algorithm> {
    method.start(&Start::new(problem.domain(), 11)).unwrap()
}

fn without_time(mut outcome: Outcome) -> Outcome {
    outcome.elapsed = std::time::Duration::ZERO;
    outcome
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let problem = rosenbrock();
    for method in methods() {
        let run = |threads| {
            let mut driver = Driver::new(Budget::generations(150));
            if threads > 0 {
                driver = driver.with_evaluator(aep_core::Parallel::with_threads(threads).unwrap());
            }
            without_time(driver.run(&mut *start(&*method, &problem), &problem).unwrap())
        };
        let serial = run(0);
        for threads in [1, 2, 7] {
            assert_eq!(run(threads), serial, "{} with {threads} threads", method.name());
        }
    }
}

#[test]
fn a_resumed_run_equals_the_uninterrupted_one() {
    let problem = rosenbrock();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    for method in methods() {
        let whole = Driver::new(Budget::generations(120))
            .run(&mut *start(&*method, &problem), &problem)
            .unwrap();
        let flag = AtomicBool::new(false);
        let first = Driver::new(Budget::generations(120))
            .with_stop_flag(&flag)
            .with_checkpoint(&path, 7)
            .with_observer(|p: &Progress| flag.store(p.generation >= 50, Ordering::Relaxed))
            .run(&mut *start(&*method, &problem), &problem)
            .unwrap();
        assert_eq!((first.stop, first.generations), (StopReason::Interrupted, 50));
        let resumed = Driver::new(Budget::generations(120))
            .resume(&mut *start(&*method, &problem), &problem, &path)
            .unwrap();
        assert_eq!(without_time(resumed), without_time(whole), "{}", method.name());
    }
}

/// The same problem, broken off in the middle of a generation.
struct BrokenOff<P> {
    problem: P,
    left: std::sync::atomic::AtomicI64,
}

impl<P: Problem> Problem for BrokenOff<P> {
    fn domain(&self) -> &Domain {
        self.problem.domain()
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        if self.left.fetch_sub(1, Ordering::Relaxed) > 0 {
            self.problem.evaluate(x)
        } else {
            f64::NAN
        }
    }

    fn is_broken_off(&self) -> bool {
        self.left.load(Ordering::Relaxed) < 0
    }
}

#[test]
fn a_generation_that_was_broken_off_leaves_no_trace_and_is_made_again() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    for method in methods() {
        let whole = Driver::new(Budget::evaluations(2_000))
            .run(&mut *start(&*method, &rosenbrock()), &rosenbrock())
            .unwrap();
        let problem = BrokenOff { problem: rosenbrock(), left: 907.into() };
        let first = Driver::new(Budget::evaluations(2_000))
            .with_checkpoint(&path, 1_000_000)
            .run(&mut *start(&*method, &problem), &problem)
            .unwrap();
        assert_eq!(first.stop, StopReason::Interrupted);
        assert!(first.evaluations < 907 && first.failures.total() == 0, "{}", method.name());
        let resumed = Driver::new(Budget::evaluations(2_000))
            .resume(&mut *start(&*method, &problem), &rosenbrock(), &path)
            .unwrap();
        assert_eq!(without_time(resumed), without_time(whole), "{}", method.name());
    }
}

#[test]
fn trials_in_turn_are_those_of_trials_side_by_side() {
    let problem = rosenbrock();
    let plan = aep_core::trials::Plan::new(5, Budget::evaluations(500));
    let (stop, ended) = (AtomicBool::new(false), std::cell::Cell::new(0));
    let count = || ended.set(ended.get() + 1);
    let mut in_turn = plan.run_in_turn(&Aep::paper(), |_| &problem, &stop, &count).unwrap();
    let mut beside = plan.run(&Aep::paper(), |_| &problem).unwrap();
    for trials in [&mut in_turn, &mut beside] {
        trials.trials.iter_mut().for_each(|trial| trial.elapsed = std::time::Duration::ZERO);
    }
    assert_eq!((in_turn, ended.get()), (beside, 5));
}

#[test]
fn a_run_resumed_after_a_restart_equals_the_uninterrupted_one() {
    let domain = Domain::cube(3, -5.12, 5.12).unwrap();
    let dents = FnProblem::new(domain, |x: &[f64]| {
        x.iter().map(|x| 10.0 + x * x - 10.0 * (std::f64::consts::TAU * x).cos()).sum()
    });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    for name in ["cma-es", "aep-practical-restarts"] {
        let method = (aep_core::methods::find(name).unwrap().build)(8);
        let whole = Driver::new(Budget::generations(900))
            .run(&mut *start(&*method, &dents), &dents)
            .unwrap();
        let mut half = start(&*method, &dents);
        Driver::new(Budget::generations(600))
            .with_checkpoint(&path, 600)
            .run(&mut *half, &dents)
            .unwrap();
        assert!(half.ask().len() > 8, "{name} has not restarted");
        let resumed = Driver::new(Budget::generations(900))
            .resume(&mut *start(&*method, &dents), &dents, &path)
            .unwrap();
        assert_eq!(without_time(resumed), without_time(whole), "{name}");
    }
}

#[test]
fn a_checkpoint_of_another_run_is_refused() {
    let problem = rosenbrock();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    let mut driver = Driver::new(Budget::generations(3)).with_checkpoint(&path, 1);
    driver.run(&mut *start(&Aep::paper(), &problem), &problem).unwrap();
    let other = Aep::paper().with_beta(30.0, 0.3);
    let error = driver.resume(&mut *start(&other, &problem), &problem, &path).unwrap_err();
    assert!(matches!(error, RunError::Checkpoint(CheckpointError::OtherRun { .. })), "{error}");
    let named = Named(rosenbrock());
    let error = driver.resume(&mut *start(&Aep::paper(), &named), &named, &path).unwrap_err();
    assert!(matches!(error, RunError::Checkpoint(CheckpointError::OtherProblem { .. })), "{error}");
    std::fs::write(&path, b"z1,z2\n1,2\n").unwrap();
    let error = driver.resume(&mut *start(&other, &problem), &problem, &path).unwrap_err();
    assert!(error.to_string().contains("not a checkpoint"), "{error}");
}

/// NaN on half of the domain, an error in a corner, a panic in another.
fn hostile() -> impl Problem {
    let domain = Domain::cube(3, -6.0, 6.0).unwrap();
    FallibleProblem::new(domain, |x: &[f64]| {
        assert!(!(x[1] > 4.0 && x[2] > 0.0), "the simulator fell over");
        if x[1] < -4.0 {
            return Err("no solution for this load");
        }
        let sphere: f64 = x.iter().map(|v| v * v).sum();
        Ok(if x[0] > 0.0 { f64::NAN } else { sphere })
    })
}

#[test]
fn a_problem_that_fails_in_every_way_is_still_solved_in_25_of_25_seeds() {
    let problem = hostile();
    aep_core::silence_caught_panics();
    for method in methods() {
        // Meta-EP's step sizes can collapse on any problem; it must run on, AEP must arrive.
        let target = if method.name().starts_with("meta-ep") { 1e-2 } else { 1e-8 };
        let mut counted = Failures::default();
        for seed in 0..25 {
            let budget = Budget::evaluations(40_000).with_target(target);
            let outcome = minimize(&problem, &*method, budget, seed).unwrap();
            assert_eq!(outcome.stop, StopReason::Target, "{} {seed}: {outcome:?}", method.name());
            counted.add(outcome.failures);
        }
        assert!(counted.non_finite > 0 && counted.errors > 0 && counted.panics > 0);
    }
}

#[test]
fn a_problem_that_always_fails_ends_with_nothing_found() {
    let domain = Domain::cube(2, 0.0, 1.0).unwrap();
    let problem = FnProblem::new(domain, |_: &[f64]| f64::NAN);
    for method in methods() {
        let outcome = minimize(&problem, &*method, Budget::generations(10), 1).unwrap();
        assert!(outcome.position.is_empty() && outcome.cost.is_infinite());
        assert_eq!(outcome.failures.non_finite, outcome.evaluations);
    }
}

#[test]
fn each_budget_stops_with_its_reason_and_is_not_exceeded() {
    let problem = rosenbrock();
    let run = |budget| minimize(&problem, &Aep::paper(), budget, 3).unwrap();
    let outcome = run(Budget::evaluations(1_030));
    assert_eq!((outcome.stop, outcome.evaluations), (StopReason::Evaluations, 1_000));
    let outcome = run(Budget::generations(5));
    assert_eq!((outcome.stop, outcome.generations), (StopReason::Generations, 5));
    let outcome = run(Budget::time(std::time::Duration::ZERO));
    assert_eq!(outcome.stop, StopReason::Time);
    assert_eq!(run(Budget::default().with_target(1e-3)).stop, StopReason::Target);
    let flat = FnProblem::new(Domain::cube(2, 0.0, 1.0).unwrap(), |_: &[f64]| 1.0);
    let budget = Budget::default().with_stagnation(20, 1e-9);
    let outcome = minimize(&flat, &Aep::paper(), budget, 1).unwrap();
    assert_eq!((outcome.stop, outcome.generations), (StopReason::Stagnation, 20));
}

#[test]
fn a_logarithmic_component_is_searched_over_its_decades() {
    let domain = Domain::new(vec![-5.0, 1e-9], vec![5.0, 1e9]).unwrap();
    let domain = domain.with_scales(vec![Scale::Linear, Scale::Log]).unwrap();
    let problem =
        FnProblem::new(domain, |x: &[f64]| 2.0 + (x[0] - 1.0).powi(2) + (x[1] / 3e-6).ln().powi(2));
    let outcome = minimize(&problem, &Aep::practical(), Budget::evaluations(20_000), 5).unwrap();
    assert!(outcome.cost - 2.0 < 1e-6, "{outcome:?}");
    assert!((outcome.position[1] / 3e-6 - 1.0).abs() < 1e-2, "{outcome:?}");
}

#[test]
fn single_precision_works() {
    let domain = Domain::<f32>::cube(3, -6.0, 6.0).unwrap();
    let problem = FnProblem::new(domain, |x: &[f32]| x.iter().map(|v| v * v).sum());
    let outcome = minimize(&problem, &Aep::paper(), Budget::generations(300), 1).unwrap();
    assert!(outcome.cost < 1e-6, "{outcome:?}");
}

#[test]
fn one_component_is_enough_for_every_method() {
    let domain = Domain::cube(1, -3.0, 4.0).unwrap();
    let problem = FnProblem::new(domain, |x: &[f64]| (x[0] - 0.5).powi(2));
    for method in methods() {
        let budget = Budget::evaluations(8_000).with_target(1e-6);
        let outcome = minimize(&problem, &*method, budget, 2).unwrap();
        assert_eq!(outcome.stop, StopReason::Target, "{}", method.name());
    }
}

#[test]
fn given_positions_take_the_first_slots_and_bad_ones_are_refused() {
    let problem = rosenbrock();
    let given = vec![vec![1.0, 1.0], vec![-2.0, 3.0]];
    for method in methods() {
        let start = Start::new(problem.domain(), 1).with_initial(&given);
        let mut run = method.start(&start).unwrap();
        assert_eq!(run.ask().row(0), [1.0, 1.0], "{}", method.name());
        assert_eq!(run.ask().row(1), [-2.0, 3.0], "{}", method.name());
        for bad in [vec![1.0], vec![7.0, 0.0], vec![f64::NAN, 0.0]] {
            let start = Start::new(problem.domain(), 1);
            assert!(method.start(&start.with_initial(&[bad])).is_err(), "{}", method.name());
        }
    }
}

#[test]
fn settings_that_cannot_work_are_refused_with_a_hint() {
    let problem = rosenbrock();
    let bad: Vec<Box<dyn Method>> = vec![
        Box::new(Aep::paper().with_beta(0.0, 1.0)),
        Box::new(Aep::paper().with_beta(f64::NAN, 1.0)),
        Box::new(Aep::paper().with_population(0)),
        Box::new(MetaEp::paper().with_sigma(-1.0)),
        Box::new(De::default().with_population(3)),
        Box::new(De::default().with_fixed(0.5, 1.5)),
        Box::new(CmaEs::default().with_population(2)),
        Box::new(CmaEs::default().with_sigma(f64::INFINITY)),
        Box::new(Lineages::default().with_population(3)),
        Box::new(Lineages::default().with_sigma(0.0)),
    ];
    for method in bad {
        let Err(error) = method.start(&Start::new(problem.domain(), 1)) else {
            panic!("{} was accepted", method.name());
        };
        assert_eq!(error.to_string().lines().count(), 2, "{error}");
    }
}
