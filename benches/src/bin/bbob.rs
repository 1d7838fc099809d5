//! The BBOB suite of COCO: 24 functions that no one here wrote, shifted and rotated differently in
//! each instance.
//!
//! `cargo run --release -p benches --features bbob --bin bbob -- [FOLDER]`; needs a C compiler and
//! libclang. Each method makes one run per function and instance in 2, 5 and 10 dimensions with at
//! most 10,000 evaluations per dimension. `aep-practical-restarts` and `cma-es` double
//! their population and start again when they are stuck; the others make one run.
//! A run counts as solved when the cost is within 1e-8 of the smallest. The expected running time
//! of a function is the evaluations of all its runs per solved run.
//!
//! The positions are asked for and the costs told: COCO's problems must not leave their thread.
//!
//! Reference: N. Hansen et al., "COCO: A Platform for Comparing Continuous Optimizers in a Black-Box
//! Setting", Optimization Methods and Software 36, 2021.

use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;

use aep_core::{Domain, Method, Start, methods};
use coco_rs::{LogLevel, Problem, Suite, suite};

const DIMENSIONS: [usize; 3] = [2, 5, 10];
const INSTANCES: usize = 5;
const FUNCTIONS: usize = 24;
const BUDGET_PER_DIMENSION: u64 = 10_000;
const METHODS: [&str; 8] = [
    "aep",
    "aep-practical",
    "aep-practical-restarts",
    "meta-ep",
    "meta-ep-practical",
    "de",
    "de-fixed",
    "cma-es",
];
/// Functions of each of the suite's groups, counted from 1.
const GROUPS: [(&str, std::ops::RangeInclusive<usize>); 5] = [
    ("separable", 1..=5),
    ("moderate", 6..=9),
    ("ill-conditioned", 10..=14),
    ("multimodal", 15..=19),
    ("weakly structured", 20..=24),
];

/// One run.
struct Run {
    method: &'static str,
    dimension: usize,
    function: usize,
    evaluations: u64,
    solved: bool,
}

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    LogLevel::Warning.set();
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "bbob".into()));
    std::fs::create_dir_all(&folder)?;
    let mut runs = Vec::new();
    for name in METHODS {
        let named = methods::find(name).ok_or("unknown method")?;
        let before = runs.len();
        all_problems(name, &*(named.build)(0), &mut runs)?;
        let solved = runs[before..].iter().filter(|run| run.solved).count();
        println!("{name}: {solved} of {} solved", runs.len() - before);
    }
    std::fs::write(folder.join("bbob.csv"), csv(&runs))?;
    let tables = tables(&runs);
    std::fs::write(folder.join("bbob.md"), &tables)?;
    println!("\n{tables}");
    Ok(())
}

fn all_problems(name: &'static str, method: &dyn Method, runs: &mut Vec<Run>) -> Result<()> {
    let instances = format!("instances: 1-{INSTANCES}");
    let options = format!("dimensions: {}", DIMENSIONS.map(|d| d.to_string()).join(","));
    let suite = Suite::new(suite::Name::Bbob, &instances, &options);
    let mut suite = suite.ok_or("COCO has no BBOB suite")?;
    let mut count = 0;
    while let Some(mut problem) = suite.next_problem(None) {
        // Problems come by dimension, then function, then instance.
        let function = count / INSTANCES % FUNCTIONS + 1;
        let seed = (count % INSTANCES) as u64 + 1;
        let dimension = problem.dimension();
        let (evaluations, solved) = solve(&mut problem, method, seed)?;
        runs.push(Run { method: name, dimension, function, evaluations, solved });
        count += 1;
    }
    if count == DIMENSIONS.len() * FUNCTIONS * INSTANCES {
        return Ok(());
    }
    Err(format!("{count} problems: not the suite that was expected").into())
}

fn solve(problem: &mut Problem<'_>, method: &dyn Method, seed: u64) -> Result<(u64, bool)> {
    let limits = problem.ranges_of_interest();
    let lower = limits.iter().map(|range| *range.start()).collect();
    let upper = limits.iter().map(|range| *range.end()).collect();
    let domain = Domain::new(lower, upper)?;
    let mut optimizer = method.start(&Start::new(&domain, seed))?;
    let budget = BUDGET_PER_DIMENSION * problem.dimension() as u64;
    let mut used = 0;
    while used < budget && optimizer.exhausted().is_none() {
        let points = optimizer.ask();
        let mut costs = vec![f64::INFINITY; points.len()];
        for (x, cost) in points.rows().zip(costs.chunks_mut(1)) {
            problem.evaluate_function(x, cost);
            used += 1;
            if problem.final_target_hit() {
                return Ok((used, true));
            }
        }
        optimizer.tell(&costs)?;
    }
    Ok((used, false))
}

fn csv(runs: &[Run]) -> String {
    let mut text = String::from("method,dimension,function,evaluations,solved\n");
    for run in runs {
        let Run { method, dimension, function, evaluations, solved } = run;
        let _ = writeln!(text, "{method},{dimension},{function},{evaluations},{solved}");
    }
    text
}

fn tables(runs: &[Run]) -> String {
    let mut text = String::new();
    for dimension in DIMENSIONS {
        let _ = writeln!(text, "### {dimension} dimensions\n");
        let groups = GROUPS.map(|(name, _)| name).join(" | ");
        let _ =
            writeln!(text, "| method | solved | {groups} | median ERT / n | functions solved |");
        let _ = writeln!(text, "|---|---:|{}---:|---:|", "---:|".repeat(GROUPS.len()));
        for method in METHODS {
            let own: Vec<&Run> =
                runs.iter().filter(|r| r.method == method && r.dimension == dimension).collect();
            let _ = writeln!(text, "{}", row(method, dimension, &own));
        }
        text.push('\n');
    }
    text
}

fn row(method: &str, dimension: usize, runs: &[&Run]) -> String {
    let percent = |functions: &std::ops::RangeInclusive<usize>| {
        let of: Vec<_> = runs.iter().filter(|run| functions.contains(&run.function)).collect();
        let solved = of.iter().filter(|run| run.solved).count();
        format!("{:.0} %", 100.0 * solved as f64 / of.len() as f64)
    };
    let groups = GROUPS.map(|(_, functions)| percent(&functions)).join(" | ");
    let mut times: Vec<f64> = (1..=FUNCTIONS).map(|f| expected_time(f, runs)).collect();
    times.sort_by(f64::total_cmp);
    let middle = f64::midpoint(times[FUNCTIONS / 2 - 1], times[FUNCTIONS / 2]) / dimension as f64;
    let middle = if middle.is_finite() { format!("{middle:.0}") } else { "-".into() };
    let ever = times.iter().filter(|time| time.is_finite()).count();
    let all = percent(&(1..=FUNCTIONS));
    format!("| {method} | {all} | {groups} | {middle} | {ever} of {FUNCTIONS} |")
}

/// Evaluations of all runs on a function per solved run; infinite without one.
fn expected_time(function: usize, runs: &[&Run]) -> f64 {
    let of = || runs.iter().filter(|run| run.function == function);
    let solved = of().filter(|run| run.solved).count();
    let spent: u64 = of().map(|run| run.evaluations).sum();
    if solved == 0 { f64::INFINITY } else { spent as f64 / solved as f64 }
}
