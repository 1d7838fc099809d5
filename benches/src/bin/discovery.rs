//! The discovery matrix: every hidden effect at every level over many seeds.
//!
//! `cargo run --release -p benches --bin discovery -- --seeds 30 --levels clear,moderate`

use std::collections::BTreeMap;

use benches::discovery::cell::{self, Answer, Level, Outcome};
use benches::discovery::motion::Excitation;
use benches::discovery::table::{ALL, Hidden};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

#[derive(Parser)]
#[command(about = "How often discovery names a hidden effect, as a table")]
struct Args {
    /// Seeds per cell
    #[arg(long, default_value_t = 30)]
    seeds: u64,
    /// First seed
    #[arg(long, default_value_t = 1)]
    first: u64,
    /// Levels: clear, moderate, faint
    #[arg(long, default_value = "clear,moderate", value_delimiter = ',')]
    levels: Vec<String>,
    /// Only hidden effects whose name contains this
    #[arg(long)]
    only: Option<String>,
    /// Pairs of effects instead of single ones
    #[arg(long)]
    pairs: bool,
    /// A motion that tells little
    #[arg(long)]
    poor: bool,
    /// Print every run that was not right
    #[arg(long)]
    verbose: bool,
}

struct Row {
    name: String,
    kinds: Vec<Hidden>,
    answers: Vec<&'static str>,
}

fn rows(args: &Args) -> Vec<Row> {
    let row = |(kind, name, answers): &(Hidden, &'static str, &'static [&'static str])| Row {
        name: (*name).to_owned(),
        kinds: vec![*kind],
        answers: answers.to_vec(),
    };
    let mut all: Vec<Row> = ALL.iter().map(row).collect();
    if args.pairs {
        let listed: Vec<Row> = all.into_iter().filter(|row| !row.answers.is_empty()).collect();
        all = listed
            .iter()
            .enumerate()
            .flat_map(|(i, a)| listed[i + 1..].iter().map(move |b| (a, b)))
            .filter(|(a, b)| a.answers != b.answers)
            .map(|(a, b)| Row {
                name: format!("{} + {}", a.name, b.name),
                kinds: [a.kinds.clone(), b.kinds.clone()].concat(),
                answers: [a.answers.clone(), b.answers.clone()].concat(),
            })
            .collect();
    }
    all.retain(|row| args.only.as_ref().is_none_or(|only| row.name.contains(only.as_str())));
    all
}

fn main() {
    let args = Args::parse();
    let excitation = if args.poor { Excitation::Poor } else { Excitation::Good };
    let rows = rows(&args);
    let levels: Vec<Level> = args.levels.iter().filter_map(|name| Level::parse(name)).collect();
    let bar = ProgressBar::new(rows.len() as u64 * levels.len() as u64 * args.seeds).with_style(
        ProgressStyle::with_template("{wide_bar} {pos}/{len} {eta} {msg}").expect("valid"),
    );
    println!(
        "| hidden | level | first | in a set | silent | unexplained | missed | wrong | with extra effects | error / true structure | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for row in &rows {
        for &level in &levels {
            bar.set_message(format!("{} {level:?}", row.name));
            let outcomes: Vec<Outcome> = (args.first..args.first + args.seeds)
                .into_par_iter()
                .filter_map(|seed| {
                    let outcome = cell::run(&row.kinds, &row.answers, level, excitation, seed);
                    bar.inc(1);
                    let wrong = outcome.as_ref().filter(|o| {
                        !matches!(o.answer, Answer::First | Answer::InSet | Answer::Silent)
                    });
                    if let (true, Some(outcome)) = (args.verbose, wrong) {
                        bar.suspend(|| {
                            eprintln!(
                                "{} seed {seed}: {:?}, {}",
                                row.name, outcome.answer, outcome.said
                            );
                        });
                    }
                    outcome
                })
                .collect();
            print_row(row, level, &outcomes);
        }
    }
    bar.finish_and_clear();
}

fn print_row(row: &Row, level: Level, outcomes: &[Outcome]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for outcome in outcomes {
        *counts.entry(format!("{:?}", outcome.answer)).or_default() += 1;
    }
    let count = |name: &str| counts.get(name).copied().unwrap_or(0);
    let mut ratios: Vec<f64> = outcomes.iter().filter_map(|o| o.error_ratio).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let at = |part: f64| ratios.get(((ratios.len() as f64 - 1.0) * part) as usize).copied();
    let ratio = match (at(0.5), at(0.95)) {
        (Some(median), Some(high)) => format!("{median:.3} (95 %: {high:.3})"),
        _ => "-".to_owned(),
    };
    let extra = outcomes.iter().filter(|outcome| outcome.extra > 0).count();
    let time = outcomes.iter().map(|o| o.wall_s).sum::<f64>() / outcomes.len().max(1) as f64;
    println!(
        "| {} | {level:?} | {} | {} | {} | {} | {} | {} | {extra} | {ratio} | {time:.2} |",
        row.name,
        count("First"),
        count("InSet"),
        count("Silent"),
        count("Unexplained"),
        count("Missed"),
        count("Wrong"),
    );
}
