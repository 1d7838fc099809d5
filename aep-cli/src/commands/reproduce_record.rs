//! What `aep reproduce` keeps of a figure, so that a long run can be interrupted and gone on with.

use std::path::{Path, PathBuf};

use aep_problems::paper::Claim;
use aep_studio::report::plain::Figure;
use serde::{Deserialize, Serialize};

use super::reproduce_figure::{Conditions, Made};
use crate::failure::Failure;
use crate::output;

/// A figure's statements with the conditions that they were made under.
#[derive(Serialize, Deserialize)]
struct Record {
    version: String,
    seed: u64,
    trials: usize,
    readings: bool,
    claims: Vec<Claim>,
    files: Vec<PathBuf>,
    figures: Vec<Figure>,
}

fn path(name: &str, conditions: &Conditions) -> PathBuf {
    conditions.directory.join(format!("{name}-claims.json"))
}

/// The figure as it was made before under the same conditions, if all of its files are still there.
pub fn kept(name: &str, conditions: &Conditions) -> Option<Made> {
    let text = std::fs::read_to_string(path(name, conditions)).ok()?;
    let record: Record = serde_json::from_str(&text).ok()?;
    let same = record.version == env!("CARGO_PKG_VERSION")
        && record.seed == conditions.seed
        && record.trials == conditions.trials
        && record.readings == conditions.readings;
    let file = |name: &PathBuf| conditions.directory.join(name);
    let files: Vec<PathBuf> = record.files.iter().map(file).collect();
    let whole = same && files.iter().all(|file| file.exists());
    whole.then_some(Made { claims: record.claims, files, figures: record.figures })
}

/// Remembers a figure.
pub fn keep(name: &str, conditions: &Conditions, made: &Made) -> Result<(), Failure> {
    let inside = |file: &PathBuf| -> PathBuf {
        file.strip_prefix(&conditions.directory).map_or_else(|_| file.clone(), Path::to_owned)
    };
    let record = Record {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        seed: conditions.seed,
        trials: conditions.trials,
        readings: conditions.readings,
        claims: made.claims.clone(),
        files: made.files.iter().map(inside).collect(),
        figures: made.figures.clone(),
    };
    output::save_json(&path(name, conditions), &record)
}
