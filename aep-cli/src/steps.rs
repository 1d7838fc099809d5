//! The steps of the loop that several commands share, as calls of the engine.

use std::path::Path;

use aep_core::Method;
use friction_ident::effects::Effect;
use friction_ident::effects::beside::MODEL_FORCE;
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::model::Timing;
use friction_ident::{Axis, Effort, Known, Model, Quantity};
use missing_physics::measurement::looked_at;
use missing_physics::{Discovery, Fitted, Recording, model_of};

use crate::args::library;
use crate::failure::Failure;

/// Optimizers by name, and what the library calls them.
pub const ALGORITHMS: &[(&str, &str)] =
    &[("aep", "aep-practical"), ("meta-ep", "meta-ep-practical")];

/// The model family of a recording, of a very long one of pieces of it; nothing is interpolated over its long gaps.
pub fn family(
    recording: &Recording,
    bandwidth: Option<f64>,
    known: &Known,
) -> Result<FrictionFamily, Failure> {
    Ok(FrictionFamily::new(&used(recording)?, &options(bandwidth, known))?)
}

/// The model family in which a recording is searched; what is shown of it is compared below `bandwidth`, Hz.
pub fn searched(
    recording: &Recording,
    bandwidth: Option<f64>,
    known: &Known,
) -> Result<FrictionFamily, Failure> {
    Ok(FrictionFamily::to_search(&used(recording)?, &options(bandwidth, known))?)
}

fn used(recording: &Recording) -> Result<Recording, Failure> {
    looked_at(recording).map_err(|error| Failure::bad_input(error.to_string()))
}

/// The models of a ladder.
pub fn ladder(family: &FrictionFamily, discovery: &Discovery) -> Result<Vec<Fitted>, Failure> {
    discovery.ladder.iter().map(|rung| Ok(model_of(family, rung)?)).collect()
}

/// How a recording is prepared.
pub fn options(bandwidth: Option<f64>, known: &Known) -> Options {
    Options { bandwidth, library: library(), known: known.clone() }
}

/// Reads MODEL.json.
pub fn read_model(path: &Path) -> Result<Model, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::bad_input(format!("cannot read the model: {error}")).in_file(path).with_hint(
            "'aep identify DATA --effects coulomb,viscous,offset -o MODEL.json' makes one",
        )
    })?;
    Model::from_json(&text, &library()).map_err(|error| Failure::from(error).in_file(path))
}

/// Reads MODEL.json, or takes the force that the user's own model gives as it is.
pub fn model_or_given(path: Option<&Path>, recording: &Recording) -> Result<Model, Failure> {
    if let Some(path) = path {
        return read_model(path);
    }
    if recording.channel(MODEL_FORCE).is_none() {
        let hint = "say which one: --model MODEL.json, or the column of your own model: --model-force COLUMN";
        return Err(Failure::bad_input("a model is needed").with_hint(hint));
    }
    let rotary = recording.channel("position").is_some_and(|channel| channel.unit == "rad");
    let axis = if rotary { Axis::Rotary } else { Axis::Linear };
    let unit = recording.channel("force").map_or("", |channel| channel.unit.as_str());
    Ok(Model::beside(axis, Timing::default())?.with_effort(Effort::of(unit)))
}

/// Reads MODEL.json as something that can be simulated.
pub fn read_plant(path: &Path) -> Result<Model, Failure> {
    let model = read_model(path)?;
    if model.timing().is_some() {
        let what = "the model stands beside a force that another model gives: it has no mass and cannot be simulated";
        return Err(Failure::bad_input(what).in_file(path).with_hint(
            "identify a model of its own: 'aep identify DATA --effects coulomb,viscous,offset -o MODEL.json'",
        ));
    }
    let read = model.terms().iter().find(|term| reads_recording(term.effect()));
    if let Some(term) = read {
        let what = format!(
            "'{}' reads columns of a recording: it cannot be simulated without",
            term.name()
        );
        return Err(Failure::bad_input(what).in_file(path).with_hint("leave it out of the model"));
    }
    Ok(model)
}

fn reads_recording(effect: &dyn Effect) -> bool {
    !effect.columns().is_empty()
}

/// Refuses to simulate beside a force that another model gives.
pub fn needs_plant(family: &FrictionFamily) -> Result<(), Failure> {
    if !family.is_beside() {
        return Ok(());
    }
    let what = "beside --model-force there is no mass of ours: its motion cannot be simulated";
    Err(Failure::bad_input(what)
        .with_hint("leave --model-force out, or compare forces (--horizon force)"))
}

/// The optimizer of this name with a population, 0 for its own.
pub fn method(name: &str, population: usize) -> Result<Box<dyn Method<f64>>, Failure> {
    let known = ALGORITHMS.iter().find(|(known, _)| *known == name);
    let found = known.and_then(|(_, name)| aep_core::methods::find(name));
    let found = found.ok_or_else(|| Failure::bad_input(format!("unknown algorithm '{name}'")))?;
    Ok((found.build)(population))
}

/// Refuses to compute a command in newtons from a model in volts or amperes.
pub fn needs_force(model: &Model, path: &Path) -> Result<(), Failure> {
    if model.effort().is_si() {
        return Ok(());
    }
    let unit = model.effort().unit(model.axis(), Quantity::Force);
    let what = format!("the model is in {unit}: a compensator commands a force or a torque");
    Err(Failure::bad_input(what)
        .in_file(path)
        .with_hint("identify it with the gain of the drive: --force-gain G"))
}

/// Refuses recordings of a linear axis next to those of a rotary one.
pub fn same_axes(family: &FrictionFamily, other: &FrictionFamily) -> Result<(), Failure> {
    if family.axis() == other.axis() && family.effort() == other.effort() {
        return Ok(());
    }
    let what = if family.axis() == other.axis() {
        "the forces of the recordings are not in one unit"
    } else {
        "one of the recordings is of a linear axis, the other of a rotary one"
    };
    Err(Failure::bad_input(what).with_hint("give --validate recordings of the same drive"))
}
