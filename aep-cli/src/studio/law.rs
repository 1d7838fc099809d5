//! A law while it is typed: its curve beside what the model leaves, and the law as an effect of the project.

use std::collections::BTreeMap;
use std::sync::Arc;

use friction_ident::effects::formula;
use missing_physics::report::LawBin;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::task::Task;
use super::{Studio, jobs};
use crate::failure::Failure;
use crate::output;

/// A law as the page sends it: what stands in a file of effects.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Law {
    /// Name of the effect.
    pub name: String,
    /// A force that resists the motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<String>,
    /// Or what adds to the friction level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<String>,
    /// Its parameters.
    #[serde(default)]
    pub parameters: BTreeMap<String, Parameter>,
}

/// A parameter of a law.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// SI unit.
    pub unit: String,
    /// Least value of a search.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Where it begins, and where the curve is drawn.
    pub default: f64,
    /// Whether the law is proportional to it.
    #[serde(default)]
    pub linear: bool,
}

/// What a law adds along the recorded motion, and what a model leaves there: means over stretches of a coordinate.
pub fn curve(studio: &Studio, law: &Law, of: u32) -> Result<Value, Failure> {
    let session = studio.session()?;
    let (text, level) = match (&law.force, &law.level) {
        (Some(force), None) => (force, false),
        (None, Some(level)) => (level, true),
        _ => return Err(Failure::bad_input("write one law: a force or a level")),
    };
    let parsed =
        aep_formula::Formula::parse(text).map_err(|error| Failure::bad_input(error.to_string()))?;
    let family = &session.family;
    let model = family.fitted(&studio.project().model(of)?)?;
    let value = |name: &str| law.parameters.get(name).map(|parameter| parameter.default);
    let drawn = family.typed(&parsed, &value, level, &model).map_err(|unknown| {
        Failure::bad_input(format!("'{unknown}' has no value")).with_hint(
            "give it as a parameter; x v a s t F are position, velocity, acceleration, sign of v, time, force",
        )
    })?;
    let series = |of: fn(&LawBin) -> f64| {
        drawn.bins.iter().map(|bin| Some(of(bin)).filter(|v| v.is_finite())).collect::<Vec<_>>()
    };
    Ok(json!({
        "along": drawn.along, "unit": drawn.unit, "of": drawn.quantity[1],
        "at": series(|bin| bin.at), "law": series(|bin| bin.law), "left": series(|bin| bin.data),
    }))
}

/// Keeps a law in the project and adds it to a model.
pub fn add(studio: &Arc<Studio>, law: &Law, from: u32) -> Result<(), Failure> {
    let text = toml::to_string(law).map_err(|error| Failure::bad_input(error.to_string()))?;
    formula::read(&text).map_err(|error| Failure::from_lines(&error.to_string()))?;
    let path = {
        let project = studio.project();
        let path = project.place("effects", &format!("{}.toml", law.name))?;
        let used =
            project.state.tree.entries.iter().any(|entry| entry.rung.effects.contains(&law.name));
        if path.exists() && used {
            let what = format!("a model has the effect '{}' already", law.name);
            return Err(Failure::bad_input(what).with_hint("call the new law by another name"));
        }
        output::save(&path, &text)?;
        path
    };
    // Its columns are read, and its terms are among the others. A law that has no value somewhere along the motion would
    // stand in the way of every model.
    studio.forget();
    if let Err(failure) = studio.session() {
        // Where it is not there it is gone.
        let _ = std::fs::remove_file(path);
        return Err(failure);
    }
    jobs::start(studio, Task::Add { from, effect: law.name.clone() })
}
