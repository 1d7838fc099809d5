//! The measurement and how to read it.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use aep_data::{
    Axes, Loaded, LoadedAxes, Mapping, Part, Source, hold_name, parse_hold, part, read, read_all,
    read_axes,
};
use friction_ident::Library;
use missing_physics::Hold;

use super::effects::{EffectNames, add_regressors, files_words, library};
use super::shell::{flag, quoted};
use crate::failure::Failure;

/// How to read a file whose columns have other names, units or gains.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading the data (what is not said is told by the columns' names)")]
pub struct MappingArgs {
    /// Column or variable of the time
    #[arg(long, value_name = "NAME")]
    time: Option<String>,
    /// Column of the force or torque, or a formula over columns: `duty*v_in_V`, `force_N - 9.81*m` (as for every column
    /// here; `aep effects --formula` lists the functions)
    #[arg(long, value_name = "NAME")]
    force: Option<String>,
    /// Column of the position or angle
    #[arg(long, value_name = "NAME")]
    position: Option<String>,
    /// Column of the velocity
    #[arg(long, value_name = "NAME")]
    velocity: Option<String>,
    /// Column of the position that was asked for
    #[arg(long, value_name = "NAME")]
    reference: Option<String>,
    /// Column that numbers the pieces of the recording
    #[arg(long, value_name = "NAME")]
    segment: Option<String>,
    /// Column of the temperature
    #[arg(long, value_name = "NAME")]
    temperature: Option<String>,
    /// Column that is 0 where the drive is switched off; such samples are left out
    #[arg(long, value_name = "NAME")]
    enabled: Option<String>,
    /// Column of the force or torque that your own model gives for the same samples, in the unit of the force: what
    /// that model lacks is looked for, nothing of ours is in it
    #[arg(long, value_name = "NAME")]
    model_force: Option<String>,
    /// Whether the model's force is taken as it is, or with a fitted factor
    #[arg(long, value_enum, value_name = "HOW")]
    model_gain: Option<ModelGain>,
    /// A force that is known up to a factor, as a formula over columns: `load=a2*cos(q1)`. It is tried like an effect
    /// called `load`, and can stand in the base. May be given several times
    #[arg(long, value_name = "NAME=FORMULA", value_parser = regressor)]
    regressor: Vec<(String, String)>,
    /// Unit of the time: s, ms, us, ...
    #[arg(long, value_name = "UNIT")]
    time_unit: Option<String>,
    /// Unit of the force: N, mN, kN, kgf, lbf, Nm, mNm, ...
    #[arg(long, value_name = "UNIT")]
    force_unit: Option<String>,
    /// Unit of the position: m, mm, um, in, rad, deg, rev, ...
    #[arg(long, value_name = "UNIT")]
    position_unit: Option<String>,
    /// Unit of the velocity: m/s, mm/s, rad/s, rpm, ...
    #[arg(long, value_name = "UNIT")]
    velocity_unit: Option<String>,
    /// Unit of the reference, as for the position
    #[arg(long, value_name = "UNIT")]
    reference_unit: Option<String>,
    /// Unit of the temperature: C, K
    #[arg(long, value_name = "UNIT")]
    temperature_unit: Option<String>,
    /// Factor on the force, e.g. N per V
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    force_gain: Option<f64>,
    /// Unit of the model's force, where its name does not say it
    #[arg(long, value_name = "UNIT")]
    model_force_unit: Option<String>,
    /// Factor on the position, e.g. m per count
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    position_gain: Option<f64>,
    /// Factor on the velocity
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    velocity_gain: Option<f64>,
    /// Factor on the reference
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    reference_gain: Option<f64>,
    /// First time that is used, s, as it stands in the file
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    from: Option<f64>,
    /// Last time that is used, s
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    to: Option<f64>,
    /// Use every N-th sample only, the force averaged until the next one
    #[arg(long, value_name = "N")]
    every: Option<NonZeroUsize>,
    /// Sampling interval in s, for files without a time
    #[arg(long, value_name = "S")]
    interval: Option<f64>,
    /// Topic of an MCAP file, where several have joints
    #[arg(long, value_name = "TOPIC")]
    topic: Option<String>,
    /// How the force acts between samples: `zero-order` (a held command) or `sampled`
    #[arg(long, value_name = "HOLD", value_parser = parse_hold)]
    hold: Option<Hold>,
}

impl MappingArgs {
    fn mapping(&self) -> Mapping {
        let library = library();
        let read = library.effects().iter().flat_map(|effect| effect.columns());
        let source = |column: &Option<String>, unit: &Option<String>, gain: Option<f64>| Source {
            column: column.clone(),
            unit: unit.clone(),
            gain,
        };
        Mapping {
            time: source(&self.time, &self.time_unit, None),
            force: source(&self.force, &self.force_unit, self.force_gain),
            position: source(&self.position, &self.position_unit, self.position_gain),
            velocity: source(&self.velocity, &self.velocity_unit, self.velocity_gain),
            reference: source(&self.reference, &self.reference_unit, self.reference_gain),
            segment: source(&self.segment, &None, None),
            temperature: source(&self.temperature, &self.temperature_unit, None),
            enabled: source(&self.enabled, &None, None),
            model_force: source(&self.model_force, &self.model_force_unit, None),
            axes: std::collections::BTreeMap::new(),
            regressors: self.regressor.iter().cloned().collect(),
            columns: read.cloned().collect(),
            interval_s: self.interval,
            topic: self.topic.clone(),
            hold: self.hold,
        }
    }

    /// The flags that were given, as they stand in a command.
    pub fn words(&self) -> String {
        let texts = [
            ("time", &self.time),
            ("force", &self.force),
            ("position", &self.position),
            ("velocity", &self.velocity),
            ("reference", &self.reference),
            ("segment", &self.segment),
            ("temperature", &self.temperature),
            ("enabled", &self.enabled),
            ("model-force", &self.model_force),
            ("time-unit", &self.time_unit),
            ("force-unit", &self.force_unit),
            ("position-unit", &self.position_unit),
            ("velocity-unit", &self.velocity_unit),
            ("reference-unit", &self.reference_unit),
            ("temperature-unit", &self.temperature_unit),
            ("model-force-unit", &self.model_force_unit),
            ("topic", &self.topic),
        ];
        let numbers = [
            ("force-gain", self.force_gain),
            ("position-gain", self.position_gain),
            ("velocity-gain", self.velocity_gain),
            ("reference-gain", self.reference_gain),
            ("interval", self.interval),
            ("from", self.from),
            ("to", self.to),
        ];
        let mut words: String =
            texts.iter().map(|(name, text)| flag(name, text.as_ref())).collect();
        words.extend(numbers.iter().map(|(name, number)| flag(name, *number)));
        words.extend(
            self.regressor
                .iter()
                .map(|(name, formula)| flag("regressor", Some(format!("{name}={formula}")))),
        );
        words += &flag("every", self.every);
        words += &flag("hold", self.hold.map(hold_name));
        words + &files_words()
    }

    /// The base model of a discovery: `named`, or what a base is where nothing was named; the gain of the user's own model
    /// joins it where that is to be fitted.
    pub fn base(
        &self,
        named: Option<&EffectNames>,
        loaded: &Loaded,
    ) -> Result<Vec<String>, Failure> {
        let names =
            named.cloned().unwrap_or_else(|| EffectNames(Library::usual(&loaded.recording)));
        let mut base = names.checked()?;
        if self.model_gain == Some(ModelGain::Fit) {
            if loaded.recording.channel("model_force").is_none() {
                return Err(Failure::bad_input(
                    "--model-gain is the gain of a model's force, but there is none",
                )
                .with_hint("say its column: --model-force COLUMN"));
            }
            if !base.iter().any(|name| name == "model-gain") {
                base.push("model-gain".to_owned());
            }
        }
        Ok(base)
    }

    /// The part that was asked for.
    fn cut(&self, mut loaded: Loaded) -> Result<Loaded, Failure> {
        let wanted =
            Part { from: self.from, to: self.to, every: self.every.map(NonZeroUsize::get) };
        if !wanted.is_all() {
            let time = loaded.recording.time();
            let (first, last) = (time[0], time[time.len() - 1]);
            loaded.recording = part(&loaded.recording, &wanted).map_err(|error| {
                Failure::bad_input(format!("--from, --to and --every leave too little: {error}"))
                    .with_hint(format!("the file goes from {first} s to {last} s"))
            })?;
        }
        add_regressors(&loaded.recording)?;
        Ok(loaded)
    }

    /// Reads `path`.
    pub fn read(&self, path: &Path) -> Result<Loaded, Failure> {
        self.cut(read(path, &self.mapping())?)
    }

    /// Reads the axes in `paths`, which are pieces of one measurement.
    pub fn read_axes(&self, paths: &[PathBuf], wanted: &Axes) -> Result<LoadedAxes, Failure> {
        let mut loaded = read_axes(paths, &self.mapping(), wanted)?;
        let cut = |(name, axis): (String, Loaded)| Ok((name, self.cut(axis)?));
        loaded.axes = loaded.axes.into_iter().map(cut).collect::<Result<_, Failure>>()?;
        Ok(loaded)
    }

    /// Reads `paths` as the pieces of one recording.
    pub fn read_all(&self, paths: &[PathBuf]) -> Result<Loaded, Failure> {
        self.cut(read_all(paths, &self.mapping())?)
    }
}

/// What is done with the gain of the model's force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum ModelGain {
    /// It is taken as it is
    One,
    /// A factor is fitted
    Fit,
}

/// `NAME=FORMULA`.
fn regressor(text: &str) -> Result<(String, String), String> {
    let (name, formula) = text
        .split_once('=')
        .filter(|(name, formula)| !name.trim().is_empty() && !formula.trim().is_empty())
        .ok_or_else(|| {
            format!("'{text}' is no regressor: write NAME=FORMULA, e.g. load=a2*cos(q1)")
        })?;
    Ok((name.trim().to_owned(), formula.trim().to_owned()))
}

/// A measurement that has to be given.
#[derive(clap::Args, Clone, Debug)]
pub struct DataArgs {
    /// The measurement: CSV with `time_s,force_N,position_m` (rotary: `torque_Nm,angle_rad`), or
    /// MATLAB (v5 to v7.3). Names, units and gains may also stand in DATA.toml beside it. Several files are
    /// pieces of one measurement.
    #[arg(value_name = "DATA", required = true)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    mapping: MappingArgs,
}

impl DataArgs {
    /// The files and how they are read, as they stand in a command.
    pub fn words(&self) -> String {
        words(&self.paths) + &self.mapping.words()
    }

    /// The files.
    pub fn paths(&self) -> &[PathBuf] {
        &self.paths
    }

    /// How the files are read.
    pub fn mapping(&self) -> &MappingArgs {
        &self.mapping
    }

    /// Reads it.
    pub fn read(&self) -> Result<Loaded, Failure> {
        self.mapping.read_all(&self.paths)
    }
}

/// Files as they stand in a command.
pub fn words(paths: &[PathBuf]) -> String {
    let quoted = paths.iter().map(|path| quoted(&path.display().to_string()));
    quoted.collect::<Vec<String>>().join(" ")
}
