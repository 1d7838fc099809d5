//! `aep compare`: a given model on a measurement.

use std::path::PathBuf;

use missing_physics::data_check::check;

use crate::app::Global;
use crate::args::{DataArgs, OutputArgs};
use crate::failure::Failure;
use crate::output::{self, heading};
use crate::report::{Kind, Report};
use crate::steps;

/// Compare a model with a measurement: errors and where it fails
///
/// Nothing is fitted: the model is taken as it stands in the file.
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
    /// Seed of the placebos behind the p-values
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    results: OutputArgs,
}

const EXAMPLES: &str = "\
Examples:
  aep compare run.csv --model model.json
  aep compare run.csv --model model.json --html comparison.html --json comparison.json";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let model = steps::read_model(&args.model)?;
    let loaded = args.data.read()?;
    let family = steps::family(&loaded.recording, args.bandwidth)?;
    let fit = steps::as_given(&family, &model)?;
    let rung = steps::rung(&family, &fit, None);
    let effects = rung.effects.join(" + ");
    let discovery = steps::comparison(&family, &fit, &fit, vec![rung], args.seed);
    let data = check(&loaded.recording);
    let report =
        Report { kind: Kind::Comparison, discovery: &discovery, loaded: &loaded, check: &data };
    let files = report.save(&args.results)?;
    if global.quiet || args.results.own_stdout() {
        return Ok(());
    }
    let text = heading(&format!("Errors of {effects}"))
        + &output::ladder(&discovery, "the model")
        + &heading("Where it fails")
        + &output::regimes(&discovery.regimes)
        + "\n"
        + &output::where_it_fails(&discovery.where_it_fails)
        + &files;
    output::print(&text)
}
