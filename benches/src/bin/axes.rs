//! How often discovery is right on machines that share nothing with the library's simulator.
//!
//! `cargo run --release -p benches --bin axes -- --seeds 1..4 --levels clear,moderate`
//!
//! Seeds from 1001 are kept for judging: nothing is to be tuned to them.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

use benches::axes::case::{Case, Size, Wanted, all};
use benches::axes::judge::{Asked, Outcome, Told, judged};
use benches::axes::level::{Level, Recorded, recorded};
use benches::axes::{score, select, sweep, write};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};
use missing_physics::Thresholds;
use rayon::prelude::*;

#[derive(Parser)]
#[command(about = "How often discovery is right on machines unlike the library's own, as a table")]
struct Args {
    /// Kinds: table, joint, spindle, unlisted; all by default
    #[arg(long, value_delimiter = ',')]
    kinds: Vec<String>,
    /// Only cases whose `kind/name` fits one of these, `*` for anything, e.g. 'table/stri*,*/nothing'
    #[arg(long, value_name = "GLOB", default_value = "*", value_delimiter = ',')]
    only: Vec<String>,
    /// Seeds, both included; from 1001 they are kept for judging
    #[arg(long, value_name = "FROM..TO", default_value = "1..4", value_parser = select::seeds)]
    seeds: (u64, u64),
    /// Levels: clear, moderate, faint
    #[arg(long, default_value = "clear,moderate", value_delimiter = ',', value_parser = level)]
    levels: Vec<Level>,
    /// Recordings at a time
    #[arg(long, value_name = "N", default_value_t = 2)]
    jobs: usize,
    /// Tell the discovery how the force acts between samples
    #[arg(long)]
    known_hold: bool,
    /// Ask with half and with one and a half times each threshold, too, and print a row for each
    #[arg(long, conflicts_with_all = ["csv", "write"])]
    sweep: bool,
    /// Write one line per recording
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write the recordings as files instead of asking
    #[arg(long, value_name = "DIR")]
    write: Option<PathBuf>,
}

fn level(text: &str) -> Result<Level, String> {
    Level::parse(text).ok_or_else(|| format!("'{text}' is none of clear, moderate, faint"))
}

/// A recording to be made.
struct Job<'a> {
    case: &'a Case,
    level: Level,
    seed: u64,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let cases: Vec<Case> = all()
        .into_iter()
        .filter(|case| args.kinds.is_empty() || args.kinds.iter().any(|kind| kind == case.kind))
        .filter(|case| {
            let name = format!("{}/{}", case.kind, case.name);
            args.only.iter().any(|glob| select::fits(glob, &name))
        })
        .collect();
    let jobs = jobs(&cases, &args);
    if jobs.is_empty() {
        eprintln!("no case fits --kinds and --only");
        return ExitCode::FAILURE;
    }
    if let Err(error) = rayon::ThreadPoolBuilder::new().num_threads(args.jobs).build_global() {
        eprintln!("--jobs {}: {error}", args.jobs);
        return ExitCode::FAILURE;
    }
    if args.sweep {
        sweep(&jobs, &args);
        return ExitCode::SUCCESS;
    }
    match run(&jobs, &args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Case by case, level by level. What no level changes is made once.
fn jobs<'a>(cases: &'a [Case], args: &Args) -> Vec<Job<'a>> {
    let mut jobs = Vec::new();
    for case in cases {
        let levels = if case.size == Size::ByLevel { &args.levels[..] } else { &[Level::Fixed] };
        for level in levels {
            let seeds = args.seeds.0..=args.seeds.1;
            jobs.extend(seeds.map(|seed| Job { case, level: *level, seed }));
        }
    }
    jobs
}

fn bar(count: usize) -> ProgressBar {
    ProgressBar::new(count as u64).with_style(
        ProgressStyle::with_template("{wide_bar} {pos}/{len} {eta} {msg}").expect("valid"),
    )
}

fn asked(args: &Args) -> Asked {
    let told = if args.known_hold { Told::Truth } else { Told::Nothing };
    Asked { told, thresholds: Thresholds::default() }
}

/// The same recordings under every variation of the thresholds, a row for each.
fn sweep(jobs: &[Job<'_>], args: &Args) {
    let variations = sweep::variations(asked(args).thresholds);
    let bar = bar(jobs.len() * variations.len());
    let made: Vec<Option<Recorded>> =
        jobs.par_iter().map(|job| recorded(job.case, job.level, job.seed)).collect();
    println!("{}", sweep::HEAD);
    for (name, thresholds) in variations {
        bar.set_message(name.clone());
        let asked = Asked { thresholds, ..asked(args) };
        let each = jobs.par_iter().zip(&made).filter_map(|(job, made)| {
            let outcome = judged(job.case, made.as_ref()?, job.seed, asked);
            bar.inc(1);
            Some((job.case.wanted(), outcome))
        });
        let outcomes: Vec<(Wanted, Outcome)> = each.collect();
        bar.suspend(|| println!("{}", sweep::row(&name, &outcomes)));
    }
    bar.finish_and_clear();
}

fn run(jobs: &[Job<'_>], args: &Args) -> std::io::Result<()> {
    let bar = bar(jobs.len());
    let asked = asked(args);
    let outcomes: Vec<Option<Outcome>> = jobs
        .par_iter()
        .map(|&Job { case, level, seed }| {
            let name = format!("{}/{} {} seed {seed}", case.kind, case.name, level.name());
            bar.set_message(name.clone());
            let recorded = recorded(case, level, seed);
            let outcome = match (&recorded, &args.write) {
                (Some(recorded), Some(folder)) => {
                    write::save(folder, (case, level, seed), recorded)?;
                    None
                }
                (Some(recorded), None) => Some(judged(case, recorded, seed, asked)),
                (None, _) => {
                    bar.suspend(|| eprintln!("{name}: no size shows as much; left out"));
                    None
                }
            };
            bar.inc(1);
            if let Some(outcome) = outcome.as_ref().filter(|outcome| !outcome.right) {
                bar.suspend(|| eprintln!("{name}: {:?}, {}", outcome.answer, outcome.said));
            }
            Ok(outcome)
        })
        .collect::<std::io::Result<_>>()?;
    bar.finish_and_clear();
    if args.write.is_none() {
        table(jobs, &outcomes);
    }
    match &args.csv {
        Some(path) => fs::write(path, lines(jobs, &outcomes)),
        None => Ok(()),
    }
}

fn table(jobs: &[Job<'_>], outcomes: &[Option<Outcome>]) {
    let those = |wanted: &dyn Fn(&Job<'_>) -> bool| -> Vec<&Outcome> {
        let pairs = jobs.iter().zip(outcomes).filter(|(job, _)| wanted(job));
        pairs.filter_map(|(_, outcome)| outcome.as_ref()).collect()
    };
    println!("{}", score::HEAD);
    let mut rows: Vec<(&str, &str, Level)> = Vec::new();
    let mut sums: Vec<(&str, Level)> = Vec::new();
    for job in jobs {
        let row = (job.case.kind, job.case.name, job.level);
        if !rows.contains(&row) {
            rows.push(row);
        }
        if !sums.contains(&(row.0, row.2)) {
            sums.push((row.0, row.2));
        }
    }
    for (kind, name, level) in rows {
        let of = |job: &Job<'_>| (job.case.kind, job.case.name, job.level) == (kind, name, level);
        println!("{}", score::row(kind, name, level.name(), &those(&of)));
    }
    for (kind, level) in sums {
        let of = |job: &Job<'_>| (job.case.kind, job.level) == (kind, level);
        println!("{}", score::row(kind, "**all**", level.name(), &those(&of)));
    }
}

fn lines(jobs: &[Job<'_>], outcomes: &[Option<Outcome>]) -> String {
    let mut text =
        "kind,hidden,level,seed,visibility,answer,right,extra,size_error,wall_s,said\n".to_owned();
    for (Job { case, level, seed }, outcome) in jobs.iter().zip(outcomes) {
        let Some(outcome) = outcome else { continue };
        let Outcome { answer, said, extra, right, size_error, visibility, wall_s } = outcome;
        let size = size_error.map_or(String::new(), |error| format!("{error:.4}"));
        let _ = writeln!(
            text,
            "{},{},{},{seed},{visibility:.3},{answer:?},{right},{extra},{size},{wall_s:.2},\"{said}\"",
            case.kind,
            case.name,
            level.name()
        );
    }
    text
}
