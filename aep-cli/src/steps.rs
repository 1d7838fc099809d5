//! The steps of the loop that several commands share, as calls of the engine.

use std::path::Path;

use aep_core::{Aep, MetaEp, Method};
use friction_ident::effects::Effect;
use friction_ident::effects::beside::MODEL_FORCE;
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::model::Timing;
use friction_ident::{Axis, Effort, Known, Model, Quantity};
use missing_physics::diagnosis::fitted_blocks;
use missing_physics::fit::{self, Fit};
use missing_physics::measurement::looked_at;
use missing_physics::report::Rung;
use missing_physics::{Discovery, Fitted, Recording, model_of, terms};

use crate::args::library;
use crate::failure::Failure;
use crate::stop::Watch;

mod in_time;
mod stoppable;

pub use in_time::identify_in_time;

use stoppable::Stoppable;

/// A name and what makes the optimizer.
type NamedMethod = (&'static str, fn() -> Box<dyn Method<f64>>);

/// Optimizers by name.
pub const ALGORITHMS: &[NamedMethod] =
    &[("aep", || Box::new(Aep::practical())), ("meta-ep", || Box::new(MetaEp::practical()))];

/// The model family of a recording, of a very long one of pieces of it; nothing is interpolated over its long gaps.
pub fn family(
    recording: &Recording,
    bandwidth: Option<f64>,
    known: &Known,
) -> Result<FrictionFamily, Failure> {
    let used = looked_at(recording).map_err(|error| Failure::bad_input(error.to_string()))?;
    Ok(FrictionFamily::new(&used, &options(bandwidth, known))?)
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

/// Identifies a model of these effects on the fitted blocks; once `watch` is over the best one so far is
/// taken.
pub fn identify(
    family: &FrictionFamily,
    effects: &[String],
    (method, seed): (&dyn Method<f64>, u64),
    watch: Watch,
) -> Result<(Fit, usize), Failure> {
    let terms = terms(family, effects)?;
    let method = Stoppable { method, watch };
    let found = fit::identify_by(family, &terms, &fitted_blocks(family), seed, &method);
    Ok((found.fit, found.evaluations))
}

/// The optimizer of this name.
pub fn method(name: &str) -> Result<Box<dyn Method<f64>>, Failure> {
    let known = ALGORITHMS.iter().find(|(known, _)| *known == name);
    let known = known.ok_or_else(|| Failure::bad_input(format!("unknown algorithm '{name}'")))?;
    Ok(known.1())
}

/// A given model on this data, nothing fitted.
pub fn as_given(family: &FrictionFamily, model: &Model) -> Result<Fit, Failure> {
    same_axis(family, model)?;
    family.check(model)?;
    Ok(fit::as_given(family, family.fitted(model)?))
}

/// Refuses a model of a linear axis for rotary data and the other way round, and forces in another unit.
pub fn same_axis(family: &FrictionFamily, model: &Model) -> Result<(), Failure> {
    if model.axis() != family.axis() {
        return Err(other_axis());
    }
    same_effort(model, family.effort())?;
    if model.timing().is_some() == family.is_beside() {
        return Ok(());
    }
    let (what, hint) = if family.is_beside() {
        (
            "the model has a mass of its own, but the data are read with --model-force",
            "leave --model-force out, or make a model beside it: 'aep identify DATA --model-force COLUMN --effects offset'",
        )
    } else {
        (
            "the model stands beside a force that another model gives, but the data are read without it",
            "say the column of that force: --model-force COLUMN",
        )
    };
    Err(Failure::bad_input(what).with_hint(hint))
}

/// Refuses a model in volts for a force in newtons, and the like.
pub fn same_effort(model: &Model, effort: Effort) -> Result<(), Failure> {
    if model.effort() == effort {
        return Ok(());
    }
    let unit = |effort: Effort| effort.unit(model.axis(), Quantity::Force);
    let (there, here) = (unit(model.effort()), unit(effort));
    let what = format!("the model is in {there}, but the force of the data is in {here}");
    Err(Failure::bad_input(what)
        .with_hint("read both in one unit: --force-unit V, or a gain: --force-gain G"))
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

/// The failure of a model and data that do not belong together.
pub fn other_axis() -> Failure {
    let what = "one of model and data is of a linear axis, the other of a rotary one";
    Failure::bad_input(what).with_hint("identify a model on this data with 'aep identify'")
}

/// The plant that a rung describes.
pub fn model(family: &FrictionFamily, rung: &Rung) -> Result<Model, Failure> {
    let model = family.model(&model_of(family, rung)?)?;
    Ok(model.with_known(family.known().clone()))
}
