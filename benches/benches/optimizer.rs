//! Cost of the framework per evaluation, against what the random numbers alone cost and against the
//! differential evolution of two other crates in the same run.
//!
//! `cargo bench -p benches --bench optimizer`. The throughput printed is evaluations per second;
//! `time / evaluations` is the cost of one. Every method evaluates the same functions, so the
//! function's own cost (group `objective`) is in all figures alike.

use std::convert::Infallible;
use std::hint::black_box;
use std::time::Duration;

use aep_core::random::{Streams, fill_normal, normal};
use aep_core::{
    Aep, Budget, Domain, Driver, FnProblem, MetaEp, Method, Parallel, Problem, Purpose, Start,
};
use basin::{
    BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction, De as BasinDe,
    Executor, PopulationProgress,
};
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use fcmaes_core::de::{De as FcmaesDe, DeParams};
use fcmaes_core::fitness::Fitness;

type Cost = fn(&[f64]) -> f64;
type Group<'a> = BenchmarkGroup<'a, criterion::measurement::WallTime>;

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

fn quartic(x: &[f64]) -> f64 {
    x.iter().map(|x| (x * x) * (x * x)).sum()
}

/// What is run: function, components, population, evaluations of one run.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    cost: Cost,
    dimension: usize,
    population: usize,
    evaluations: u64,
}

const CASES: [Case; 6] = [
    Case { name: "sphere-3", cost: sphere, dimension: 3, population: 40, evaluations: 20_000 },
    Case { name: "sphere-3", cost: sphere, dimension: 3, population: 1_000, evaluations: 20_000 },
    Case { name: "quartic-30", cost: quartic, dimension: 30, population: 40, evaluations: 20_000 },
    Case {
        name: "quartic-30",
        cost: quartic,
        dimension: 30,
        population: 1_000,
        evaluations: 20_000,
    },
    Case {
        name: "sphere-1000",
        cost: sphere,
        dimension: 1_000,
        population: 40,
        evaluations: 2_000,
    },
    Case {
        name: "sphere-1000",
        cost: sphere,
        dimension: 1_000,
        population: 10_000,
        evaluations: 60_000,
    },
];

const LIMIT: f64 = 6.0;

fn ours(case: Case, method: &dyn Method) -> f64 {
    let domain = Domain::cube(case.dimension, -LIMIT, LIMIT).expect("a valid domain");
    let problem = FnProblem::new(domain, case.cost);
    let mut run = method.start(&Start::new(problem.domain(), 1)).expect("a valid method");
    let mut driver = Driver::new(Budget::evaluations(case.evaluations));
    driver.run(&mut *run, &problem).expect("a run").cost
}

fn fcmaes(case: Case) -> f64 {
    let (lower, upper) = (vec![-LIMIT; case.dimension], vec![LIMIT; case.dimension]);
    let fitness = Fitness::new(case.dimension, 1, lower, upper);
    let parameters = DeParams {
        popsize: i32::try_from(case.population).expect("a small population"),
        max_evaluations: case.evaluations,
        seed: 1,
        ..DeParams::default()
    };
    FcmaesDe::new(fitness, &[], &[], None, &parameters).optimize(&case.cost).y
}

struct BasinProblem {
    cost: Cost,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl CostFunction for BasinProblem {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Infallible;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Infallible> {
        Ok((self.cost)(x))
    }
}

impl Constraints for BasinProblem {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let bounds = BoxBounds::new(Some(&self.lower), Some(&self.upper));
        ConstraintSet::new().with_bounds(bounds)
    }
}

fn basin(case: Case) -> f64 {
    let (lower, upper) = (vec![-LIMIT; case.dimension], vec![LIMIT; case.dimension]);
    let problem = BasinProblem { cost: case.cost, lower, upper };
    let solver = BasinDe::new(1).with_pop_size(case.population);
    let generations = case.evaluations / case.population as u64 - 1;
    let executor = Executor::new(problem, solver, PopulationProgress::empty());
    executor.max_iter(generations).run().expect("a run").cost()
}

/// The n normal numbers of each evaluation and nothing else: drawn one after the other from
/// `rand_distr::StandardNormal` by a generator of each child's own, as AEP draws them, and summed, so
/// that no memory is written.
fn normals(case: Case) -> f64 {
    let streams = Streams::new(1, Purpose::Mutation, 1);
    (0..case.evaluations as usize)
        .map(|i| {
            let mut rng = streams.stream(i);
            (0..case.dimension).map(|_| normal::<f64>(&mut rng)).sum::<f64>()
        })
        .sum()
}

/// The same numbers written by `fill_normal` into a population's memory.
fn filled(case: Case) -> f64 {
    let streams = Streams::new(1, Purpose::Mutation, 1);
    let mut population = vec![0.0; case.dimension * case.population];
    for i in 0..case.evaluations as usize {
        let from = i % case.population * case.dimension;
        fill_normal(&mut streams.stream(i), &mut population[from..from + case.dimension]);
    }
    population[0]
}

fn objective(case: Case) -> f64 {
    let mut x = vec![0.5; case.dimension];
    (0..case.evaluations)
        .map(|i| {
            x[0] = i as f64;
            (case.cost)(black_box(&x))
        })
        .sum()
}

fn overhead(criterion: &mut Criterion) {
    for case in CASES {
        let name = format!("{}/population {}", case.name, case.population);
        let mut group: Group<'_> = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(case.evaluations));
        if case.population == 10_000 {
            group.sample_size(10);
        }
        let sized = |population| (Aep::paper().with_population(population), case);
        let (aep, case) = sized(case.population);
        let meta_ep = MetaEp::paper().with_population(case.population);
        let practical = Aep::practical().with_population(case.population);
        group.bench_function("objective", |b| b.iter(|| objective(case)));
        group.bench_function("normal numbers", |b| b.iter(|| normals(case)));
        group.bench_function("normal numbers, kept", |b| b.iter(|| filled(case)));
        group.bench_function("aep", |b| b.iter(|| ours(case, &aep)));
        if case.dimension < 1_000 {
            group.bench_function("aep-practical", |b| b.iter(|| ours(case, &practical)));
            group.bench_function("meta-ep", |b| b.iter(|| ours(case, &meta_ep)));
            group.bench_function("fcmaes-core de", |b| b.iter(|| fcmaes(case)));
            group.bench_function("basin de", |b| b.iter(|| basin(case)));
        }
        group.finish();
    }
}

/// A cost that takes a millisecond of a processor's time.
fn slow(x: &[f64]) -> f64 {
    let began = std::time::Instant::now();
    while began.elapsed() < Duration::from_millis(1) {
        black_box(x);
    }
    sphere(x)
}

fn threads(criterion: &mut Criterion) {
    let domain = Domain::cube(3, -LIMIT, LIMIT).expect("a valid domain");
    let problem = FnProblem::new(domain, slow);
    let mut group = criterion.benchmark_group("1 ms problem");
    group.sample_size(10).throughput(Throughput::Elements(400));
    for threads in [1, 2] {
        group.bench_function(format!("{threads} threads"), |b| {
            b.iter(|| {
                let mut run = Aep::paper().start(&Start::new(problem.domain(), 1)).expect("AEP");
                let evaluator = Parallel::with_threads(threads).expect("a thread pool");
                let mut driver = Driver::new(Budget::evaluations(400)).with_evaluator(evaluator);
                driver.run(&mut *run, &problem).expect("a run").cost
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = overhead, threads
}
criterion_main!(benches);
