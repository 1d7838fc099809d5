//! `aep suggest`: which effect a model lacks.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use aep_studio::words;
use friction_ident::family::Decides;
use missing_physics::{likely, suggest};
use missing_physics::measurement::check::check;
use missing_physics::report::Combinations;

use crate::{outputs, steps};
use crate::app::Global;
use crate::args::{self, DataArgs, EffectNames, KnownArgs, OutputArgs, RunArgs};
use crate::experiment::{Proposal, propose};
use crate::failure::Failure;
use crate::output::{self, Columns, heading};
use crate::progress::Progress;
use crate::report::{Kind, Report};
use crate::stop::{self, Watch};

/// Most effects that one experiment is to tell apart.
const RIVALS: usize = 3;

/// Suggest the effect that a model lacks, without adding it
///
/// The model's effects are refitted; every other effect is tried beside them, by what it gains in predicting
/// each sample from those before it.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,
    #[command(flatten)]
    known: KnownArgs,
    /// The model, as written by identify, extend or discover
    #[arg(long, value_name = "MODEL.json", required_unless_present = "model_force")]
    model: Option<PathBuf>,
    /// Bandwidth in Hz below which forces are shown; by default 5 % of the sampling frequency, less
    /// where the position is noisy. Beside --model-force it decides, too
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
    let begun = Instant::now();
    let inputs: Vec<PathBuf> = args.data.paths().iter().chain(&args.model).cloned().collect();
    outputs::check(
        &inputs,
        &[
            ("--experiment", args.experiment.as_deref()),
            ("--json", args.results.json.as_deref()),
            ("--html", args.results.html.as_deref()),
        ],
    )?;
    stop::at_once();
    let loaded = args.data.read()?;
    let model = steps::model_or_given(args.model.as_deref(), &loaded.recording)?;
    let named = model.effects().iter().map(|name| (*name).to_owned()).collect();
    let effects = args.data.mapping().base(Some(&EffectNames(named)), &loaded)?;
    let settings = args.run.settings(effects)?;
    let watch = Watch::new(None);
    let quiet = global.quiet || args.results.own_stdout();
    let mut progress = Progress::new(quiet);
    progress.say("preparing the motion");
    let read = Instant::now();
    let known = args.known.known()?.or(model.known());
    let family = Arc::new(steps::searched(&loaded.recording, args.bandwidth, &known)?);
    family.belongs(&model)?;
    if args.experiment.is_some() {
        steps::needs_plant(&family)?;
    }
    progress.say("fitting the model");
    let settings = args.run.with_time_left(settings, begun, read);
    progress.within(settings.time_limit);
    let discovery = suggest(&*family, &settings, &mut progress)?;
    let candidates = discovery.ranking.first().cloned().unwrap_or_default();
    let better = settings.thresholds.better;
    let mut proposal = Proposal::default();
    if let Some(path) = args.experiment.as_ref().filter(|_| !watch.is_interrupted()) {
        progress.say("looking for an experiment that tells them apart");
        let rivals: Vec<String> =
            likely(&discovery, &settings).take(RIVALS).map(|candidate| candidate.effect.clone()).collect();
        proposal = propose(&family, (settings.base.clone(), rivals), path, args.run.seed)?;
    }
    drop(progress);
    let samples = args.results.samples(family.on_view(), &steps::ladder(&family, &discovery)?, Decides::Prediction);
    let data = check(&loaded.recording);
    let more = proposal.more;
    let report = Report {
        kind: Kind::Discovery,
        discovery: &discovery,
        loaded: &loaded,
        check: &data,
        thresholds: settings.thresholds,
        together: Combinations::default(),
        samples,
        more,
    };
    let files = report.save(&args.results)?;
    if quiet {
        return watch.end();
    }
    let next = match &discovery.most_likely {
        Some(best) => format!(
            "Try it: aep extend {}{}{}{} --add {} -o better.json\n",
            args.data.words(),
            args::flag("model", args.model.as_ref().map(|path| path.display())),
            args::flag("bandwidth", args.bandwidth),
            args.known.words(),
            best
        ),
        None if words::is_cut(&discovery) => {
            "No effect was found before the search was stopped.\n".to_owned()
        }
        None if candidates.iter().any(|candidate| candidate.nats.is_some()) => {
            format!("No effect of the library gains the {better} nats that are needed.\n")
        }
        None => "No effect of the library gains more than chance does.\n".to_owned(),
    };
    let compared = if args.run.explain && !discovery.decisions.is_empty() {
        heading("What was compared") + &output::compared(&discovery, &settings.thresholds)
    } else {
        output::comparisons(&discovery)
    };
    let text = heading("Where the model fails")
        + &output::regimes(&discovery.regimes, "of the error")
        + "\n"
        + &output::where_it_fails(&discovery.where_it_fails)
        + &heading("Which effect is missing")
        + &output::ranking(&candidates, Columns::All)
        + &compared
        + &output::notes(&discovery)
        + &proposal.text
        + "\n"
        + &files
        + &next;
    output::print(&text)?;
    watch.end()
}
