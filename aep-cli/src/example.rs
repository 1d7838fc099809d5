//! The example that comes with the program: a recording with an effect hidden in it.

use std::path::Path;

use aep_data::{Loaded, Mapping, parse};

use crate::failure::Failure;

const NAME: &str = "example/recording.csv";
const RECORDING: &str = include_str!("../examples/hidden/recording.csv");
const MAPPING: &str = include_str!("../examples/hidden/recording.toml");
const TRUTH: &str = include_str!("../examples/hidden/truth.json");

/// Reads it. The truth that comes with it is not looked at.
pub fn load() -> Result<Loaded, Failure> {
    let path = Path::new(NAME);
    let mapping = Mapping::parse(MAPPING, &path.with_extension("toml"))?;
    Ok(parse(path, RECORDING.into(), &mapping)?)
}

/// Its files, by name, as they are.
pub fn files() -> [(&'static str, &'static str); 3] {
    [("recording.csv", RECORDING), ("recording.toml", MAPPING), ("truth.json", TRUTH)]
}

/// What to do next.
pub fn next() -> String {
    "\nWas it right? The truth was not looked at; it is written beside the data as truth.json by\n\
         \x20 aep challenge --example -o example\n\
         With plots:      aep discover --html report.html\n\
         Another riddle:  aep challenge --hide random --seed 7 -o riddle\n\
         Your own data:   aep discover run.csv       (columns time_s,force_N,position_m)\n"
        .to_owned()
}
