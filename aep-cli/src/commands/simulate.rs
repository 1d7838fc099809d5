//! `aep simulate`: a model under a recorded force.

use std::path::PathBuf;

use aep_data::Loaded;
use friction_ident::simulator::{deviation, free_run};
use friction_ident::{Axis, Effort, Model, SimulationError};
use missing_physics::measurement::quantity::quantity;

use crate::{outputs, steps};
use crate::app::Global;
use crate::args::MappingArgs;
use crate::failure::Failure;
use crate::output::{self, written};

/// Simulate a model under a recorded force
///
/// Each segment starts at the measured position. A free run drifts away from the measurement like an
/// integral of the force error, also for a good model: `aep compare` judges a model better.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The model, as written by identify, extend or discover
    #[arg(long, value_name = "MODEL.json")]
    model: PathBuf,
    /// The recording with the force: CSV or MATLAB (v5 to v7.3)
    #[arg(long, value_name = "DATA")]
    input: PathBuf,
    /// Where the motion is written, as CSV
    #[arg(long, short = 'o', value_name = "OUT.csv")]
    output: PathBuf,
    #[command(flatten)]
    mapping: MappingArgs,
}

const EXAMPLES: &str = "\
Examples:
  aep simulate --model model.json --input run.csv -o motion.csv
  aep simulate --model model.json --input run.csv --force u_V --force-gain 35.15 -o motion.csv";

impl From<SimulationError> for Failure {
    fn from(error: SimulationError) -> Self {
        Self { code: crate::failure::FAILED, ..Self::from_lines(&error.to_string()) }
    }
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let read = [args.model.clone(), args.input.clone()];
    outputs::check(&read, &[("--output", Some(&args.output))])?;
    let model = steps::read_plant(&args.model)?;
    let loaded = args.mapping.read(&args.input)?;
    check_axis(&model, &loaded)?;
    let simulated = free_run(&model, &loaded.recording)?;
    output::save(&args.output, &aep_data::to_csv(&simulated))?;
    if global.quiet {
        return Ok(());
    }
    let rms = deviation(&simulated).map_err(|error| Failure::failed(error.to_string()))?;
    let unit = simulated.channel("position").map_or("", |channel| &channel.unit);
    let text = format!(
        "Free run over {} samples: {} rms away from the measured position\n",
        simulated.len(),
        quantity(rms, unit),
    );
    output::print(&(text + &written("motion", &args.output)))
}

fn check_axis(model: &Model, loaded: &Loaded) -> Result<(), Failure> {
    let unit = |name: &str| {
        loaded.recording.channel(name).map_or("", |channel| channel.unit.as_str())
    };
    let axis = if unit("position") == "rad" { Axis::Rotary } else { Axis::Linear };
    Ok(model.is_of(axis, Effort::of(unit("force")))?)
}
