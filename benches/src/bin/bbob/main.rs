//! The methods and peers of other crates on COCO's BBOB suite: 24 noiseless functions, target 1e-8.
//!
//! `cargo run --release -p benches --features bbob --bin bbob -- bbob` writes `bbob/bbob.csv` (every
//! run), `bbob/bbob.md` (shares of solved runs) and `bbob/ert.md` (expected running time of each function),
//! and prints the first table. It needs a C compiler and libclang. `--observe` writes what `cocopp`
//! reads into `exdata/`; `--suite noisy` and `--suite mixint` are its functions under noise and with whole numbers; `--ablation` runs `aep-lineages` with each of its ingredients left out.
//!
//! Odd instances are told; even ones are what `aep-lineages` was tuned on.

mod contestant;
mod noise;
mod suite;
mod table;
mod task;

use std::error::Error;
use std::path::PathBuf;
use std::sync::Arc;

use benches::python::Pool;
use clap::Parser;
use coco_rs::LogLevel;

use contestant::{Contestant, ONLY_NAMED, PYTHON};
use suite::{Kind, Plan};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Runs methods on the BBOB suite.
#[derive(Parser)]
struct Arguments {
    /// Folder of the tables.
    #[arg(default_value = "bbob")]
    folder: PathBuf,
    /// Methods of `aep_core::methods`, and the peers `cmaes-crate`, `fcmaes-cma`, `pycma`, `scipy-de`, `scipy-annealing` and `ngopt`;
    /// without it all that can work on the suite, but `ngopt`, which takes days.
    #[arg(long, value_delimiter = ',')]
    methods: Vec<String>,
    /// Which functions.
    #[arg(long, value_enum, default_value = "bbob")]
    suite: Kind,
    /// Python with numpy, scipy, cma and nevergrad, for its methods.
    #[arg(long, default_value = "python3")]
    python: String,
    /// In place of `--methods`: aep-lineages, whole and without each of its ingredients (there are no residuals here).
    #[arg(long)]
    ablation: bool,
    /// Components [default: 2,3,5,10,20; of mixint 5,10,20].
    #[arg(long, value_delimiter = ',')]
    dimensions: Vec<usize>,
    /// Instances of each function.
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7,9,11,13,15")]
    instances: Vec<usize>,
    /// Functions [default: all].
    #[arg(long, value_delimiter = ',')]
    functions: Vec<usize>,
    /// Evaluations per component.
    #[arg(long, default_value_t = 10_000)]
    budget: u64,
    /// Writes results for `cocopp`, on one thread.
    #[arg(long)]
    observe: bool,
}

/// Who is compared where nothing is said; the last ones search cubes only, and come from Python.
const OURS: [&str; 6] =
    ["aep", "aep-practical", "aep-practical-restarts", "aep-lineages", "de", "cma-es"];
const CUBES: [&str; 2] = ["cmaes-crate", "fcmaes-cma"];

fn main() -> Result<()> {
    LogLevel::Warning.set();
    let arguments = Arguments::parse();
    let Arguments { folder, suite, budget, observe, instances, .. } = arguments;
    let contestants = if arguments.ablation {
        Contestant::ablation()
    } else {
        let cubes = CUBES.into_iter().filter(|_| suite != Kind::Mixint);
        let all = || OURS.into_iter().chain(cubes).map(str::to_owned);
        let mut names = arguments.methods;
        let is_asked = |(here, _): &&(&str, &str)| {
            names.contains(&(*here).into()) || names.is_empty() && *here != ONLY_NAMED
        };
        let asked: Vec<_> = PYTHON.iter().filter(is_asked).collect();
        let (pool, installed) =
            if asked.is_empty() { Pool::none() } else { Pool::new(&arguments.python) };
        let (here, missing): (Vec<_>, Vec<_>) =
            asked.into_iter().partition(|(_, there)| installed.contains(&(*there).into()));
        if names.is_empty() {
            names = all().chain(here.into_iter().map(|(name, _)| (*name).to_owned())).collect();
        } else if let Some((name, there)) = missing.first() {
            return Err(format!(
                "{name} is not installed ({there})\n  give a Python that has it: --python"
            )
            .into());
        }
        let pool = Arc::new(pool);
        names.iter().map(|name| Contestant::named(name, &pool)).collect::<Result<_>>()?
    };
    let or = |given: Vec<usize>, all: Vec<usize>| if given.is_empty() { all } else { given };
    let functions = or(arguments.functions, suite.functions());
    let dimensions = or(arguments.dimensions, suite.dimensions());
    std::fs::create_dir_all(&folder)?;
    let plan = Plan { kind: suite, dimensions, functions, instances, budget };
    let mut runs = Vec::new();
    for contestant in &contestants {
        let own = plan.run(contestant, observe)?;
        let solved = own.iter().filter(|run| run.solved.is_some()).count();
        println!("{}: {solved} of {} solved", contestant.name(), own.len());
        runs.extend(own);
        // Written after every method: a long table that is broken off is not lost.
        let names: Vec<&str> = contestants.iter().map(Contestant::name).collect();
        std::fs::write(folder.join("bbob.csv"), table::csv(&runs))?;
        std::fs::write(folder.join("bbob.md"), table::shares(&plan, &names, &runs))?;
        std::fs::write(folder.join("ert.md"), table::times(&plan, &names, &runs))?;
    }
    println!("\n{}", std::fs::read_to_string(folder.join("bbob.md"))?);
    Ok(())
}
