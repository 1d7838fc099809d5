//! Identification tasks, and De Jong's functions as printed and shifted: our methods beside those of others.
//!
//! ```sh
//! pip install numpy scipy cma nevergrad       # what is missing is skipped, and said
//! cargo run --release -p benches --bin tasks -- [--python python3] [-o FOLDER]
//! cargo run --release -p benches --bin tasks -- --keep --methods ours          # ours anew, the others as they were
//! cargo run --release -p benches --bin tasks -- --widths
//! ```
//!
//! Each trial has the same budget of evaluations and, for every method, the same start: trial t begins with the initial population
//! of the t-th seed; a method that starts from one position gets its first individual, with a step of 0.3 of the domain.
//! Where a method gives up before its budget is used, it starts again from the next seed. All of others search a
//! cube of width 1, logarithms where the task has them. An evaluation counts when it is made; a trial is solved by the first
//! position whose cost, without the noise of the simulator, is at the target. The expected running time is
//! the evaluations of all trials per solved trial; its interval holds nine tenths of 2,000 resampled sets of trials.
//!
//! The methods of Python run in processes that ask this one for every cost: the tasks, the count and the target are the same.

mod advice;
mod asked;
mod case;
mod ours;
mod peers;
mod result;
mod widths;

use std::path::PathBuf;

use aep_core::{Lineages, methods};
use clap::Parser;
use rayon::prelude::*;

use asked::Asked;
use benches::python::Pool;
use case::Case;
use peers::Peer;
use result::{Cell, Group, Trial};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Our methods and those of others on identification tasks and test functions.
#[derive(Parser)]
struct Args {
    /// Only these tasks and functions
    #[arg(long, value_delimiter = ',')]
    tasks: Vec<String>,
    /// Only these methods; "ours", "others" and "told" (the residuals) stand for all of a kind
    #[arg(long, value_delimiter = ',')]
    methods: Vec<String>,
    /// Trials of each
    #[arg(long, default_value_t = 15)]
    trials: usize,
    /// Seed of the trials: the table is told with 1, methods are tuned with others
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Evaluations of a trial per parameter
    #[arg(long, default_value_t = 1_000)]
    budget: u64,
    /// Python with numpy, scipy, cma and nevergrad
    #[arg(long, default_value = "python3")]
    python: String,
    /// Folder for tasks.md and tasks.csv
    #[arg(short, long, default_value = "tasks")]
    output: PathBuf,
    /// Keep what tasks.csv has of others: only what is run now is new
    #[arg(long)]
    keep: bool,
    /// What populations of 10, 100 and 1,000 do to evaluations and time, in place of the table
    #[arg(long)]
    widths: bool,
}

/// Who takes part.
enum Contestant {
    Ours(&'static methods::Named),
    Other(Peer),
    Python(String),
    /// `aep-lineages`, told the residuals.
    Told,
    /// [`aep_core::polish`] from one random place after the other.
    Descents,
}

impl Contestant {
    fn name(&self) -> &str {
        match self {
            Self::Ours(named) => named.name,
            Self::Other(peer) => peer.name(),
            Self::Python(name) => name,
            Self::Told => result::TOLD,
            Self::Descents => "polish",
        }
    }

    fn run(&self, case: &Case, seed: u64, budget: u64, pool: &Pool) -> Result<Trial> {
        let tally = case.tally(budget);
        // Who gives up starts again; who asks for nothing is not asked again.
        for again in 0.. {
            let before = tally.used();
            let seed = seed.wrapping_add(again);
            match self {
                Self::Ours(named) => ours::run(&*(named.build)(0), case, seed, &tally)?,
                Self::Other(peer) => peer.run(case, seed, &tally)?,
                Self::Told => ours::run_told(&Lineages::default(), case, seed, &tally)?,
                Self::Descents => ours::descend(case, seed, &tally)?,
                Self::Python(name) => {
                    let mut asked = Asked { case, tally: &tally };
                    pool.run(&asked.request(name, seed)?, &mut asked)?;
                }
            }
            if tally.is_over() || tally.used() == before {
                break;
            }
        }
        Ok(tally.trial())
    }
}

fn main() -> Result<()> {
    let args = Args::parse();
    if args.widths {
        return widths::main(&args.methods, args.trials.min(3));
    }
    let cases = case::all().into_iter();
    let cases: Vec<Case> =
        cases.filter(|case| args.tasks.is_empty() || args.tasks.contains(&case.name)).collect();
    let (pool, python) = Pool::new(&args.python);
    let ours = methods::ALL.iter().map(Contestant::Ours);
    let others = Peer::ALL.into_iter().map(Contestant::Other);
    let contestants = ours.chain(others).chain(python.into_iter().map(Contestant::Python));
    let contestants = contestants.chain([Contestant::Told, Contestant::Descents]);
    let asked = |contestant: &Contestant| {
        let kind = match Group::of(contestant.name()) {
            Group::Ours => "ours",
            Group::Others => "others",
            Group::Told => "told",
        };
        args.methods.is_empty()
            || args.methods.iter().any(|name| name == contestant.name() || name == kind)
    };
    let contestants: Vec<Contestant> = contestants.filter(asked).collect();
    if cases.is_empty() || contestants.is_empty() {
        return Err("no such task or method; leave --tasks and --methods out to see all".into());
    }
    std::fs::create_dir_all(&args.output)?;
    let file = args.output.join("tasks.csv");
    let mut cells =
        if args.keep { result::read(&std::fs::read_to_string(&file)?)? } else { Vec::new() };
    for case in &cases {
        let told = |contestant: &Contestant| Group::of(contestant.name()) == Group::Told;
        for contestant in contestants.iter().filter(|c| !told(c) || case.facts.residuals) {
            cells.retain(|cell| cell.task != case.name || cell.method != contestant.name());
            let run = |trial: usize| {
                contestant
                    .run(case, Case::seed(args.seed, trial), case.budget(args.budget), &pool)
                    .map_err(|error| format!("{} on {}: {error}", contestant.name(), case.name))
            };
            let trials: std::result::Result<Vec<Trial>, String> =
                (0..args.trials).into_par_iter().map(run).collect();
            let (task, method) = (case.name.clone(), contestant.name().to_owned());
            let cell = Cell { task, method, trials: trials? };
            eprintln!("{}: {} {}", cell.task, cell.method, cell.in_words());
            cells.push(cell);
            std::fs::write(&file, result::csv(&cells))?;
        }
    }
    let mut text = result::tables(&cells);
    text.push_str(&advice::table(&cases, &cells, args.budget));
    std::fs::write(args.output.join("tasks.md"), &text)?;
    println!("{text}");
    Ok(())
}
