//! `aep suggest`: which effect a model lacks.

use std::path::PathBuf;

use missing_physics::data_check::check;
use missing_physics::suggest;

use crate::app::Global;
use crate::args::{DataArgs, OutputArgs, RunArgs};
use crate::experiment::{Proposal, propose};
use crate::failure::Failure;
use crate::output::{self, Columns, heading};
use crate::progress::Progress;
use crate::report::{Kind, Report};
use crate::steps;

/// Most effects that one experiment is to tell apart.
const RIVALS: usize = 3;

/// Suggest the effect that a model lacks, without adding it
///
/// The model's effects are refitted to the blocks that are not held out; every other effect is tried
/// on what they leave.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,
    /// The model, as written by identify, extend or discover
    #[arg(long, value_name = "MODEL.json")]
    model: PathBuf,
    /// Bandwidth of the comparison in Hz; by default 5 % of the sampling frequency
    #[arg(long, value_name = "HZ", value_parser = super::positive)]
    bandwidth: Option<f64>,
    /// Where several effects are likely: write a motion that tells them apart (time and position)
    #[arg(long, value_name = "FILE.csv")]
    experiment: Option<PathBuf>,
    #[command(flatten)]
    results: OutputArgs,
    #[command(flatten)]
    run: RunArgs,
}

const EXAMPLES: &str = "\
Examples:
  aep suggest run.csv --model model.json
  aep suggest run.csv --model model.json --json - --seed 7";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let model = steps::read_model(&args.model)?;
    let effects: Vec<String> = model.effects().iter().map(|name| (*name).to_owned()).collect();
    let settings = args.run.settings(effects)?;
    let loaded = args.data.read()?;
    let quiet = global.quiet || args.results.own_stdout();
    let mut progress = Progress::new(quiet);
    progress.say("preparing the motion");
    let family = steps::family(&loaded.recording, args.bandwidth)?;
    steps::same_axis(&family, &model)?;
    progress.say("fitting the model");
    let discovery = suggest(&family, &settings, &mut progress)?;
    let candidates = discovery.ranking.first().map_or(&[][..], Vec::as_slice);
    let likely = candidates.iter().filter(|c| c.p_value <= settings.alpha && c.gain > 0.0);
    let mut proposal = Proposal::default();
    if let Some(path) = &args.experiment {
        progress.say("looking for an experiment that tells them apart");
        let rivals: Vec<String> =
            likely.clone().take(RIVALS).map(|candidate| candidate.effect.clone()).collect();
        proposal = propose(&family, &settings.base, &rivals, path, args.run.seed)?;
    }
    let mut likely = likely;
    let likely = likely.next();
    drop(progress);
    let data = check(&loaded.recording);
    let more = proposal.more;
    let report =
        Report { kind: Kind::Discovery, discovery: &discovery, loaded: &loaded, check: &data, more };
    let files = report.save(&args.results)?;
    if quiet {
        return Ok(());
    }
    let next = match likely {
        Some(best) => format!(
            "Try it: aep extend {} --model {} --add {} -o better.json\n",
            args.data.words(),
            args.model.display(),
            best.effect
        ),
        None => "No effect of the library gains more than chance does.\n".to_owned(),
    };
    let text = heading("Where the model fails")
        + &output::regimes(&discovery.regimes)
        + "\n"
        + &output::where_it_fails(&discovery.where_it_fails)
        + &heading("Which effect is missing")
        + &output::ranking(candidates, Columns::All)
        + &proposal.text
        + "\n"
        + &files
        + &next;
    output::print(&text)
}
