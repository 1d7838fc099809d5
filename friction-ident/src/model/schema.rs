//! The JSON schema of MODEL.json, made of the effects' own tables.

use serde_json::{Value, json};

use crate::axis::{Axis, Quantity};
use crate::effects::beside::BESIDE;
use crate::effects::{Effect, Library, Parameter, Scale};

/// Where the schema lives in the repository, and what an exported model calls it.
pub const SCHEMA: &str = "model.schema.json";

/// The schema of a model with the effects of `library`: JSON Schema, draft 2020-12.
pub fn schema(library: &Library) -> Value {
    let effects: Vec<Value> = library
        .effects()
        .iter()
        .flat_map(|effect| std::iter::once(*effect).chain(effect.forms().iter().copied()))
        .chain(BESIDE.iter().copied())
        .map(term)
        .collect();
    let units = |quantity| (Axis::Linear.unit(quantity), Axis::Rotary.unit(quantity));
    let (linear, rotary) = units(Quantity::Mass);
    let mass = json!({
        "type": "number",
        "exclusiveMinimum": 0,
        "description": format!("mass, {linear}; on a rotary axis inertia, {rotary}"),
    });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": SCHEMA,
        "title": "Model of a one-axis drive",
        "description": "A mass or an inertia and the effects that act on it, SI units. Written by aep identify, extend, discover and export.",
        "type": "object",
        "properties": {
            "$schema": { "type": "string" },
            "axis": {
                "enum": ["linear", "rotary"],
                "description": "linear: N, m, kg; rotary: N m, rad, kg m^2",
            },
            "effort": {
                "enum": ["SI", "V", "A"],
                "description": "what forces are measured in: N or N m where nothing is said, else a voltage or a current; the mass is then V s^2/m, F_v V s/m, and so on",
            },
            "mass": mass,
            "inertia": mass,
            "model_force": {
                "type": "object",
                "description": "in place of a mass: the model stands beside a force that another model gives for every sample",
                "properties": {
                    "shift_s": { "type": "number", "description": "how much later the recorded force is, s" },
                    "smoothing_s2": { "type": "number", "description": "variance of the smoothing that it went through, s^2" },
                },
                "required": ["shift_s"],
                "additionalProperties": false,
            },
            "known": {
                "type": "object",
                "description": "parameters that are known from elsewhere, by address (mass, viscous.F_v), SI",
                "properties": {
                    "fixed": { "type": "object", "additionalProperties": { "type": "number" } },
                    "bounds": {
                        "type": "object",
                        "additionalProperties": {
                            "type": "array",
                            "items": { "type": "number" },
                            "minItems": 2,
                            "maxItems": 2,
                        },
                    },
                },
                "additionalProperties": false,
            },
            "effects": { "type": "array", "items": { "oneOf": effects } },
        },
        "required": ["axis", "effects"],
        "oneOf": [{ "required": ["mass"] }, { "required": ["inertia"] }, { "required": ["model_force"] }],
        "additionalProperties": false,
    })
}

fn term(effect: &dyn Effect) -> Value {
    let about = effect.about();
    let properties: serde_json::Map<String, Value> =
        about.parameters.iter().map(|p| (p.name.to_owned(), parameter(p))).collect();
    let names: Vec<&str> = about.parameters.iter().map(|p| p.name).collect();
    json!({
        "title": about.title,
        "description": about.equation,
        "type": "object",
        "properties": {
            "effect": { "const": about.name },
            "parameters": {
                "type": "object",
                "properties": properties,
                "required": names,
                "additionalProperties": false,
            },
        },
        "required": ["effect", "parameters"],
        "additionalProperties": false,
    })
}

fn parameter(parameter: &Parameter) -> Value {
    let unit = |axis: Axis| axis.unit(parameter.quantity);
    let (linear, rotary) = (unit(Axis::Linear), unit(Axis::Rotary));
    let units =
        if linear == rotary { linear.to_owned() } else { format!("{linear} or {rotary} (rotary)") };
    let description = format!("{}, {units}", parameter.meaning);
    match parameter.scale {
        Scale::Linear => json!({ "type": "number", "description": description }),
        Scale::Log => {
            json!({ "type": "number", "exclusiveMinimum": 0, "description": description })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::ALL;
    use crate::model::Model;
    use boon::{Compiler, SchemaIndex, Schemas};

    /// The file in the package.
    const PUBLISHED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/schema/model.schema.json");

    fn published() -> Value {
        let text = std::fs::read_to_string(PUBLISHED).unwrap();
        serde_json::from_str(&text).unwrap()
    }

    fn compiled() -> (Schemas, SchemaIndex) {
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        compiler.add_resource("http://localhost/model.schema.json", published()).unwrap();
        let index = compiler.compile("http://localhost/model.schema.json", &mut schemas).unwrap();
        (schemas, index)
    }

    #[test]
    fn the_published_schema_is_that_of_the_effects() {
        let now = schema(&Library::builtin());
        let text = serde_json::to_string_pretty(&now).unwrap() + "\n";
        if std::env::var_os("AEP_WRITE_SCHEMA").is_some() {
            std::fs::write(PUBLISHED, &text).unwrap();
        }
        assert_eq!(
            published(),
            now,
            "friction-ident/schema/model.schema.json is not up to date; AEP_WRITE_SCHEMA=1 cargo test -p friction-ident schema writes it"
        );
    }

    #[test]
    fn models_of_every_effect_are_valid() {
        let (schemas, index) = compiled();
        for effect in ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())) {
            for axis in [Axis::Linear, Axis::Rotary] {
                let model = Model::new(axis, 2.0).unwrap().with_effect(*effect).unwrap();
                let value = serde_json::to_value(&model).unwrap();
                let valid = schemas.validate(&value, index);
                assert!(valid.is_ok(), "{}: {}", effect.about().name, valid.unwrap_err());
            }
        }
        let example =
            r#"{"$schema":"model.schema.json","axis":"rotary","inertia":0.1,"effects":[]}"#;
        schemas.validate(&serde_json::from_str(example).unwrap(), index).unwrap();
        assert!(Model::from_json(example, &Library::builtin()).is_ok());
    }

    #[test]
    fn what_the_reader_refuses_is_not_valid() {
        let (schemas, index) = compiled();
        let term = |t: &str| format!(r#"{{"axis":"linear","mass":1.0,"effects":[{t}]}}"#);
        for text in [
            r#"{"axis":"linear","effects":[]}"#.to_owned(),
            r#"{"axis":"linear","mass":-1,"effects":[]}"#.to_owned(),
            r#"{"axis":"diagonal","mass":1,"effects":[]}"#.to_owned(),
            term(r#"{"effect":"coulom","parameters":{"F_C":1}}"#),
            term(r#"{"effect":"stribeck","parameters":{"dF":1}}"#),
            term(r#"{"effect":"stribeck","parameters":{"dF":1,"v_s":0}}"#),
            term(r#"{"effect":"coulomb","parameters":{"F_C":1,"F_S":2}}"#),
        ] {
            assert!(
                schemas.validate(&serde_json::from_str(&text).unwrap(), index).is_err(),
                "{text}"
            );
            assert!(Model::from_json(&text, &Library::builtin()).is_err(), "{text}");
        }
    }
}
