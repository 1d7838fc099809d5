//! `aep optimize` with `--trace`, `--checkpoint` or `--resume`: a single run, followed and saved.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use aep_core::{
    Budget, Driver, Method, Observer as _, Outcome, Progress as Generation, RunError, Start,
    StopReason, Trace, TraceFormat,
};
use aep_problems::Known;

use crate::app::Global;
use crate::failure::Failure;
use crate::output::{self, dim, heading};
use crate::progress::Progress;
use crate::stop;

/// Following and saving a single run
#[derive(clap::Args)]
pub struct RunArgs {
    /// One run instead of trials: write every generation into this file (.csv or .jsonl)
    #[arg(long, value_name = "FILE", help_heading = "A single run")]
    trace: Option<PathBuf>,
    /// One run instead of trials: save it here every 10 generations and at the end
    #[arg(long, value_name = "FILE", help_heading = "A single run")]
    checkpoint: Option<PathBuf>,
    /// Go on with the run saved in this file, to the same result as without interruption; it is
    /// saved there again unless --checkpoint names another file
    #[arg(long, value_name = "FILE", help_heading = "A single run")]
    resume: Option<PathBuf>,
}

/// Generations between two checkpoints.
const EVERY: u64 = 10;

impl RunArgs {
    /// Whether a single run is wanted.
    pub fn wanted(&self) -> bool {
        self.trace.is_some() || self.checkpoint.is_some() || self.resume.is_some()
    }
}

/// Runs one method once.
pub fn run(
    args: &RunArgs,
    method: &dyn Method,
    problem: &dyn Known,
    (budget, seed): (Budget, u64),
    global: Global,
) -> Result<(), Failure> {
    let refused =
        |error: RunError| Failure::from_lines(&error.to_string()).with_hint_unless_given(HINT);
    let start = Start::new(problem.domain(), seed);
    let mut algorithm = method.start(&start).map_err(|error| refused(error.into()))?;
    let mut trace = args.trace.as_deref().map(|path| trace(path, problem)).transpose()?;
    let progress = Progress::new(global.quiet);
    let mut driver = Driver::new(budget).with_stop_flag(stop::flag()).in_parallel();
    driver = driver.with_observer(|now: &Generation<'_>| {
        progress.say(format!("generation {}, cost {:.3e}", now.generation, now.best_cost()));
    });
    if let Some(trace) = &mut trace {
        driver = driver.with_observer(|now: &Generation<'_>| trace.generation(now));
    }
    // What is resumed goes on to be saved where it was.
    if let Some(path) = args.checkpoint.as_ref().or(args.resume.as_ref()) {
        driver = driver.with_checkpoint(path, EVERY);
    }
    let outcome = match &args.resume {
        Some(path) => driver.resume(&mut *algorithm, &problem, path),
        None => driver.run(&mut *algorithm, &problem),
    };
    let outcome = outcome.map_err(refused)?;
    drop(driver);
    drop(progress);
    if let Some(trace) = &mut trace {
        trace.finished(&outcome);
    }
    finish(&outcome, &method.name(), problem, global)?;
    match (&args.trace, trace.as_ref().and_then(Trace::error)) {
        (Some(path), Some(error)) => {
            Err(Failure::failed(format!("cannot write the trace: {error}")).in_file(path))
        }
        _ => Ok(()),
    }
}

const HINT: &str = "give the problem, optimizer, population and seed that the run was started with";

fn trace(path: &Path, problem: &dyn Known) -> Result<Trace<BufWriter<File>>, Failure> {
    let format = match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => TraceFormat::Csv,
        Some("jsonl") => TraceFormat::JsonLines,
        _ => {
            let what = "a trace is a .csv or a .jsonl file";
            return Err(Failure::bad_input(what).in_file(path).with_hint("change --trace"));
        }
    };
    let file = File::create(path).map_err(|error| {
        Failure::bad_input(format!("cannot write the trace: {error}")).in_file(path)
    })?;
    Ok(Trace::new(BufWriter::new(file), format, problem.domain()))
}

fn finish(
    outcome: &Outcome,
    method: &str,
    problem: &dyn Known,
    global: Global,
) -> Result<(), Failure> {
    let name = problem.name();
    let text = format!(
        "{} cost {:e} at {:?}\n {}\n",
        heading(&format!("{method} on {name}")),
        outcome.cost,
        outcome.position,
        dim(&format!(
            "{} evaluations, {} generations, ended by: {}",
            outcome.evaluations, outcome.generations, outcome.stop
        )),
    );
    if !global.quiet {
        output::print(&text)?;
    }
    if let Some(error) = &outcome.checkpoint_error {
        return Err(Failure::failed(format!("cannot write the checkpoint: {error}")));
    }
    if outcome.stop == StopReason::Interrupted {
        return Err(Failure::interrupted("the best position so far is what is reported"));
    }
    Ok(())
}
