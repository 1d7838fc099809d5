//! A discovery in JSON is what its published schema says.

use boon::{Compiler, Schemas};
use friction_ident::family::{FrictionFamily, Options};
use missing_physics::report::{Confirmed, SCHEMA};
use missing_physics::{confirm, discover};
use serde_json::Value;

use super::table::{among, plain, record};

const PLACE: &str = "http://localhost/discovery.schema.json";

/// Whether a value is a discovery by the schema, and what is wrong with it.
fn checked(value: &Value) -> Result<(), String> {
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource(PLACE, serde_json::from_str(SCHEMA).unwrap()).unwrap();
    let index = compiler.compile(PLACE, &mut schemas).unwrap();
    schemas.validate(value, index).map_err(|error| format!("{error:#}"))
}

#[test]
fn a_discovery_is_what_the_published_schema_says() {
    let recording = record(&plain().with("quadratic-drag", &[("c", 900.0)]).unwrap());
    let family = FrictionFamily::new(&recording, &Options::default()).unwrap();
    let settings = among(&family, &["quadratic-drag", "ripple"]);
    let mut found = discover(&family, &settings, &mut ()).unwrap();
    let rungs = confirm(&family, &found.ladder, &settings).unwrap();
    found.confirmation = Some(Confirmed { recording: "the same".into(), rungs });
    let json = aep_studio::json::json(&found).unwrap();
    checked(&json).unwrap();
    // A field that nobody has published, and a number that became a sentence, are seen.
    let mut more = json.clone();
    more["surprise"] = 1.into();
    assert!(checked(&more).is_err());
    let mut words = json;
    words["ladder"][0]["error"]["force_rms_N"]["fit"] = "3 N".into();
    assert!(checked(&words).is_err());
}
