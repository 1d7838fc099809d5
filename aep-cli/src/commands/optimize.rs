//! `aep optimize`: optimizers compared on a test function or an identification task.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use aep_core::trials::{Plan, RankTest, Summary, Trials, rank_test};
use aep_core::methods::{self, Facts, recommend};
use aep_core::{Budget, Method};
use aep_problems::tasks::{Identification, Task};
use aep_problems::{Known, TestProblem};
use aep_studio::report::plain::{self, Part};
use serde::Serialize;

use super::optimize_run::{self, RunArgs};
use super::problems::{Listed, known};
use super::reproduce_figure::keep;
use crate::app::Global;
use crate::curve_plot::{self, Axes, Curve};
use crate::failure::Failure;
use crate::output::{self, Table, dim};
use crate::progress::Progress;
use crate::report::command;
use crate::stop;

/// Compare optimizers on a test function or an identification task: same initial populations, statistics over trials
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep optimize rosenbrock --algorithm aep-practical,de,cma-es --trials 50
  aep optimize two-mass --algorithm auto,de --evaluations 7000
  aep optimize f5 --algorithm aep,meta-ep --generations 1500 -o f5
  aep optimize rastrigin --dimension 5 --shift --evaluations 50000
  aep optimize f4 --algorithm aep-practical --trace run.csv --checkpoint run.ckpt
  aep optimize f4 --algorithm aep-practical --resume run.ckpt")]
pub struct Args {
    /// Test function or identification task ('aep problems' lists them)
    #[arg(value_name = "PROBLEM")]
    problem: String,
    /// Optimizers; the first one is compared with each of the others; 'auto' takes the one that is recommended for the problem
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        default_value = "aep,aep-practical,meta-ep,de,cma-es"
    )]
    algorithm: Vec<String>,
    /// Trials of each
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..))]
    trials: u32,
    /// Components, where the function has any number of them
    #[arg(long, value_name = "N")]
    dimension: Option<usize>,
    /// Evaluations of each trial
    #[arg(long, value_name = "N", default_value_t = 20_000)]
    evaluations: u64,
    /// Generations of each trial in place of evaluations
    #[arg(long, value_name = "N", conflicts_with = "evaluations")]
    generations: Option<u64>,
    /// Seconds of each trial at most; results then depend on the machine
    #[arg(long, value_name = "SECONDS", value_parser = super::positive)]
    time: Option<f64>,
    /// Cost that counts as solved; by default the function's own
    #[arg(long, value_name = "COST", allow_negative_numbers = true)]
    target: Option<f64>,
    /// Individuals; by default the method's own number
    #[arg(long, value_name = "N", default_value_t = 0)]
    population: usize,
    /// Move the optimum to a random place, another one in each trial
    #[arg(long)]
    shift: bool,
    /// Add a number from N(0, 1) to every cost
    #[arg(long)]
    noise: bool,
    /// Seed of every random choice; the same seed gives the same result
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write curves, trials and plot into this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write the summary as JSON; `-` for the terminal
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write table and curves as one HTML file that loads nothing from elsewhere; `-` for the terminal
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    single: RunArgs,
}

/// The method that descends on residuals.
const DESCENDS: &str = "aep-lineages";

/// The results, as written to JSON.
#[derive(Serialize)]
struct Comparison {
    problem: &'static str,
    dimension: usize,
    target: f64,
    plan: Plan,
    version: &'static str,
    summaries: Vec<Summary>,
    /// The first method against each of the others.
    first_against: Vec<Option<RankTest>>,
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let problem = problem(args)?;
    let mut notes = Vec::new();
    let chosen = args.algorithm.iter().map(|name| match name.as_str() {
        "auto" => Ok(recommended(args, &problem, &mut notes)),
        name => method(name, args.population),
    });
    let chosen = chosen.collect::<Result<Vec<Box<dyn Method>>, Failure>>()?;
    let target = args.target.unwrap_or_else(|| problem.known().target());
    if args.single.wanted() {
        let [method] = &chosen[..] else {
            let what = "--trace, --checkpoint and --resume follow a single run";
            return Err(Failure::bad_input(what).with_hint("name one optimizer by --algorithm"));
        };
        if args.html.is_some() {
            return Err(Failure::bad_input("a single run has no page")
                .with_hint("leave --html out: --trace run.csv has every generation"));
        }
        let run = (budget(args, problem.known(), target), args.seed);
        let problem = if args.shift { problem.shifted(args.seed) } else { problem };
        return optimize_run::run(&args.single, &**method, problem.known(), run, global);
    }
    let plan = Plan::new(args.trials as usize, budget(args, problem.known(), target)).with_seed(args.seed);
    let progress = Progress::new(global.quiet);
    progress.count_to(u64::from(args.trials) * chosen.len() as u64);
    let stop = stop::flag();
    let mut results = Vec::new();
    for method in &chosen {
        progress.say(method.name());
        let trials = trials(args, &plan, &**method, &problem, (stop, &progress))?;
        if !trials.trials.is_empty() {
            results.push(trials);
        }
    }
    drop(progress);
    let interrupted = stop.load(Ordering::Relaxed);
    if interrupted && results.is_empty() {
        return Err(Failure::interrupted("no trial had ended"));
    }
    let comparison = compare(problem.known(), target, plan, &results);
    if let Some(path) = &args.json {
        output::save_json(path, &comparison)?;
    }
    let mut part = table(&comparison);
    part.notes.extend(notes);
    if matches!(problem, Chosen::Task(_)) && chosen.iter().any(|method| method.name() == DESCENDS) {
        part.notes.push(format!("{DESCENDS} is told the residuals, all others the sum of their squares"));
    }
    if problem.known().is_noisy() {
        part.notes.push("costs have noise in them, and so has 'solved'".to_owned());
    }
    if let Some(path) = &args.html {
        part.figures.push(curves(problem.known(), &results, curve_plot::figure));
        let summary = format!("{} trials of each, the same first populations.", args.trials);
        output::save(path, &plain::page("Optimizers compared", &summary, std::slice::from_ref(&part), &command()))?;
    }
    let files = args.output.as_deref().map_or(Ok(Vec::new()), |directory| {
        write(directory, problem.known(), &comparison, &results)
    })?;
    let own_stdout = args.html.as_deref().is_some_and(|path| path.as_os_str() == "-");
    if !global.quiet && !own_stdout {
        output::print(&report(&part, &files))?;
    }
    if interrupted {
        return Err(Failure::interrupted("the trials that had ended are what is reported"));
    }
    Ok(())
}

/// What is to be solved.
enum Chosen {
    Function(TestProblem),
    Task(Identification),
}

impl Chosen {
    fn known(&self) -> &dyn Known {
        match self {
            Self::Function(function) => function,
            Self::Task(task) => task,
        }
    }

    /// A function with its optimum elsewhere.
    fn shifted(self, seed: u64) -> Self {
        match self {
            Self::Function(function) => Self::Function(function.with_random_shift(seed)),
            Self::Task(_) => self,
        }
    }

    fn facts(&self) -> Facts {
        let known = self.known();
        let facts = Facts::new(known.domain().dimension()).with_noise(known.is_noisy());
        match self {
            Self::Function(_) => facts,
            Self::Task(_) => facts.with_residuals(),
        }
    }
}

fn problem(args: &Args) -> Result<Chosen, Failure> {
    let definition = match known(&args.problem)? {
        Listed::Function(definition) => definition,
        Listed::Task(task) => return of_task(args, task),
    };
    let dimension = args.dimension.unwrap_or_else(|| definition.dimension.usual());
    let problem = definition
        .in_dimension(dimension)
        .map_err(|error| Failure::bad_input(error.to_string()).with_hint("change --dimension"))?;
    Ok(Chosen::Function(if args.noise { problem.with_noise(args.seed) } else { problem }))
}

/// A task is as it is.
fn of_task(args: &Args, task: &'static Task) -> Result<Chosen, Failure> {
    let unknown = [("--dimension", args.dimension.is_some()), ("--shift", args.shift), ("--noise", args.noise)];
    match unknown.iter().find(|(_, given)| *given) {
        Some((flag, _)) => {
            let what = format!("{flag} is for test functions: the task '{}' is as it was recorded", task.name);
            Err(Failure::bad_input(what).with_hint(format!("leave {flag} out")))
        }
        None => Ok(Chosen::Task(task.problem())),
    }
}

/// The method that is recommended, and why.
fn recommended(args: &Args, problem: &Chosen, notes: &mut Vec<String>) -> Box<dyn Method> {
    let evaluations = if args.generations.is_some() { 0 } else { args.evaluations };
    let advice = recommend(&problem.facts(), evaluations);
    notes.push(format!("auto: {}, {}", advice.method.name, advice.why));
    (advice.method.build)(if args.population == 0 { advice.population } else { args.population })
}

fn method(name: &str, population: usize) -> Result<Box<dyn Method>, Failure> {
    let named = methods::find(name).ok_or_else(|| {
        let names = methods::ALL.iter().map(|method| method.name);
        let names: Vec<&str> = names.chain(["auto"]).collect();
        let hint = format!("there are: {}", names.join(", "));
        Failure::bad_input(format!("no optimizer '{name}'")).with_hint(hint)
    })?;
    Ok((named.build)(population))
}

/// A noisy cost says nothing about being there, so noise leaves the target out of the budget.
fn budget(args: &Args, problem: &dyn Known, target: f64) -> Budget {
    let budget = match args.generations {
        Some(generations) => Budget::generations(generations),
        None => Budget::evaluations(args.evaluations),
    };
    let budget = match args.time {
        Some(seconds) => budget.with_time(Duration::from_secs_f64(seconds.min(1e9))),
        None => budget,
    };
    if problem.is_noisy() { budget } else { budget.with_target(target) }
}

fn trials(
    args: &Args,
    plan: &Plan,
    method: &dyn Method,
    problem: &Chosen,
    (stop, progress): (&AtomicBool, &Progress),
) -> Result<Trials, Failure> {
    let ended = || progress.one_more();
    let trials = match problem {
        Chosen::Function(function) if args.shift => {
            let of_trial = |trial| function.clone().with_random_shift(plan.trial_seed(trial));
            plan.run_watched(method, of_trial, stop, &ended)
        }
        Chosen::Function(function) => plan.run_watched(method, |_| function, stop, &ended),
        Chosen::Task(task) => plan.run_watched(method, |_| task, stop, &ended),
    };
    trials.map_err(|error| {
        Failure::bad_input(error.to_string()).with_hint("change --population or --algorithm")
    })
}

fn compare(problem: &dyn Known, target: f64, plan: Plan, results: &[Trials]) -> Comparison {
    let merits: Vec<_> = results.iter().map(|trials| trials.merits(target)).collect();
    let against = |i: usize| (i > 0).then(|| rank_test(&merits[0], &merits[i]));
    Comparison {
        problem: problem.name(),
        dimension: problem.domain().dimension(),
        target,
        plan,
        version: env!("CARGO_PKG_VERSION"),
        summaries: results.iter().map(|trials| trials.summary(target)).collect(),
        first_against: (0..results.len()).map(against).collect(),
    }
}

fn table(comparison: &Comparison) -> Part {
    let (name, target) = (comparison.problem, comparison.target);
    let count = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.0}"));
    let row = |(summary, test): (&Summary, &Option<RankTest>)| {
        let (low, high) = summary.quartiles;
        vec![
            summary.method.clone(),
            format!("{}/{}", summary.successes, summary.trials),
            count(summary.evaluations_to_target),
            count(summary.expected_running_time),
            format!("{:.2e}", summary.median),
            format!("{low:.1e} .. {high:.1e}"),
            format!("{:.2e}", summary.mean),
            test.map_or(String::new(), |test| format!("{:.2}", test.effect)),
            test.map_or(String::new(), |test| format!("{:.0e}", test.p_value)),
        ]
    };
    let headings = [
        "optimizer",
        "#solved",
        "#evaluations",
        "#expected with restarts",
        "#median cost",
        "#quartiles",
        "#mean cost",
        "#first is better",
        "#p",
    ];
    Part {
        id: "optimizers".to_owned(),
        title: format!("{name} in {} components, solved at {target:.3e}", comparison.dimension),
        notes: vec![
            "'first is better': probability that a trial of the first optimizer beats one of this row; \
             p: rank test of no difference"
                .to_owned(),
        ],
        headings: headings.map(str::to_owned).to_vec(),
        rows: comparison.summaries.iter().zip(&comparison.first_against).map(row).collect(),
        figures: Vec::new(),
    }
}

fn report(part: &Part, files: &[PathBuf]) -> String {
    let mut text = format!("{}\n {}\n", Table::of(part), dim(&part.notes.join("; ")));
    for file in files {
        let _ = writeln!(text, " {} {}", dim("written"), file.display());
    }
    text
}

fn write(
    directory: &Path,
    problem: &dyn Known,
    comparison: &Comparison,
    results: &[Trials],
) -> Result<Vec<PathBuf>, Failure> {
    output::make_folder(directory)?;
    let mut files = Vec::new();
    keep(&mut files, &directory.join("curves.csv"), &curves_csv(results))?;
    keep(&mut files, &directory.join("curves.svg"), &curves(problem, results, curve_plot::svg)?)?;
    keep(&mut files, &directory.join("trials.csv"), &trials_csv(comparison.target, results))?;
    let summary = directory.join("summary.json");
    output::save_json(&summary, comparison)?;
    files.push(summary);
    Ok(files)
}

/// Evaluations at which curves are written.
fn grid(results: &[Trials]) -> Vec<u64> {
    const POINTS: u64 = 500;
    let last = results.iter().map(Trials::longest).max().unwrap_or(0);
    let step = last.div_ceil(POINTS).max(1);
    (1..=last.div_ceil(step)).map(|i| (i * step).min(last)).collect()
}

fn curves_csv(results: &[Trials]) -> String {
    let mut text = String::from("optimizer,evaluations,mean,median,first_quartile,third_quartile\n");
    for trials in results {
        for evaluations in grid(results) {
            let point = trials.after(evaluations);
            let (mean, median, low, high) = (point.mean, point.median, point.low, point.high);
            let method = &trials.method;
            let _ = writeln!(text, "{method},{evaluations},{mean:e},{median:e},{low:e},{high:e}");
        }
    }
    text
}

fn trials_csv(target: f64, results: &[Trials]) -> String {
    let columns = "optimizer,trial,seed,cost,evaluations,evaluations_to_target,failures,stop\n";
    let mut text = String::from(columns);
    for trials in results {
        for (i, trial) in trials.trials.iter().enumerate() {
            let reached = trial.evaluations_to(target).map_or(String::new(), |used| used.to_string());
            let (method, seed, cost) = (&trials.method, trial.seed, trial.cost);
            let (used, failures) = (trial.evaluations, trial.failures.total());
            let stop = &trial.stop;
            let _ = writeln!(text, "{method},{i},{seed},{cost:e},{used},{reached},{failures},{stop}");
        }
    }
    text
}

/// The curves, drawn by `draw`.
fn curves<T>(
    problem: &dyn Known,
    results: &[Trials],
    draw: impl Fn(Axes<'_>, &[Curve]) -> T,
) -> T {
    let above = |cost: f64| cost - problem.smallest();
    let grid = grid(results);
    let curve = |trials: &Trials| {
        let points: Vec<_> = grid.iter().map(|evaluations| trials.after(*evaluations)).collect();
        let at = |e: u64| e as f64;
        Curve {
            label: trials.method.clone(),
            points: points.iter().map(|p| (at(p.evaluations), above(p.median))).collect(),
            band: points.iter().map(|p| (at(p.evaluations), above(p.low), above(p.high))).collect(),
        }
    };
    let title = format!("{}, median and quartiles", problem.name());
    let (x, y) = ("evaluations", "cost above the smallest");
    let axes = Axes { title: &title, x, y, logarithmic: true };
    draw(axes, &results.iter().map(curve).collect::<Vec<Curve>>())
}
