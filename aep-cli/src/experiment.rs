//! The motion that would tell rival effects apart, as a file that an axis can be asked to follow.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use friction_ident::family::FrictionFamily;
use friction_ident::family::experiment::{Experiment, Separation};
use missing_physics::measurement::quantity::quantity;
use serde_json::Value;

use crate::failure::Failure;
use crate::output::{heading, save, written};
use crate::stop;

/// What is told of an experiment.
#[derive(Default)]
pub struct Proposal {
    /// For the terminal.
    pub text: String,
    /// For the JSON: an entry `experiment`.
    pub more: Vec<(&'static str, Value)>,
}

/// Finds the motion that separates `effects`, each on top of the effects `below`, and writes it to `path`.
/// Where there is nothing to separate, nothing is written, and the proposal says so; nor is there one where Ctrl-C comes.
pub fn propose(
    family: &Arc<FrictionFamily>,
    (below, effects): (Vec<String>, Vec<String>),
    path: &Path,
    seed: u64,
) -> Result<Proposal, Failure> {
    if effects.len() < 2 {
        let text =
            "\nNo experiment is written: there are no rival effects to tell apart.\n".to_owned();
        return Ok(Proposal { text, more: vec![("experiment", Value::Null)] });
    }
    let family = Arc::clone(family);
    let found = stop::unless_interrupted(move || find(&family, &below, &effects, seed));
    let Some(found) = found.transpose()? else { return Ok(Proposal::default()) };
    write(&found, path)?;
    let mut json = serde_json::to_value(&found)
        .map_err(|error| Failure::failed(format!("cannot write JSON: {error}")))?;
    json["file"] = path.to_string_lossy().into();
    let text = text(&found) + &written("the motion, to be followed by the axis,", path);
    Ok(Proposal { text, more: vec![("experiment", json)] })
}

/// The motion that separates `effects`, each on top of the effects `below`.
pub fn find(
    family: &FrictionFamily,
    below: &[String],
    effects: &[String],
    seed: u64,
) -> Result<Experiment, Failure> {
    let found = family.experiment_between(below, effects, seed);
    found.map_err(|error| Failure::failed(error.to_string()))
}

/// Writes a motion as time and position.
pub fn write(found: &Experiment, path: &Path) -> Result<(), Failure> {
    let motion = found.recording().map_err(|error| Failure::failed(error.to_string()))?;
    save(path, &aep_data::to_csv_rounded(&motion, 9))
}

fn text(found: &Experiment) -> String {
    heading(&format!("An experiment to tell {} apart", found.effects.join(" from "))) + &said(found)
}

/// What is told of a motion.
pub fn said(found: &Experiment) -> String {
    let mut text = String::new();
    let told = |separation: &Separation| {
        format!(
            "by {} where they differ most ({:.1} times the noise), {:.1} standard deviations in all",
            quantity(separation.force, found.unit),
            found.noises(separation),
            separation.deviations
        )
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        " {}: {}; {:.0} s, within the stroke, speed and acceleration recorded.",
        found.motion,
        found.about,
        found.duration()
    );
    let _ = writeln!(text, " There the two most alike differ {}.", told(&found.separation));
    let _ = writeln!(text, " In this recording they differ {}.", told(&found.here));
    if !found.is_worth_running() {
        let _ = writeln!(
            text,
            " No motion within the stroke, speed and acceleration recorded tells them apart much better: \
             go beyond them."
        );
    }
    let others = found.tried.iter().filter(|tried| tried.motion != found.motion);
    let others: Vec<String> =
        others.map(|tried| format!("{} {:.1}", tried.motion, tried.deviations)).collect();
    let _ = writeln!(text, " Other motions, standard deviations: {}.", others.join(", "));
    text
}
