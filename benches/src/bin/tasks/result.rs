//! Trials in numbers, and the tables.

use std::fmt::Write;

use aep_core::{Purpose, methods};

use crate::Result;
use aep_core::random::{self, Streams};
use aep_core::trials::quantile;

#[derive(Clone, Copy)]
pub struct Trial {
    pub evaluations: u64,
    pub solved: bool,
}

/// `aep-lineages` where it is told the residuals.
pub const TOLD: &str = "aep-lineages with residuals";

/// The method of others that is told them.
const PEER: &str = "scipy least_squares";

/// Whose method it is, and what it is told.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    Ours,
    Others,
    /// Methods that are told the residuals, not their sum of squares alone.
    Told,
}

impl Group {
    /// That of the method called `name`.
    pub fn of(name: &str) -> Self {
        match name {
            TOLD | "polish" | PEER => Self::Told,
            _ if methods::find(name).is_some() => Self::Ours,
            _ => Self::Others,
        }
    }
}

/// The trials of a method on a task.
pub struct Cell {
    pub task: String,
    pub method: String,
    pub trials: Vec<Trial>,
}

const RESAMPLED: u64 = 2_000;

/// Evaluations of all trials per solved one; infinite without one.
fn expected(trials: impl Iterator<Item = Trial> + Clone) -> f64 {
    let solved = trials.clone().filter(|trial| trial.solved).count();
    let spent: u64 = trials.map(|trial| trial.evaluations).sum();
    if solved == 0 { f64::INFINITY } else { spent as f64 / solved as f64 }
}

impl Cell {
    pub fn expected(&self) -> f64 {
        expected(self.trials.iter().copied())
    }

    pub fn solved(&self) -> usize {
        self.trials.iter().filter(|trial| trial.solved).count()
    }

    /// Nine tenths of what resampled trials give.
    pub fn interval(&self) -> (f64, f64) {
        let resampled = |i: u64| {
            let mut rng = Streams::new(1, Purpose::Trial, i).stream(0);
            let drawn: Vec<Trial> = (0..self.trials.len())
                .map(|_| self.trials[random::index(&mut rng, self.trials.len())])
                .collect();
            expected(drawn.into_iter())
        };
        let mut times: Vec<f64> = (0..RESAMPLED).map(resampled).collect();
        times.sort_by(f64::total_cmp);
        (quantile(&times, 0.05), quantile(&times, 0.95))
    }

    pub fn in_words(&self) -> String {
        let (low, high) = self.interval();
        let expected = number(self.expected());
        format!(
            "{expected} ({} .. {}), {} of {}",
            number(low),
            number(high),
            self.solved(),
            self.trials.len()
        )
    }
}

pub fn csv(cells: &[Cell]) -> String {
    let mut text = String::from("task,method,trial,evaluations,solved\n");
    for cell in cells {
        for (i, Trial { evaluations, solved }) in cell.trials.iter().enumerate() {
            let _ = writeln!(text, "{},{},{i},{evaluations},{solved}", cell.task, cell.method);
        }
    }
    text
}

/// What [`csv`] has written.
pub fn read(text: &str) -> Result<Vec<Cell>> {
    let mut cells: Vec<Cell> = Vec::new();
    for line in text.lines().skip(1) {
        let [task, method, _, evaluations, solved] = line.split(',').collect::<Vec<_>>()[..] else {
            return Err(format!("not a line of tasks.csv: {line}").into());
        };
        let trial = Trial { evaluations: evaluations.parse()?, solved: solved.parse()? };
        match cells.iter_mut().find(|cell| cell.task == task && cell.method == method) {
            Some(cell) => cell.trials.push(trial),
            None => {
                cells.push(Cell { task: task.into(), method: method.into(), trials: vec![trial] });
            }
        }
    }
    Ok(cells)
}

/// The names that `name` gives, each once, in their order.
fn once<'a>(cells: &'a [Cell], name: impl Fn(&'a Cell) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for cell in cells {
        if !names.contains(&name(cell)) {
            names.push(name(cell));
        }
    }
    names
}

/// The quickest of ours or of the others on a task.
pub fn best<'a>(cells: &'a [Cell], task: &str, group: Group) -> Option<&'a Cell> {
    let of = cells.iter().filter(|cell| cell.task == task && Group::of(&cell.method) == group);
    of.min_by(|a, b| a.expected().total_cmp(&b.expected()))
}

/// The trials of a method on a task.
pub fn cell<'a>(cells: &'a [Cell], task: &str, method: &str) -> Option<&'a Cell> {
    cells.iter().find(|cell| cell.task == task && cell.method == method)
}

pub fn tables(cells: &[Cell]) -> String {
    let (tasks, mut methods) = (once(cells, |cell| &cell.task), once(cells, |cell| &cell.method));
    methods.sort_by_key(|method| Group::of(method));
    let mut text = String::from("## All\n\nExpected evaluations, solved trials in brackets.\n\n");
    let _ = writeln!(
        text,
        "| task | {} |\n|---|{}",
        methods.join(" | "),
        "---:|".repeat(methods.len())
    );
    for task in &tasks {
        let entry = |method: &&str| match cell(cells, task, method) {
            Some(cell) if cell.solved() > 0 => {
                format!("{:.0} ({})", cell.expected(), cell.solved())
            }
            _ => "-".into(),
        };
        let entries: Vec<String> = methods.iter().map(entry).collect();
        let _ = writeln!(text, "| {task} | {} |", entries.join(" | "));
    }
    text.push_str("\n## The best of each\n\nExpected evaluations (nine tenths of resampled trials), solved trials.\n\n");
    text.push_str("| task | ours | | others | |\n|---|---|---|---|---|\n");
    for task in &tasks {
        let entry = |group: Group| match best(cells, task, group) {
            Some(cell) => format!("{} | {}", cell.method, cell.in_words()),
            None => "- | ".into(),
        };
        let _ = writeln!(text, "| {task} | {} | {} |", entry(Group::Ours), entry(Group::Others));
    }
    text.push_str("\n## Beside the best of the others\n\n");
    text.push_str(
        "| method | at most its evaluations | more than twice | of |\n|---|---:|---:|---:|\n",
    );
    for method in methods {
        let ratio = |task: &&str| {
            let own = cell(cells, task, method).filter(|_| Group::of(method) == Group::Ours)?;
            let other = best(cells, task, Group::Others)?;
            other.expected().is_finite().then(|| own.expected() / other.expected())
        };
        let ratios: Vec<f64> = tasks.iter().filter_map(ratio).collect();
        if !ratios.is_empty() {
            let _ = writeln!(text, "| {method} | {} |", counts(&ratios));
        }
    }
    text.push_str(&told(cells, &tasks));
    text
}

/// How many are at most 1, and how many more than 2, of how many.
fn counts(ratios: &[f64]) -> String {
    let count = |of: fn(&f64) -> bool| ratios.iter().filter(|ratio| of(ratio)).count();
    format!("{} | {} | {}", count(|r| *r <= 1.0), count(|r| *r > 2.0), ratios.len())
}

/// The methods that are told the residuals, beside the best of the others that is not, and the best of all others.
fn told(cells: &[Cell], tasks: &[&str]) -> String {
    let mut text = String::from("\n## Told the residuals\n\n");
    let _ = writeln!(
        text,
        "| task | {TOLD} | polish | {PEER} | best that sees costs | times that | times the best of all others |\n|---|---|---:|---:|---|---:|---:|"
    );
    let (mut of_costs, mut of_all) = (Vec::new(), Vec::new());
    for task in tasks {
        let expected = |method| cell(cells, task, method).map_or(f64::INFINITY, Cell::expected);
        let (Some(own), Some(other)) = (cell(cells, task, TOLD), best(cells, task, Group::Others))
        else {
            continue;
        };
        let ratio = |rival: f64| own.expected() / rival;
        let all = expected(PEER).min(other.expected());
        of_costs.push(ratio(other.expected()));
        of_all.push(ratio(all));
        let _ = writeln!(
            text,
            "| {task} | {} | {} | {} | {} {} | {:.2} | {:.2} |",
            own.in_words(),
            number(expected("polish")),
            number(expected(PEER)),
            other.method,
            number(other.expected()),
            ratio(other.expected()),
            ratio(all)
        );
    }
    text.push_str(
        "\n| beside | at most its evaluations | more than twice | of |\n|---|---:|---:|---:|\n",
    );
    let _ = writeln!(text, "| the best that sees costs | {} |", counts(&of_costs));
    let _ = writeln!(text, "| the best of all others | {} |", counts(&of_all));
    text
}

/// Expected evaluations; a dash where there are none.
pub fn number(expected: f64) -> String {
    if expected.is_finite() { format!("{expected:.0}") } else { "-".into() }
}
