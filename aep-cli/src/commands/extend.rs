//! `aep extend`: one effect more, refitted.

use std::path::PathBuf;

use friction_ident::family::Decides;
use missing_physics::Thresholds;
use missing_physics::measurement::check::check;
use missing_physics::report::Combinations;

use crate::steps;
use crate::app::Global;
use crate::args::{DataArgs, KnownArgs, LimitArgs, OutputArgs, SeriesArgs, known};
use crate::failure::Failure;
use crate::output::{self, heading, written};
use crate::progress::Progress;
use crate::report::{Kind, Report};
use crate::{outputs, series, stop};

/// Add an effect to a model, refit it, and print before and after
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
    /// The effect to add
    #[arg(long, value_name = "EFFECT")]
    add: String,
    /// Write the extended model
    #[arg(long, short = 'o', value_name = "MODEL2.json")]
    output: PathBuf,
    /// Bandwidth of the comparison in Hz; by default 5 % of the sampling frequency, less where the
    /// position is noisy
    #[arg(long, value_name = "HZ", value_parser = super::positive)]
    bandwidth: Option<f64>,
    /// Seed of every random choice
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    limit: LimitArgs,
    #[command(flatten)]
    results: OutputArgs,
    #[command(flatten)]
    series: SeriesArgs,
}

const EXAMPLES: &str = "\
Examples:
  aep extend run.csv --model model.json --add stribeck -o better.json";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let watch = args.limit.watch();
    // A model may be extended in place, data are never written over.
    outputs::check(
        args.data.paths(),
        &[
            ("--output", Some(&args.output)),
            ("--json", args.results.json.as_deref()),
            ("--html", args.results.html.as_deref()),
            ("--series", args.series.path()),
        ],
    )?;
    stop::at_once();
    let loaded = args.data.read()?;
    let model = steps::model_or_given(args.model.as_deref(), &loaded.recording)?;
    let added = known(&args.add.to_lowercase())?;
    if model.effects().contains(&added.as_str()) {
        let failure = Failure::bad_input(format!("the model has '{added}' already"));
        let failure = match &args.model {
            Some(path) => failure.in_file(path),
            None => failure,
        };
        return Err(failure.with_hint("'aep suggest' tells which other effect would help"));
    }
    let quiet = global.quiet || args.results.own_stdout();
    let progress = Progress::new(quiet);
    progress.say("preparing the motion");
    let family = steps::family(&loaded.recording, args.bandwidth, &args.known.known()?.or(model.known()))?;
    let before = family.as_given(&model)?;
    stop::keeping();
    progress.say(format!("refitting with {added}"));
    let extended = missing_physics::extend(&family, &before, &added, args.seed, watch.until())?;
    let (after, discovery) = (extended.fit, extended.comparison);
    let last = discovery.ladder[1].clone();
    let extended = family.plant(&last)?;
    drop(progress);
    let data = check(&loaded.recording);
    let models = [before.model.clone(), after.model.clone()];
    let samples = args.results.samples(&family, &models, Decides::FittedForce);
    let report =
        Report { kind: Kind::Comparison, discovery: &discovery, loaded: &loaded, check: &data, thresholds: Thresholds::default(), together: Combinations::default(), samples, more: Vec::new() };
    let mut files = report.save(&args.results)?;
    output::save(&args.output, &(extended.to_json()? + "\n"))?;
    files += &written("model", &args.output);
    if let Some(path) = args.series.path() {
        let named = |(name, fit): (&str, &missing_physics::fit::Fit)| {
            (name.to_owned(), fit.model.clone())
        };
        let models = [("before", &before), ("after", &after)].map(named);
        files += &series::save(path, &family, &models, Decides::FittedForce)?;
    }
    if quiet {
        return watch.end();
    }
    let text = heading(&format!("Before and after {added}"))
        + &output::ladder(&discovery, "before")
        + &heading("Parameters")
        + &output::parameters(&last)
        + &heading("Where it fails now")
        + &output::regimes(&discovery.regimes, "of the error")
        + "\n"
        + &output::notes(&discovery)
        + &files;
    output::print(&text)?;
    watch.end()
}
