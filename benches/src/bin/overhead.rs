//! Nanoseconds per evaluation of methods that adapt a covariance, beside the crates `cmaes` and
//! `fcmaes-core`: everything included, on a cost that takes next to nothing (Rosenbrock's valley).
//!
//! `cargo run --release -p benches --bin overhead` prints a table: the shortest of five runs of 20,000
//! evaluations, restarts included, one thread.

use std::time::Instant;

use aep_core::{
    Budget, CmaEs, Domain, Driver, FnProblem, Ingredient, Lineages, Method, Problem, Start,
};
use benches::peers::{cmaes_bipop, fcmaes_cma};
use fcmaes_core::CmaesParams;

const EVALUATIONS: u64 = 20_000;
const LIMIT: f64 = 5.0;
const REPEATS: usize = 5;
const DIMENSIONS: [usize; 3] = [5, 10, 40];

fn valley(x: &[f64]) -> f64 {
    x.windows(2).map(|x| 100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2)).sum()
}

fn ours(method: &dyn Method, n: usize) {
    let domain = Domain::cube(n, -LIMIT, LIMIT).expect("a valid domain");
    let problem = FnProblem::new(domain, valley);
    let mut run = method.start(&Start::new(problem.domain(), 1)).expect("a valid method");
    Driver::new(Budget::evaluations(EVALUATIONS)).run(&mut *run, &problem).expect("a run");
}

fn cmaes_crate(n: usize) {
    cmaes_bipop((n, -LIMIT..=LIMIT), EVALUATIONS, None, 1, valley).expect("valid settings");
}

fn fcmaes_crate(n: usize) {
    let (lower, upper) = (vec![-LIMIT; n], vec![LIMIT; n]);
    let mut left = EVALUATIONS;
    for runid in 0.. {
        let popsize = 4 + (3.0 * (n as f64).ln()) as i32;
        let settings = CmaesParams {
            popsize,
            max_evaluations: left,
            seed: 1,
            runid,
            ..CmaesParams::default()
        };
        let mut search = fcmaes_cma((&lower, &upper), &vec![2.0; n], 2.0, &settings);
        left = left.saturating_sub(search.optimize(&valley, 1).evaluations.max(1));
        if left == 0 {
            return;
        }
    }
}

/// Nanoseconds per evaluation of the shortest of some runs.
fn shortest(run: impl Fn()) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let began = Instant::now();
        run();
        began.elapsed().as_secs_f64()
    });
    1e9 * times.fold(f64::INFINITY, f64::min) / EVALUATIONS as f64
}

fn main() {
    println!("| | 5-D | 10-D | 40-D |\n|---|---:|---:|---:|");
    let bare = Lineages::default().without(Ingredient::Model);
    let row = |name: &str, run: &dyn Fn(usize)| {
        let cells = DIMENSIONS.map(|n| format!("{:.0}", shortest(|| run(n))));
        println!("| {name} | {} |", cells.join(" | "));
    };
    row("aep-lineages", &|n| ours(&Lineages::default(), n));
    row("aep-lineages without model", &|n| ours(&bare, n));
    row("cma-es", &|n| ours(&CmaEs::default(), n));
    row("cmaes (crate)", &cmaes_crate);
    row("fcmaes-core CMA-ES", &fcmaes_crate);
}
