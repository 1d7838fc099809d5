//! `aep simulate`: a model under a recorded force.

use std::ops::Range;
use std::path::PathBuf;

use aep_data::Loaded;
use friction_ident::{Axis, Effort, Input, Model, SimulationError, Start, Trajectory, simulate};
use missing_physics::{Channel, Recording};
use missing_physics::measurement::quantity::quantity;

use crate::steps;
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
    let model = steps::read_plant(&args.model)?;
    let loaded = args.mapping.read(&args.input)?;
    check_axis(&model, &loaded)?;
    let motion = motion(&model, &loaded.recording)?;
    let simulated = recording(&loaded.recording, motion)?;
    output::save(&args.output, &aep_data::to_csv(&simulated))?;
    if global.quiet {
        return Ok(());
    }
    let (rms, unit) = deviation(&loaded.recording, &simulated)?;
    let text = format!(
        "Free run over {} samples: {} rms away from the measured position\n",
        simulated.len(),
        quantity(rms, &unit),
    );
    output::print(&(text + &written("motion", &args.output)))
}

fn check_axis(model: &Model, loaded: &Loaded) -> Result<(), Failure> {
    let position = loaded.recording.channel("position");
    let rotary = position.is_some_and(|channel| channel.unit == "rad");
    if rotary == (model.axis() == Axis::Rotary) {
        let force = loaded.recording.channel("force");
        return steps::same_effort(model, Effort::of(force.map_or("", |channel| &channel.unit)));
    }
    Err(steps::other_axis())
}

/// The motion of every segment, one after the other.
fn motion(model: &Model, recording: &Recording) -> Result<Trajectory, Failure> {
    let mut all =
        Trajectory { position: Vec::new(), velocity: Vec::new(), drive_force: Vec::new() };
    for range in recording.segments() {
        let part = segment(model, recording, range)?;
        all.position.extend(part.position);
        all.velocity.extend(part.velocity);
        all.drive_force.extend(part.drive_force);
    }
    Ok(all)
}

fn segment(
    model: &Model,
    recording: &Recording,
    range: &Range<usize>,
) -> Result<Trajectory, Failure> {
    let time = &recording.time()[range.clone()];
    let force = &required(recording, "force")?[range.clone()];
    let position = &required(recording, "position")?[range.clone()];
    // The mean velocity of the first samples, so that counts of the encoder do not matter much.
    let last = (time.len() - 1).min(5);
    let elapsed = time[last] - time[0];
    let velocity = if elapsed > 0.0 { (position[last] - position[0]) / elapsed } else { 0.0 };
    let start =
        Start { position: position[0], velocity, command: force[0], ..Start::default() };
    Ok(simulate(model, &Input::new(time, force, recording.hold()), &start)?)
}

/// The simulated motion beside the measured position.
fn recording(measured: &Recording, motion: Trajectory) -> Result<Recording, Failure> {
    let unit = measured.channel("position").map(|channel| channel.unit.clone()).unwrap_or_default();
    let force = measured.channel("force").cloned();
    let mut channels: Vec<Channel> = force.into_iter().collect();
    channels.push(Channel::new("position", unit.clone(), motion.position));
    channels.push(Channel::new("velocity", format!("{unit}/s"), motion.velocity));
    let position = required(measured, "position")?.to_vec();
    channels.push(Channel::new("measured_position", unit, position));
    let mut segment = vec![0; measured.len()];
    for (number, range) in measured.segments().iter().enumerate() {
        segment[range.clone()].fill(number as i64);
    }
    let recording =
        Recording::with_segments("simulated", measured.time().to_vec(), channels, segment);
    Ok(recording.map_err(|error| Failure::failed(error.to_string()))?.with_hold(measured.hold()))
}

fn required<'a>(recording: &'a Recording, channel: &str) -> Result<&'a [f64], Failure> {
    recording.require(channel).map_err(|error| Failure::bad_input(error.to_string()))
}

fn deviation(measured: &Recording, simulated: &Recording) -> Result<(f64, String), Failure> {
    let (a, b) = (required(measured, "position")?, required(simulated, "position")?);
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    let unit = measured.channel("position").map(|channel| channel.unit.clone());
    Ok(((squares / a.len() as f64).sqrt(), unit.unwrap_or_default()))
}
