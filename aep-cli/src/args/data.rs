//! The measurement and how to read it.

use std::path::{Path, PathBuf};

use aep_data::{Loaded, Mapping, Source, parse_hold, read, read_all};
use missing_physics::Hold;

use crate::failure::Failure;

/// How to read a file whose columns have other names, units or gains.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "Reading the data (what is not said is told by the columns' names)")]
pub struct MappingArgs {
    /// Column or variable of the time
    #[arg(long, value_name = "NAME")]
    time: Option<String>,
    /// Column of the force or torque, or a product: `vir*gtau`, `duty*v_in_V`
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
    /// Factor on the position, e.g. m per count
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    position_gain: Option<f64>,
    /// Factor on the velocity
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    velocity_gain: Option<f64>,
    /// Factor on the reference
    #[arg(long, value_name = "G", allow_negative_numbers = true)]
    reference_gain: Option<f64>,
    /// Sampling interval in s, for files without a time
    #[arg(long, value_name = "S")]
    interval: Option<f64>,
    /// How the force acts between samples: `zero-order` (a held command) or `sampled`
    #[arg(long, value_name = "HOLD", value_parser = parse_hold)]
    hold: Option<Hold>,
}

impl MappingArgs {
    fn mapping(&self) -> Mapping {
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
            interval_s: self.interval,
            hold: self.hold,
        }
    }

    /// Reads `path`.
    pub fn read(&self, path: &Path) -> Result<Loaded, Failure> {
        Ok(read(path, &self.mapping())?)
    }

    /// Reads `paths` as the pieces of one recording.
    pub fn read_all(&self, paths: &[PathBuf]) -> Result<Loaded, Failure> {
        Ok(read_all(paths, &self.mapping())?)
    }
}

/// A measurement that has to be given.
#[derive(clap::Args, Clone, Debug)]
pub struct DataArgs {
    /// The measurement: CSV with `time_s,force_N,position_m` (rotary: `torque_Nm,angle_rad`), or
    /// MATLAB v5/v7. Names, units and gains may also stand in DATA.toml beside it. Several files are
    /// pieces of one measurement.
    #[arg(value_name = "DATA", required = true)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    mapping: MappingArgs,
}

impl DataArgs {
    /// The files, as they stand in a command.
    pub fn words(&self) -> String {
        words(&self.paths)
    }

    /// Reads it.
    pub fn read(&self) -> Result<Loaded, Failure> {
        self.mapping.read_all(&self.paths)
    }
}

/// Files as they stand in a command.
pub fn words(paths: &[PathBuf]) -> String {
    let quoted = paths.iter().map(|path| {
        let text = path.display().to_string();
        if text.contains(char::is_whitespace) { format!("'{text}'") } else { text }
    });
    quoted.collect::<Vec<String>>().join(" ")
}
