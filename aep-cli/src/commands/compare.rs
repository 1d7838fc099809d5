//! `aep compare`: given models on a measurement.

use std::path::{Path, PathBuf};

use friction_ident::{Known, Model};
use friction_ident::family::{Decides, GivenModels};
use missing_physics::{Fitted, Thresholds};
use missing_physics::fit::Fit;
use missing_physics::measurement::check::check;
use missing_physics::report::Combinations;
use missing_physics::report::View;

use crate::app::Global;
use crate::args::{DataArgs, LimitArgs, OutputArgs, SeriesArgs};
use crate::failure::Failure;
use crate::output::{self, heading};
use crate::report::{Kind, Report};
use crate::steps;
use crate::stop;
use crate::{outputs, series};

/// Compare a model with a measurement: errors in several views and where it fails
///
/// Nothing is fitted: the model is taken as it stands in the file. Several models stand side by side in
/// the table of views; everything else is told of the first one.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    #[command(flatten)]
    data: DataArgs,
    /// The model, as written by identify, extend or discover; may be given several times
    #[arg(long, value_name = "MODEL.json", required_unless_present = "model_force")]
    model: Vec<PathBuf>,
    /// Bandwidth of the comparison in Hz; by default 5 % of the sampling frequency, less where the
    /// position is noisy
    #[arg(long, value_name = "HZ", value_parser = super::positive)]
    bandwidth: Option<f64>,
    /// Seed of the placebos behind the p-values
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
  aep compare run.csv --model model.json
  aep compare run.csv --model model.json --model better.json
  aep compare run.csv --model model.json --html comparison.html --json comparison.json";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let watch = args.limit.watch();
    outputs::check(
        &[args.data.paths(), &args.model].concat(),
        &[
            ("--json", args.results.json.as_deref()),
            ("--html", args.results.html.as_deref()),
            ("--series", args.series.path()),
        ],
    )?;
    stop::at_once();
    let loaded = args.data.read()?;
    let models: Vec<Model> = if args.model.is_empty() {
        vec![steps::model_or_given(None, &loaded.recording)?]
    } else {
        args.model.iter().map(|path| steps::read_model(path)).collect::<Result<_, _>>()?
    };
    let family = steps::family(&loaded.recording, args.bandwidth, &Known::default())?;
    let paths = if args.model.is_empty() {
        vec![PathBuf::from("model_force")]
    } else {
        args.model.clone()
    };
    let fit = |(path, model): (&PathBuf, &Model)| Ok((name(path), family.as_given(model)?));
    let fits: Vec<(String, Fit)> =
        paths.iter().zip(&models).map(fit).collect::<Result<_, Failure>>()?;
    stop::keeping();
    let Some(compared) = family.compared(&fits, args.seed, watch.until())? else {
        return Err(Failure::bad_input("a model is needed: --model MODEL.json"));
    };
    let GivenModels { mut discovery, models: views, between, missing } = compared;
    let (stopped, fit) = (discovery.stopped, &fits[0].1);
    let effects = discovery.ladder[0].effects.join(" + ");
    let warnings = output::warnings(&between, &views, &missing);
    let between = between.iter().map(aep_studio::words::disagreement);
    discovery.notes = between.chain(missing.iter().map(ToString::to_string)).collect();
    let data = check(&loaded.recording);
    let report = Report {
        kind: Kind::Comparison,
        discovery: &discovery,
        loaded: &loaded,
        check: &data,
        thresholds: Thresholds::default(),
        together: Combinations::default(),
        samples: args.results.samples(&family, std::slice::from_ref(&fit.model), Decides::Force),
        more: vec![("models", in_json(&paths, &views)?)],
    };
    let mut files = report.save(&args.results)?;
    if let Some(path) = args.series.path() {
        let named = |(k, (name, fit)): (usize, &(String, Fit))| {
            let again = fits[..k].iter().any(|(other, _)| other == name);
            let name = if again { format!("{name}_{}", k + 1) } else { name.clone() };
            (name, fit.model.clone())
        };
        let models: Vec<(String, Fitted)> = fits.iter().enumerate().map(named).collect();
        files += &series::save(path, &family, &models, Decides::Force)?;
    }
    if global.quiet || args.results.own_stdout() {
        return watch.end();
    }
    let remains = discovery.diagnosis.as_ref().map_or_else(String::new, |diagnosis| {
        output::tests(diagnosis) + "\n" + &output::lines(&discovery, diagnosis)
    });
    let text = heading(&format!("Errors of {effects}"))
        + &output::ladder(&discovery, "the model")
        + &heading("In several views")
        + &output::views(&views)
        + &warnings
        + &heading("Where it fails")
        + &output::regimes(&discovery.regimes, "of the error")
        + "\n"
        + &output::where_it_fails(&discovery.where_it_fails)
        + &heading("Is what remains noise?")
        + &remains
        + &(if stopped { output::note(aep_studio::words::STOPPED) } else { String::new() })
        + &files;
    output::print(&text)?;
    watch.end()
}

fn name(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

fn in_json(paths: &[PathBuf], views: &[(String, Vec<View>)]) -> serde_json::Result<serde_json::Value> {
    let model = |(path, (_, of)): (&PathBuf, &(String, Vec<View>))| {
        let views = aep_studio::json::views(of)?;
        Ok(serde_json::json!({ "model": path.to_string_lossy(), "views": views }))
    };
    paths.iter().zip(views).map(model).collect()
}
