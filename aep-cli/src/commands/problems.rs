//! `aep problems`: the test functions and identification tasks.

use std::fmt::Write;

use aep_core::Scale;
use aep_problems::Definition;
use aep_problems::tasks::{self, Task};
use missing_physics::measurement::quantity::number;

use crate::app::Global;
use crate::failure::Failure;
use crate::output::{self, Align, Table, bold, dim, heading};

/// List the test functions and identification tasks for optimizers
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep problems              all of them, one line each
  aep problems rastrigin    everything about one
  aep problems two-mass     a task: its parameters, their limits and the best that is known")]
pub struct Args {
    /// Say everything about this one
    #[arg(value_name = "PROBLEM")]
    problem: Option<String>,
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let text = match &args.problem {
        None => list(),
        Some(name) => match known(name)? {
            Listed::Function(definition) => about(definition),
            Listed::Task(task) => about_task(task),
        },
    };
    if global.quiet { Ok(()) } else { output::print(&text) }
}

/// What a name stands for.
pub enum Listed {
    Function(&'static Definition),
    Task(&'static Task),
}

/// The function or task called `name`.
pub fn known(name: &str) -> Result<Listed, Failure> {
    let name = &name.to_lowercase();
    let function = aep_problems::find(name).map(Listed::Function);
    function.or_else(|| tasks::find(name).map(Listed::Task)).ok_or_else(|| {
        let names = aep_problems::ALL.iter().map(|problem| problem.name);
        let names: Vec<&str> = names.chain(tasks::ALL.iter().map(|task| task.name)).collect();
        let hint = format!("there are: {}", names.join(", "));
        Failure::bad_input(format!("no test function or task '{name}'")).with_hint(hint)
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
    let mut fits = Table::new(&[
        ("task", Align::Left),
        ("parameters", Align::Right),
        ("what is identified", Align::Left),
        ("what makes it easy or hard", Align::Left),
    ]);
    for task in tasks::ALL {
        let (subject, character) = (task.subject.to_owned(), task.character.to_owned());
        fits.row([task.name.to_owned(), task.parameters.len().to_string(), subject, character]);
    }
    let hint = dim("'aep optimize NAME' compares optimizers on one of them");
    format!("{}\n{}\n {hint}\n", table.text(), fits.text())
}

fn about_task(task: &'static Task) -> String {
    let mut table = Table::new(&[
        ("parameter", Align::Left),
        ("unit", Align::Left),
        ("from", Align::Right),
        ("to", Align::Right),
        ("scale", Align::Left),
        ("the recording was made with", Align::Right),
        ("best fit", Align::Right),
    ]);
    for (parameter, best) in task.parameters.iter().zip(task.best.position) {
        let (from, to) = parameter.limits;
        let scale = match parameter.scale {
            Scale::Linear => "linear",
            Scale::Log => "logarithmic",
        };
        let [from, to, truth, best] = [from, to, parameter.truth, *best].map(number);
        let name = parameter.name.to_owned();
        table.row([name, parameter.unit.to_owned(), from, to, scale.to_owned(), truth, best]);
    }
    let mut text = heading(task.name);
    for (title, content) in [
        ("identified", task.subject.to_owned()),
        ("smallest cost known", task.best.cost.to_string()),
        ("counts as solved at", task.problem().target().to_string()),
        ("character", task.character.to_owned()),
        ("reference", task.reference.to_owned()),
    ] {
        let _ = writeln!(text, " {}: {content}", bold(title));
    }
    let _ = writeln!(text, "{}", table.text());
    text
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
