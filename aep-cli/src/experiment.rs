//! The motion that would tell rival effects apart, as a file that an axis can be asked to follow.

use std::fmt::Write;
use std::path::Path;

use friction_ident::Quantity;
use friction_ident::family::FrictionFamily;
use friction_ident::family::experiment::{Experiment, Separation};
use missing_physics::measurement::quantity::quantity;
use missing_physics::{Channel, Recording};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{heading, save, written};

/// A motion that brings less than this factor per root of time over the recording at hand is hardly worth
/// running.
const MUCH: f64 = 1.5;

/// What is told of an experiment.
#[derive(Default)]
pub struct Proposal {
    /// For the terminal.
    pub text: String,
    /// For the JSON: an entry `experiment`.
    pub more: Vec<(&'static str, Value)>,
}

/// Finds the motion that separates `effects`, each on top of the effects `below`, and writes it to `path`.
/// Where there is nothing to separate, nothing is written, and the proposal says so.
pub fn propose(
    family: &FrictionFamily,
    below: &[String],
    effects: &[String],
    path: &Path,
    seed: u64,
) -> Result<Proposal, Failure> {
    if effects.len() < 2 {
        let text =
            "\nNo experiment is written: there are no rival effects to tell apart.\n".to_owned();
        return Ok(Proposal { text, more: vec![("experiment", Value::Null)] });
    }
    let below: Vec<String> = below.iter().filter(|name| !effects.contains(name)).cloned().collect();
    let found = family
        .experiment_between(&below, effects, seed)
        .map_err(|error| Failure::failed(error.to_string()))?;
    save(path, &csv(family, &found)?)?;
    let json = in_json(family, &found, path);
    let text = text(family, &found) + &written("the motion, to be followed by the axis,", path);
    Ok(Proposal { text, more: vec![("experiment", json)] })
}

/// The reference in the form in which recordings are read.
fn csv(family: &FrictionFamily, found: &Experiment) -> Result<String, Failure> {
    let step = found.reference.sample_time;
    let time = (0..found.reference.position.len()).map(|k| k as f64 * step).collect();
    let unit = family.axis().unit(Quantity::Length);
    let channel = Channel::new("position", unit, found.reference.position.clone());
    let motion = Recording::new("experiment", time, vec![channel])
        .map_err(|error| Failure::failed(error.to_string()))?;
    Ok(aep_data::to_csv_rounded(&motion, 9))
}

fn duration(found: &Experiment) -> f64 {
    found.reference.position.len() as f64 * found.reference.sample_time
}

fn in_json(family: &FrictionFamily, found: &Experiment, path: &Path) -> Value {
    let force = format!("force_{}", family.effort().unit(family.axis(), Quantity::Force));
    let separation = |separation: &Separation| {
        json!({
            force.as_str(): separation.force,
            "noises": separation.force / found.noise,
            "deviations": separation.deviations,
        })
    };
    let tried: Vec<Value> = found
        .tried
        .iter()
        .map(|(motion, deviations)| json!({ "motion": motion, "deviations": deviations }))
        .collect();
    json!({
        "effects": found.effects,
        "motion": found.motion,
        "about": found.about,
        "file": path.to_string_lossy(),
        "duration_s": duration(found),
        "predicted": separation(&found.separation),
        "here": separation(&found.here),
        "gain": found.gain,
        "tried": tried,
    })
}

fn text(family: &FrictionFamily, found: &Experiment) -> String {
    let unit = family.effort().unit(family.axis(), Quantity::Force);
    let mut text =
        heading(&format!("An experiment to tell {} apart", found.effects.join(" from ")));
    let told = |separation: &Separation| {
        format!(
            "by {} where they differ most ({:.1} times the noise), {:.1} standard deviations in all",
            quantity(separation.force, unit),
            separation.force / found.noise,
            separation.deviations
        )
    };
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        " {}: {}; {:.0} s, within the stroke, speed and acceleration recorded.",
        found.motion,
        found.about,
        duration(found)
    );
    let _ = writeln!(text, " There the two most alike differ {}.", told(&found.separation));
    let _ = writeln!(text, " In this recording they differ {}.", told(&found.here));
    if found.gain < MUCH {
        let _ = writeln!(
            text,
            " No motion within the stroke, speed and acceleration recorded tells them apart much better: \
             go beyond them."
        );
    }
    let others = found.tried.iter().filter(|(name, _)| *name != found.motion);
    let others: Vec<String> =
        others.map(|(name, deviations)| format!("{name} {deviations:.1}")).collect();
    let _ = writeln!(text, " Other motions, standard deviations: {}.", others.join(", "));
    text
}
