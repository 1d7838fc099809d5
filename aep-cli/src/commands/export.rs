//! `aep export`: a model as a compensator in C, for other simulators, or as JSON with its schema.

mod fmu;
mod simulators;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use friction_ident::control::export::{ExportError, to_c};
use friction_ident::control::{self, Compensator, ControlError, samples};
use friction_ident::model::{SCHEMA, schema};
use friction_ident::{Library, Model};

use crate::app::Global;
use crate::args::{LoopArgs, ReferenceArgs};
use crate::failure::Failure;
use crate::output::{self, written};
use crate::{outputs, steps};

/// Export a model: to a simulator (FMU, MJCF, URDF, Modelica), its friction compensator as C, or as JSON with a schema
///
/// FMU: co-simulation after FMI 2.0, every effect simulated as here, with its C source and, where there is a C
/// compiler, a binary for this machine. Modelica: one model without a library, its friction by events. MJCF and URDF express
/// less; what is left out is listed on the terminal and in the file.
///
/// C: header, source, test vectors and a program that runs them. C99, no allocation, nothing but math.h;
/// sampling time and stick limit are built in. The vectors are recorded from a simulated loop along
/// --reference.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The model, as written by identify, extend or discover; by default the paper's table
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,
    /// What to write
    #[arg(long, value_enum)]
    to: Form,
    /// Folder for the C files; file for everything else, `-` for the terminal (not the FMU)
    #[arg(value_name = "PATH", required_unless_present = "output")]
    path: Option<PathBuf>,
    /// The same as PATH
    #[arg(short, long, value_name = "PATH", conflicts_with = "path")]
    output: Option<PathBuf>,
    /// Name of the C functions and files, of the FMU, of the joint, of the Modelica model [default: compensator, or the name of the file]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// FMU: longest step of the integration, s (a parameter of it); MJCF: time step
    #[arg(long, value_name = "S", default_value = "0.001")]
    max_step: f64,
    /// FMU: leave the binary for this machine out
    #[arg(long)]
    source_only: bool,
    #[command(flatten)]
    reference: ReferenceArgs,
    #[command(flatten)]
    servo: LoopArgs,
}

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    /// The compensator as C99
    C,
    /// The model as a functional mock-up unit, FMI 2.0 for co-simulation
    Fmu,
    /// The model as a scene, which `MuJoCo` reads, as far as that can say it
    Mjcf,
    /// The model as a robot description, as far as that can say it
    Urdf,
    /// The model in Modelica, without a library
    Modelica,
    /// The model as JSON that names its schema
    Json,
    /// The JSON schema of models
    Schema,
}

const EXAMPLES: &str = "\
Examples:
  aep export --model model.json --to c drive
  cd drive && cc -std=c99 -ffp-contract=off compensator.c compensator_test.c -lm -o t && ./t compensator_vectors.csv
  aep export --model model.json --to c --sample-time 0.001 --name x_axis -o drive
  aep export --model model.json --to fmu drive.fmu
  aep export --model model.json --to mjcf drive.xml
  aep export --model model.json --to modelica Drive.mo
  aep export --model model.json --to json -o exported.json
  aep export --to schema -o model.schema.json";

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        Self::from_lines(&error.to_string())
    }
}

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let Some(path) = args.path.as_ref().or(args.output.as_ref()) else {
        return Err(Failure::bad_input("say where to write: -o PATH"));
    };
    let read: Vec<PathBuf> = args.model.iter().cloned().collect();
    outputs::check(&read, &[("--output", Some(path))])?;
    let files = match args.to {
        Form::C => c(args, path)?,
        Form::Fmu => fmu::write(&plant(args)?, args, path)?,
        Form::Mjcf => simulators::mjcf(&plant(args)?, args, path)?,
        Form::Urdf => simulators::urdf(&plant(args)?, args, path)?,
        Form::Modelica => simulators::modelica(&plant(args)?, args, path)?,
        Form::Json => json(&model(args)?, path)?,
        Form::Schema => {
            output::save_json(path, &schema(&Library::builtin()))?;
            written("schema", path)
        }
    };
    if global.quiet || path.as_os_str() == "-" { Ok(()) } else { output::print(&files) }
}

/// The model, whatever its forces are measured in.
fn plant(args: &Args) -> Result<Model, Failure> {
    match &args.model {
        Some(path) => steps::read_plant(path),
        None => Ok(friction_ident::paper::table()?),
    }
}

/// The model, whose forces are forces.
fn model(args: &Args) -> Result<Model, Failure> {
    let model = plant(args)?;
    if let Some(path) = &args.model {
        steps::needs_force(&model, path)?;
    }
    Ok(model)
}

fn json(model: &Model, path: &Path) -> Result<String, Failure> {
    let mut value = serde_json::to_value(model)?;
    if let Some(object) = value.as_object_mut() {
        object.insert("$schema".to_owned(), SCHEMA.into());
    }
    output::save_json(path, &value)?;
    Ok(written("model", path))
}

fn c(args: &Args, folder: &Path) -> Result<String, Failure> {
    let model = model(args)?;
    let (servo, settings) = args.servo.build(&model, None)?;
    let compensator = Compensator::new(&model, settings).map_err(ControlError::Compensator)?;
    let reference = args.reference.build(model.axis(), settings.sample_time)?;
    let trial = control::run(&model, &reference, &servo, Some(&compensator))?;
    let samples = samples(&trial.run, &reference);
    let name = args.name.as_deref().unwrap_or("compensator");
    let files = to_c(&compensator, model.axis(), name, &samples)?;
    output::make_folder(folder)?;
    let mut said = String::new();
    for left in compensator.left_out() {
        // Writing to a string cannot fail.
        let _ = writeln!(said, "not compensated: {}: {}", left.effect, left.why);
    }
    for file in files {
        let path = folder.join(&file.name);
        output::save(&path, &file.text)?;
        said += &written("C", &path);
    }
    Ok(said)
}
