//! The best parameters of the identification tasks, by a search that does not hurry.
//!
//! `cargo run --release -p aep-problems --example known_best [-- NAME ... | all]` prints, for each task (by default one that takes a second), the `BEST` of its file and how
//! it was found: 60 descents by least squares from random places, six runs each of CMA-ES, differential evolution and
//! AEP of 3,000 evaluations per parameter, each polished; around the best of all, and around the parameters that made the
//! recording, ever finer runs of CMA-ES, which see over what is rough. All of them take some ten minutes.

use aep_core::random::Streams;
use aep_core::{
    Budget, CmaEs, Driver, LeastSquares, Method, Problem, Purpose, Refined, Restarts, Start,
    methods, minimize, polish,
};
use aep_problems::tasks::{self, Identification, Task};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const DESCENTS: usize = 60;
const RUNS: u64 = 6;
const EVALUATIONS_PER_PARAMETER: u64 = 3_000;

fn descents(problem: &Identification) -> Result<Vec<Refined>> {
    let domain = Problem::domain(problem);
    let streams = Streams::new(1, Purpose::Initial, 1);
    let mut ends = Vec::new();
    for i in 0..DESCENTS {
        let (mut u, mut x) = (vec![0.0; domain.dimension()], vec![0.0; domain.dimension()]);
        domain.sample(&mut streams.stream(i), &mut u);
        domain.decode(&u, &mut x);
        ends.push(polish(problem, &x)?);
    }
    Ok(ends)
}

fn searches(problem: &Identification) -> Result<Vec<Refined>> {
    let evaluations = EVALUATIONS_PER_PARAMETER * Problem::domain(problem).dimension() as u64;
    let mut ends = Vec::new();
    for name in ["cma-es", "de", "aep-practical"] {
        let method = (methods::find(name).ok_or("no such method")?.build)(0);
        for seed in 0..RUNS {
            let found = minimize(problem, &*method, Budget::evaluations(evaluations), seed)?;
            ends.push(polish(problem, &found.position)?);
        }
    }
    Ok(ends)
}

/// Runs around `best`, each ten times as fine as the one before.
fn finer(problem: &Identification, mut best: Refined) -> Result<Refined> {
    let evaluations = EVALUATIONS_PER_PARAMETER * Problem::domain(problem).dimension() as u64;
    for (seed, sigma) in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-3, 1e-4, 1e-5].into_iter().enumerate() {
        let method = CmaEs::default().with_sigma(sigma).with_restarts(Restarts::Never);
        let initial = [best.position.clone()];
        let start = Start::new(Problem::domain(problem), seed as u64).with_initial(&initial);
        let mut run = method.start(&start)?;
        let found = Driver::new(Budget::evaluations(evaluations)).run(&mut *run, problem)?;
        let found = polish(problem, &found.position)?;
        if found.cost < best.cost {
            best = found;
        }
    }
    Ok(best)
}

fn search(task: &'static Task) -> Result<()> {
    let problem = task.problem().without_noise();
    let began = std::time::Instant::now();
    let descents = descents(&problem)?;
    let searches = searches(&problem)?;
    let least = descents.iter().chain(&searches).filter(|end| end.cost.is_finite());
    let least = least.min_by(|a, b| a.cost.total_cmp(&b.cost));
    let best = finer(&problem, least.ok_or("no search")?.clone())?;
    let from_truth = finer(&problem, polish(&problem, &task.truth())?)?;
    let best = if from_truth.cost < best.cost { from_truth } else { best };
    let there = |ends: &[Refined]| {
        ends.iter().filter(|end| end.cost <= best.cost * (1.0 + task.tolerance)).count()
    };
    let Refined { position, cost } = &best;
    println!(
        "{}: const BEST: Best = Best {{ cost: {cost:?}, position: &{position:?} }};",
        task.name
    );
    println!(
        "  {} residuals; {} of {DESCENTS} descents and {} of {} polished searches end there; with the true parameters {:.3}; {:.0} s",
        problem.residuals(position).len(),
        there(&descents),
        there(&searches),
        searches.len(),
        problem.exact(&task.truth()),
        began.elapsed().as_secs_f64()
    );
    Ok(())
}

fn main() -> Result<()> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names.push("two-decays".into());
    }
    let asked = |task: &&Task| names.iter().any(|name| name == task.name || name == "all");
    tasks::ALL.iter().filter(asked).try_for_each(search)
}
