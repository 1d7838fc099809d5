//! The discovery matrix: every hidden effect at every level over many seeds.
//!
//! `cargo run --release -p benches --bin discovery -- --seeds 30 --levels clear,moderate`

use std::path::{Path, PathBuf};

use benches::discovery::cell::{self, Answer, Outcome};
use benches::discovery::hidden::Case;
use benches::discovery::motion::Excitation;
use benches::discovery::size::Level;
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
    /// Write every run that was not right to the standard error
    #[arg(long)]
    verbose: bool,
    /// Write the recordings as CSV files instead of asking
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
}

fn main() {
    let args = Args::parse();
    let excitation = if args.poor { Excitation::Poor } else { Excitation::Good };
    let mut cases = if args.pairs { Case::pairs() } else { Case::singles() };
    cases.retain(|case| args.only.as_ref().is_none_or(|only| case.name.contains(only.as_str())));
    let levels: Vec<Level> = args.levels.iter().filter_map(|name| Level::parse(name)).collect();
    if let Some(folder) = &args.write {
        if let Err(error) = std::fs::create_dir_all(folder) {
            eprintln!("{}: {error}", folder.display());
            std::process::exit(2);
        }
        for (case, level) in cases.iter().flat_map(|case| levels.iter().map(move |l| (case, *l))) {
            for seed in args.first..args.first + args.seeds {
                save(folder, case, level, excitation, seed);
            }
        }
        return;
    }
    let bar = ProgressBar::new(cases.len() as u64 * levels.len() as u64 * args.seeds).with_style(
        ProgressStyle::with_template("{wide_bar} {pos}/{len} {eta} {msg}").expect("valid"),
    );
    println!(
        "| hidden | level | runs | first | in a set | silent | unexplained | missed | wrong | \
         extra effects | error / true structure | size within 10 % | s |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut sums: Vec<(Level, Vec<Outcome>)> = levels.iter().map(|l| (*l, Vec::new())).collect();
    for case in &cases {
        for (level, all) in &mut sums {
            bar.set_message(format!("{} {level:?}", case.name));
            let outcomes: Vec<Outcome> = (args.first..args.first + args.seeds)
                .into_par_iter()
                .filter_map(|seed| {
                    let outcome = cell::run(case, *level, excitation, seed);
                    bar.inc(1);
                    if let (true, Some(outcome)) = (args.verbose, &outcome) {
                        bar.suspend(|| tell(case, *level, seed, outcome));
                    }
                    outcome
                })
                .collect();
            println!("| {} | {level:?} {}", case.name, cells(&outcomes));
            if !case.answers.is_empty() {
                all.extend(outcomes);
            }
        }
    }
    bar.finish_and_clear();
    for (level, all) in &sums {
        println!("| **all listed** | {level:?} {}", cells(all));
    }
}

/// Writes one recording, where there is one.
fn save(folder: &Path, case: &Case, level: Level, excitation: Excitation, seed: u64) {
    let table = cell::table(case, level, excitation, seed);
    let Some(Ok(recording)) = table.map(|table| table.record(excitation)) else { return };
    let name = case.name.replace([' ', ','], "-");
    let path = folder.join(format!("{name}-{level:?}-{seed}.csv").to_lowercase());
    let text = aep_data::to_csv(&recording);
    if let Err(error) = aep_data::save(&path, text.as_bytes()) {
        eprintln!("{error}");
    }
}

fn tell(case: &Case, level: Level, seed: u64, outcome: &Outcome) {
    let fine = matches!(outcome.answer, Answer::First | Answer::Silent) && outcome.extra == 0;
    if !fine {
        let Case { name, .. } = case;
        eprintln!("{name} {level:?} seed {seed}: {:?}, {}", outcome.answer, outcome.said);
    }
}

/// The cells of a row after hidden effect and level.
fn cells(outcomes: &[Outcome]) -> String {
    let count = |answer: Answer| outcomes.iter().filter(|o| o.answer == answer).count();
    let answers = [
        Answer::First,
        Answer::InSet,
        Answer::Silent,
        Answer::Unexplained,
        Answer::Missed,
        Answer::Wrong,
    ]
    .map(|answer| count(answer).to_string());
    let mut ratios: Vec<f64> = outcomes.iter().filter_map(|o| o.error_ratio).collect();
    ratios.sort_unstable_by(f64::total_cmp);
    let at = |part: f64| ratios.get(((ratios.len() as f64 - 1.0) * part) as usize).copied();
    let ratio = match (at(0.5), at(0.95)) {
        (Some(median), Some(high)) => format!("{median:.3} (95 %: {high:.3})"),
        _ => "-".to_owned(),
    };
    let sizes: Vec<f64> = outcomes.iter().filter_map(|o| o.size_error).collect();
    let near = sizes.iter().filter(|error| **error <= 0.1).count();
    let size = if sizes.is_empty() { "-".to_owned() } else { format!("{near} of {}", sizes.len()) };
    let extra = outcomes.iter().filter(|outcome| outcome.extra > 0).count();
    let time = outcomes.iter().map(|o| o.wall_s).sum::<f64>() / outcomes.len().max(1) as f64;
    let (runs, answers) = (outcomes.len(), answers.join(" | "));
    format!("| {runs} | {answers} | {extra} | {ratio} | {size} | {time:.2} |")
}
