//! The example that comes with the program: a recording with an effect hidden in it.

use std::path::Path;

use aep_data::{Loaded, Mapping, parse};

use crate::failure::Failure;

const NAME: &str = "examples/hidden/recording.csv";
const TRUTH: &str = "examples/hidden/truth.json";
const RECORDING: &[u8] = include_bytes!("../../examples/hidden/recording.csv");
const MAPPING: &str = include_str!("../../examples/hidden/recording.toml");

/// Reads it. The truth that lies beside it is not part of the program.
pub fn load() -> Result<Loaded, Failure> {
    let path = Path::new(NAME);
    let mapping = Mapping::parse(MAPPING, &path.with_extension("toml"))?;
    Ok(parse(path, RECORDING.to_vec(), &mapping)?)
}

/// What to do next.
pub fn next() -> String {
    format!(
        "\nWas it right? The truth stands in {TRUTH}, which was not read:\n\
         \x20 cat {TRUTH}\n\
         With plots:      aep discover --html report.html\n\
         Another riddle:  aep challenge --hide random --seed 7 -o riddle\n\
         Your own data:   aep discover run.csv       (columns time_s,force_N,position_m)\n"
    )
}
