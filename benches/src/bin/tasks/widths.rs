//! What a large population does to evaluations and time, where evaluations run at the same time.

use std::time::{Duration, Instant};

use aep_core::{Batch, Budget, Domain, Driver, Problem, Start, methods};
use aep_problems::tasks;

use crate::Result;

const POPULATIONS: [usize; 3] = [10, 100, 1_000];
/// Unless others are asked for.
const METHODS: [&str; 3] = ["aep-practical", "de-fixed", "cma-es"];
const TASKS: [&str; 2] = ["failing-rod", "axis-in-windows"];
const EVALUATIONS: u64 = 20_000;
/// What an evaluation takes.
const WORK: Duration = Duration::from_millis(1);

/// A task whose evaluations take a simulator's time.
struct Slow<P>(P);

impl<P: Problem> Problem for Slow<P> {
    fn domain(&self) -> &Domain {
        self.0.domain()
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        let began = Instant::now();
        let cost = self.0.evaluate(x);
        while began.elapsed() < WORK {
            std::hint::spin_loop();
        }
        cost
    }

    fn evaluate_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        for (x, cost) in points.rows().zip(costs) {
            *cost = self.evaluate(x);
        }
    }
}

/// Prints the table: evaluations, generations and seconds of one trial, mean of `trials`.
pub fn main(asked: &[String], trials: usize) -> Result<()> {
    println!(
        "An evaluation takes 1 ms, {} threads. Solved trials of {trials}; evaluations, generations and seconds of a trial, mean.\n",
        rayon::current_num_threads()
    );
    println!("| task | method | population | solved | evaluations | generations | seconds |");
    println!("|---|---|---:|---:|---:|---:|---:|");
    let asked: Vec<&str> = asked.iter().map(String::as_str).collect();
    for task in TASKS {
        for method in if asked.is_empty() { &METHODS[..] } else { &asked } {
            let named = methods::find(method).ok_or("--widths has our methods only")?;
            for population in POPULATIONS {
                println!(
                    "| {task} | {method} | {population} | {} |",
                    row(task, named, population, trials)?
                );
            }
        }
    }
    Ok(())
}

fn row(task: &str, named: &methods::Named, population: usize, trials: usize) -> Result<String> {
    let task = tasks::find(task).ok_or("no such task")?.problem();
    let (target, task) = (task.target(), Slow(task));
    let budget = Budget::evaluations(EVALUATIONS).with_target(target);
    let (mut solved, mut sums) = (0, [0.0; 3]);
    for seed in 0..trials as u64 {
        let mut run = (named.build)(population).start(&Start::new(task.domain(), seed))?;
        let found = Driver::new(budget.clone()).in_parallel().run(&mut *run, &task)?;
        solved += usize::from(found.cost <= target);
        let numbers =
            [found.evaluations as f64, found.generations as f64, found.elapsed.as_secs_f64()];
        sums.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number);
    }
    let [evaluations, generations, seconds] = sums.map(|sum| sum / trials as f64);
    Ok(format!("{solved} | {evaluations:.0} | {generations:.0} | {seconds:.1}"))
}
