//! MODEL.json.

use std::collections::BTreeMap;

use super::{Axis, Deserialize, Effort, Library, Model, ModelError, Serialize, Timing, address};
use crate::effects::Effect;
use crate::known::Known;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    /// The JSON schema that the file names, if any.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    schema: Option<String>,
    axis: Axis,
    /// What forces are measured in; nothing for N or N m.
    #[serde(default, skip_serializing_if = "is_si")]
    effort: Effort,
    /// kg, or kg m^2 on a rotary axis.
    #[serde(alias = "inertia", default, skip_serializing_if = "Option::is_none")]
    mass: Option<f64>,
    /// In place of a mass: the model stands beside a force that another one gives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    model_force: Option<Timing>,
    effects: Vec<FileTerm>,
    /// Parameters that are known from elsewhere.
    #[serde(default, skip_serializing_if = "Known::is_empty")]
    known: Known,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_si(effort: &Effort) -> bool {
    effort.is_si()
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileTerm {
    effect: String,
    parameters: BTreeMap<String, f64>,
}

impl Model {
    /// Reads MODEL.json with the effects of `library`.
    ///
    /// # Errors
    /// Text that is not JSON of this form, unknown effects and parameters, missing and unacceptable
    /// values.
    pub fn from_json(text: &str, library: &Library) -> Result<Self, ModelError> {
        let file: File =
            serde_json::from_str(text).map_err(|error| ModelError::Syntax(error.to_string()))?;
        Self::from_file(&file, library)
    }

    fn from_file(file: &File, library: &Library) -> Result<Self, ModelError> {
        let mut model = match (file.mass, &file.model_force) {
            (Some(mass), None) => Self::new(file.axis, mass)?,
            (None, Some(given)) => Self::beside(file.axis, *given)?,
            (None, None) => return Err(ModelError::Syntax("missing field `mass`".to_owned())),
            (Some(_), Some(_)) => {
                let both = "it has a mass and stands beside a model_force: keep one of them";
                return Err(ModelError::Syntax(both.to_owned()));
            }
        };
        for term in &file.effects {
            let effect = library.find(&term.effect)?;
            check_complete(effect, term)?;
            model = model.with_effect(effect)?;
            for (name, value) in &term.parameters {
                model.set(&address(effect, name), *value)?;
            }
        }
        Ok(model.with_effort(file.effort).with_known(file.known.clone()))
    }

    /// MODEL.json, indented.
    ///
    /// # Errors
    /// [`ModelError::Syntax`] if a value cannot be written; all values of a model can.
    pub fn to_json(&self) -> Result<String, ModelError> {
        serde_json::to_string_pretty(self).map_err(|error| ModelError::Syntax(error.to_string()))
    }

    fn to_file(&self) -> File {
        let effects = self.terms.iter().map(|term| {
            let names = term.effect.about().parameters.iter().map(|p| p.name.to_owned());
            let parameters = names.zip(term.values.iter().copied()).collect();
            FileTerm { effect: term.name().to_owned(), parameters }
        });
        let mass = self.timing.is_none().then_some(self.mass);
        let model_force = self.timing;
        let (known, effects) = (self.known.clone(), effects.collect());
        let (axis, effort) = (self.axis, self.effort);
        File { schema: None, axis, effort, mass, model_force, effects, known }
    }
}

impl Serialize for Model {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.to_file().serialize(serializer)
    }
}

/// With the built-in effects; [`Model::from_json`] takes any library.
impl<'de> Deserialize<'de> for Model {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let file = File::deserialize(deserializer)?;
        Self::from_file(&file, &Library::builtin()).map_err(serde::de::Error::custom)
    }
}

fn check_complete(effect: &dyn Effect, term: &FileTerm) -> Result<(), ModelError> {
    let needed = effect.about().parameters.iter().map(|p| p.name);
    match needed.clone().find(|name| !term.parameters.contains_key(*name)) {
        None => Ok(()),
        Some(parameter) => Err(ModelError::MissingParameter {
            effect: term.effect.clone(),
            parameter: parameter.to_owned(),
            needed: needed.map(str::to_owned).collect(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::ALL;

    fn read(text: &str) -> Result<Model, ModelError> {
        Model::from_json(text, &Library::builtin())
    }

    #[test]
    fn a_model_of_every_effect_survives_the_file_to_the_bit() {
        for effect in ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())) {
            let mut model =
                Model::new(Axis::Rotary, 1.0 / 3.0).unwrap().with_effect(*effect).unwrap();
            let name = address(*effect, effect.about().parameters[0].name);
            model.set(&name, 0.1 + 0.2).unwrap();
            assert_eq!(read(&model.to_json().unwrap()).unwrap(), model);
        }
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said() {
        let term = |t: &str| format!(r#"{{"axis":"linear","mass":1.0,"effects":[{t}]}}"#);
        let unknown = term(r#"{"effect":"coulom","parameters":{"F_C":1}}"#);
        assert!(read(&unknown).unwrap_err().to_string().contains("did you mean 'coulomb'"));
        let missing = term(r#"{"effect":"stribeck","parameters":{"dF":1}}"#);
        assert!(read(&missing).unwrap_err().to_string().contains("lacks its parameter 'v_s'"));
        let extra = term(r#"{"effect":"coulomb","parameters":{"F_C":1,"F_S":2}}"#);
        assert!(read(&extra).unwrap_err().to_string().contains("'coulomb.F_S'"));
        let syntax = read(r#"{"axis":"linear","effects":[]}"#).unwrap_err().to_string();
        assert!(syntax.contains("missing field `mass`"), "{syntax}");
        let mass = read(r#"{"axis":"linear","mass":-1,"effects":[]}"#).unwrap_err().to_string();
        assert!(mass.contains("'mass' is -1"), "{mass}");
    }

    #[test]
    fn a_model_in_volts_stays_one() {
        let model = Model::new(Axis::Linear, 2.0).unwrap().with_effort(Effort::Volt);
        let text = model.to_json().unwrap();
        assert!(text.contains("\"effort\": \"V\""), "{text}");
        let back = read(&text).unwrap();
        assert_eq!((back.unit("mass").unwrap(), back == model), ("V s^2/m", true));
    }

    #[test]
    fn a_rotary_model_may_call_its_mass_inertia() {
        let model = read(r#"{"axis":"rotary","inertia":0.01,"effects":[]}"#).unwrap();
        assert_eq!((model.axis(), model.mass()), (Axis::Rotary, 0.01));
    }
}
