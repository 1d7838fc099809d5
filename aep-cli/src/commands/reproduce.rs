//! `aep reproduce`: the paper's figures, as curves and as a table of what is printed and what comes
//! out here.

use std::fmt::Write;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::Arc;
use std::time::Duration;

use aep_problems::paper::Claim;
use aep_studio::report::plain;

use super::reproduce_figure::{Conditions, Figure, Made, keep};
use super::{
    reproduce_control, reproduce_optimizers, reproduce_plant, reproduce_record, reproduce_table,
};
use crate::app::Global;
use crate::failure::Failure;
use crate::output::{self, Align, Table, dim, heading};
use crate::progress::Progress;
use crate::stop;

/// Reproduce figures of the AEP paper: CSV, SVG, and a table of what agrees
#[derive(clap::Args)]
#[command(after_help = "Examples:
  aep reproduce fig2 fig3 fig4 fig5 fig6 -o paper
  aep reproduce all -o paper --no-readings      only the default reading of the paper's rules")]
pub struct Args {
    /// Figures, or all
    #[arg(value_name = "FIGURE", default_value = "all")]
    figures: Vec<String>,
    /// Folder for the files
    #[arg(short, long, value_name = "DIR", default_value = "paper")]
    output: PathBuf,
    /// Trials of each line
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..))]
    trials: u32,
    /// Seed of every random choice; the same seed gives the same result
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Leave out the other readings of what the paper does not say
    #[arg(long)]
    no_readings: bool,
    /// Make figures again that the folder already has, made with the same seed, trials and version
    #[arg(long)]
    again: bool,
}

/// All figures; a new one is one entry in one of these lists.
const FIGURES: &[&[Figure]] =
    &[reproduce_optimizers::FIGURES, reproduce_plant::FIGURES, reproduce_control::FIGURES];

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let chosen = chosen(&args.figures)?;
    output::make_folder(&args.output)?;
    let conditions = Arc::new(Conditions {
        directory: args.output.clone(),
        trials: args.trials as usize,
        seed: args.seed,
        readings: !args.no_readings,
    });
    let progress = Progress::new(global.quiet);
    let mut rows = Vec::new();
    let mut files = Vec::new();
    let mut kept = Vec::new();
    let mut drawn = Vec::new();
    let count = chosen.len();
    let mut done = 0;
    for figure in chosen {
        progress.say(format!("{}: {}", figure.name, figure.title));
        let made = match reproduce_record::kept(figure.name, &conditions) {
            Some(made) if !args.again => {
                kept.push(figure.name);
                made
            }
            _ => {
                let Some(made) = make(figure, &conditions)? else { break };
                reproduce_record::keep(figure.name, &conditions, &made)?;
                made
            }
        };
        done += 1;
        let title = format!("{}: {}", figure.name, figure.title);
        rows.extend(made.claims.into_iter().map(|claim| (figure.name, claim)));
        files.extend(made.files);
        let id = figure.name.to_owned();
        drawn.push(plain::Part { id, title, figures: made.figures, ..plain::Part::default() });
    }
    drop(progress);
    if done == 0 {
        return Err(Failure::interrupted("no figure had been made"));
    }
    let tables = [
        ("claims.csv", reproduce_table::csv(&rows)),
        ("table.md", reproduce_table::markdown(&rows)),
        ("table.html", reproduce_table::html(&rows, drawn)),
    ];
    for (name, text) in tables {
        keep(&mut files, &args.output.join(name), &text)?;
    }
    if !global.quiet {
        output::print(&report(&rows, &kept, &files))?;
    }
    if done < count {
        let what = format!("{done} of {count} figures are made and in the table");
        let hint = "the same command goes on where this one ended";
        return Err(Failure::interrupted(&what).with_hint(hint));
    }
    Ok(())
}

/// Makes a figure; nothing after Ctrl-C, which does not wait for the minutes that a figure can take:
/// files are written whole or not at all, and without its record a figure is made again.
fn make(figure: &'static Figure, conditions: &Arc<Conditions>) -> Result<Option<Made>, Failure> {
    const LOOK: Duration = Duration::from_millis(50);
    let stop = stop::flag();
    let (tell, told) = mpsc::channel();
    let conditions = Arc::clone(conditions);
    std::thread::spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = tell.send((figure.make)(figure.name, &conditions));
    });
    while !stop.load(Ordering::Relaxed) {
        match told.recv_timeout(LOOK) {
            Ok(made) => return made.map(Some),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::failed(format!("{} ended in a panic", figure.name)));
            }
        }
    }
    Ok(None)
}

fn chosen(names: &[String]) -> Result<Vec<&'static Figure>, Failure> {
    let all = || FIGURES.iter().copied().flatten();
    let unknown = names.iter().find(|name| *name != "all" && !all().any(|f| f.name == **name));
    if let Some(name) = unknown {
        let known: Vec<&str> = all().map(|figure| figure.name).collect();
        let hint = format!("there are: {}, all", known.join(", "));
        return Err(Failure::bad_input(format!("no figure '{name}'")).with_hint(hint));
    }
    let wanted = |figure: &&Figure| names.iter().any(|name| name == "all" || name == figure.name);
    Ok(all().filter(wanted).collect())
}

fn report(rows: &[(&str, Claim)], kept: &[&str], files: &[PathBuf]) -> String {
    let mut table = Table::new(&[
        ("figure", Align::Left),
        ("about", Align::Left),
        ("the paper prints", Align::Left),
        ("here", Align::Left),
        ("verdict", Align::Left),
    ]);
    for (figure, claim) in rows {
        let verdict = claim.verdict.to_string();
        let cells = [figure, claim.about.as_str(), &claim.paper, &claim.ours, &verdict];
        table.row(cells.map(str::to_owned));
    }
    let agreeing = rows.iter().filter(|(_, claim)| claim.agrees()).count();
    let mut text = heading("The paper's statements and ours") + &table.text();
    let _ = writeln!(text, "\n {agreeing} of {} agree", rows.len());
    for (figure, claim) in rows {
        if let Some(reason) = &claim.reason {
            let _ = writeln!(text, " {figure}, {}: {reason}", claim.about);
        }
    }
    if !kept.is_empty() {
        let _ = writeln!(text, " {} {} ('--again' makes them anew)", dim("kept"), kept.join(", "));
    }
    for file in files {
        let _ = writeln!(text, " {} {}", dim("written"), file.display());
    }
    text
}
