//! `aep problems`: the test functions.

use std::fmt::Write;

use aep_problems::Definition;

use crate::app::Global;
use crate::failure::Failure;
use crate::output::{self, Align, Table, bold, dim, heading};

/// List the test functions for optimizers, with equations
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep problems              all of them, one line each
  aep problems rastrigin    everything about one")]
pub struct Args {
    /// Say everything about this one
    #[arg(value_name = "PROBLEM")]
    problem: Option<String>,
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let text = match &args.problem {
        None => list(),
        Some(name) => about(known(name)?),
    };
    if global.quiet { Ok(()) } else { output::print(&text) }
}

/// The function called `name`.
pub fn known(name: &str) -> Result<&'static Definition, Failure> {
    aep_problems::find(&name.to_lowercase()).ok_or_else(|| {
        let names: Vec<&str> = aep_problems::ALL.iter().map(|problem| problem.name).collect();
        let hint = format!("there are: {}", names.join(", "));
        Failure::bad_input(format!("no test function '{name}'")).with_hint(hint)
    })
}

fn list() -> String {
    let mut table = Table::new(&[
        ("problem", Align::Left),
        ("components", Align::Left),
        ("equation", Align::Left),
        ("what makes it easy or hard", Align::Left),
    ]);
    for problem in aep_problems::ALL {
        let (equation, character) = (problem.equation, problem.character);
        let dimension = problem.dimension.to_string();
        table.row([problem.name.to_owned(), dimension, equation.to_owned(), character.to_owned()]);
    }
    let hint = dim("'aep optimize NAME' compares optimizers on one of them");
    format!("{}\n {hint}\n", table.text())
}

fn about(problem: &'static Definition) -> String {
    let usual = problem.usual();
    let (lower, upper) = problem.limits;
    let mut text = heading(problem.name);
    for (title, content) in [
        ("equation", problem.equation.to_owned()),
        ("components", problem.dimension.to_string()),
        ("domain", format!("[{lower}, {upper}] in every component")),
        ("smallest cost", format!("{} at {:?}", usual.optimal_cost(), usual.optimum())),
        ("counts as solved at", format!("{}", usual.target())),
        ("character", problem.character.to_owned()),
        ("reference", problem.reference.to_owned()),
    ] {
        let _ = writeln!(text, " {}: {content}", bold(title));
    }
    text
}
