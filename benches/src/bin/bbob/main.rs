//! The methods and peers of other crates on COCO's BBOB suite: 24 noiseless functions, target 1e-8.
//!
//! `cargo run --release -p benches --features bbob --bin bbob -- bbob` writes `bbob/bbob.csv` (every
//! run), `bbob/bbob.md` (shares of solved runs) and `bbob/ert.md` (expected running time of each function),
//! and prints the first table. It needs a C compiler and libclang. `--observe` writes what `cocopp`
//! reads into `exdata/`; `--ablation` runs `aep-lineages` with each of its ingredients left out.
//!
//! Odd instances are told; even ones are what `aep-lineages` was tuned on.

mod contestant;
mod suite;
mod table;
mod task;

use std::error::Error;
use std::path::PathBuf;

use clap::Parser;
use coco_rs::LogLevel;

use contestant::Contestant;
use suite::Plan;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Runs methods on the BBOB suite.
#[derive(Parser)]
struct Arguments {
    /// Folder of the tables.
    #[arg(default_value = "bbob")]
    folder: PathBuf,
    /// Methods of `aep_core::methods`, and the peers `cmaes-crate` and `fcmaes-cma`.
    #[arg(
        long,
        value_delimiter = ',',
        default_value = "aep,aep-practical,aep-practical-restarts,aep-lineages,de,cma-es,cmaes-crate,fcmaes-cma"
    )]
    methods: Vec<String>,
    /// In place of `--methods`: aep-lineages, whole and without each of its ingredients (there are no residuals here).
    #[arg(long)]
    ablation: bool,
    /// Components.
    #[arg(long, value_delimiter = ',', default_value = "2,3,5,10,20")]
    dimensions: Vec<usize>,
    /// Instances of each function.
    #[arg(long, value_delimiter = ',', default_value = "1,3,5,7,9,11,13,15")]
    instances: Vec<usize>,
    /// Functions.
    #[arg(long, value_delimiter = ',', default_value = FUNCTIONS)]
    functions: Vec<usize>,
    /// Evaluations per component.
    #[arg(long, default_value_t = 10_000)]
    budget: u64,
    /// Writes results for `cocopp`, on one thread.
    #[arg(long)]
    observe: bool,
}

const FUNCTIONS: &str = "1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24";

fn main() -> Result<()> {
    LogLevel::Warning.set();
    let arguments = Arguments::parse();
    let contestants = if arguments.ablation {
        Contestant::ablation()
    } else {
        arguments.methods.iter().map(|name| Contestant::named(name)).collect::<Result<_>>()?
    };
    let Arguments { folder, dimensions, instances, functions, budget, observe, .. } = arguments;
    std::fs::create_dir_all(&folder)?;
    let plan = Plan { dimensions, functions, instances, budget };
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
