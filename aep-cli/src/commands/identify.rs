//! `aep identify`: the parameters of a given model.

use std::path::PathBuf;

use aep_core::Budget;
use clap::builder::PossibleValuesParser;
use friction_ident::family::{Decides, FrictionFamily};
use missing_physics::statistics::autocorrelation::interval;
use missing_physics::{Recording, Thresholds, diagnosis};
use missing_physics::measurement::check::check;

use crate::app::Global;
use crate::args::{
    Compared, DataArgs, EffectNames, KnownArgs, LimitArgs, OutputArgs, SeriesArgs, TimeArgs,
};
use crate::failure::Failure;
use crate::output::{self, heading, written};
use crate::progress::Progress;
use crate::report::{Kind, Report};
use crate::steps::{self, ALGORITHMS};
use crate::stop::{self, Watch};
use crate::{outputs, series};

/// Identify the parameters of a model made of given effects
///
/// Fits on two thirds of the data, in blocks, and tells the error on the rest.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,
    #[command(flatten)]
    known: KnownArgs,
    /// Effects of the model; the mass is part of every model, but beside --model-force only these are
    #[arg(long, value_name = "EFFECTS", required_unless_present = "model_force")]
    effects: Option<EffectNames>,
    /// Optimizer of the shape parameters
    #[arg(long, default_value = "aep", value_parser = PossibleValuesParser::new(ALGORITHMS.iter().map(|a| a.0)))]
    algorithm: String,
    /// What the model is compared with: the force along the measured motion, or its own motion
    #[arg(long, value_enum, default_value_t = Compared::Force)]
    horizon: Compared,
    #[command(flatten)]
    limit: LimitArgs,
    #[command(flatten)]
    time: TimeArgs,
    /// Seed of every random choice
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Bandwidth of the comparison in Hz; by default 5 % of the sampling frequency, less where the
    /// position is noisy
    #[arg(long, value_name = "HZ", value_parser = super::positive)]
    bandwidth: Option<f64>,
    /// Write the model
    #[arg(long, short = 'o', value_name = "MODEL.json")]
    output: Option<PathBuf>,
    #[command(flatten)]
    results: OutputArgs,
    #[command(flatten)]
    series: SeriesArgs,
}

/// The identification by simulation.
fn in_time(
    args: &Args,
    recording: &Recording,
    family: &FrictionFamily,
    effects: &[String],
    (progress, quiet): (Progress, bool),
    watch: Watch,
) -> Result<(), Failure> {
    let task = args.time.task(args.horizon)?;
    let method = steps::method(&args.algorithm, task.population)?;
    let found = family.identify_in_time(
        recording,
        effects,
        (task.horizon)(interval(recording.time())),
        (&*method, &Budget::generations(task.generations), args.seed),
        watch.until(),
    )?;
    drop(progress);
    let mut files = String::new();
    if let Some(path) = &args.results.json {
        let json = serde_json::to_value(&found)
            .map_err(|error| Failure::failed(format!("cannot write JSON: {error}")))?;
        output::save_json(path, &json)?;
        files += &written("results", path);
    }
    if let Some(path) = &args.output {
        output::save(path, &(found.model.to_json()? + "\n"))?;
        files += &written("model", path);
    }
    if let Some(path) = args.series.path() {
        let models = [("model".to_owned(), family.fitted(&found.model)?)];
        files += &series::save(path, family, &models, Decides::Force)?;
    }
    if quiet {
        return watch.end();
    }
    let title = format!("{} by simulation, {}", effects.join(" + "), args.horizon.name());
    output::print(&(heading(&title) + &output::simulated(&found) + &files))?;
    watch.end()
}

const EXAMPLES: &str = "\
Examples:
  aep identify run.csv --effects coulomb,viscous,offset -o model.json
  aep identify run.csv --effects coulomb,viscous,stribeck --algorithm meta-ep
  aep identify run.csv --effects coulomb,viscous --horizon windows --time-limit 30 -o model.json";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let watch = args.limit.watch();
    outputs::check(
        args.data.paths(),
        &[
            ("--output", args.output.as_deref()),
            ("--json", args.results.json.as_deref()),
            ("--html", args.results.html.as_deref()),
            ("--series", args.series.path()),
        ],
    )?;
    stop::at_once();
    let loaded = args.data.read()?;
    let effects = args.data.mapping().base(args.effects.as_ref(), &loaded)?;
    let quiet = global.quiet || args.results.own_stdout();
    let progress = Progress::new(quiet);
    progress.say("preparing the motion");
    let family = steps::family(&loaded.recording, args.bandwidth, &args.known.known()?)?;
    progress.say(format!("identifying {}", effects.join(" + ")));
    stop::keeping();
    let method = steps::method(&args.algorithm, 0)?;
    if args.horizon != Compared::Force {
        steps::needs_plant(&family)?;
        return in_time(args, &loaded.recording, &family, &effects, (progress, quiet), watch);
    }
    let found = missing_physics::identify(&family, &effects, (&*method, args.seed), watch.until())?;
    let (fit, evaluations) = (found.fit, found.evaluations);
    let rung = diagnosis::rung(&family, &fit, &[]);
    let model = family.plant(&rung)?;
    let discovery = diagnosis::comparison(&family, (&fit, &fit), vec![rung.clone()], args.seed, &|| watch.is_over());
    let friction = family.friction(&fit.model, Decides::FittedForce);
    drop(progress);
    let data = check(&loaded.recording);
    let models = std::slice::from_ref(&fit.model);
    let samples = args.results.samples(&family, models, Decides::FittedForce);
    let report =
        Report { kind: Kind::Comparison, discovery: &discovery, loaded: &loaded, check: &data, thresholds: Thresholds::default(), together: friction.clone(), samples, more: Vec::new() };
    let mut files = report.save(&args.results)?;
    if let Some(path) = &args.output {
        output::save(path, &(model.to_json()? + "\n"))?;
        files += &written("model", path);
    }
    if let Some(path) = args.series.path() {
        let models = [("model".to_owned(), fit.model.clone())];
        files += &series::save(path, &family, &models, Decides::FittedForce)?;
    }
    if quiet {
        return watch.end();
    }
    let title = format!("{} by {} ({evaluations} evaluations)", effects.join(" + "), args.algorithm);
    let text = heading(&title)
        + &output::parameters(&rung)
        + &output::together(&friction)
        + &heading("Errors")
        + &output::ladder(&discovery, "the model")
        + &output::notes(&discovery)
        + &files;
    output::print(&text)?;
    watch.end()
}
