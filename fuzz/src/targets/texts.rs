//! What people write: mappings, formulas, effects, models.

use std::path::Path;

use aep_data::{Mapping, parse};
use aep_formula::Formula;
use friction_ident::{Input, Library, Model, Start, effects, simulate};
use missing_physics::Hold;

use super::{Target, outline};

pub const MAPPING: Target =
    Target::new("mapping", || texts(&MAPPINGS), |input| text(input, mapping));
pub const FORMULA: Target =
    Target::new("formula", || texts(&FORMULAS), |input| text(input, formula));
pub const EFFECT: Target = Target::new("effect", || texts(&EFFECTS), |input| text(input, effect));
pub const MODEL: Target = Target::new("model", || texts(&MODELS), |input| text(input, model));

const MAPPINGS: [&str; 2] = [
    "hold = \"zero-order\"\ninterval_s = 0.001\n[force]\ncolumn = \"u\"\nunit = \"V\"\ngain = 35.15\n\
     [position]\ncolumn = \"q\"\nunit = \"mm\"\n[regressors]\nload = \"u*q\"\n",
    "topic = \"/joints\"\n[force]\ncolumn = \"if(q > 1, u, -u)\"\n[axes.elbow]\nforce = \"i_3*1.7\"\nposition = \"q\"\n",
];
const FORMULAS: [&str; 4] = [
    "kp*(target_rad - angle_rad)",
    "F_C*sign(v) + a*exp(-((v/v_s)**2))*sin(2*pi*x/p + 0.3)",
    "if(x > 0.5, sqrt(abs(x)), min(x, max(y, 1e-3))) - atan2(`Motor [N]`, -y)",
    "((((((x))))))^2/3 == 1",
];
const EFFECTS: [&str; 2] = [
    "name = \"cogging\"\ntitle = \"cogging of the motor\"\nforce = \"a*sin(2*pi*x/p) + b*cos(2*pi*x/p)\"\n\
     [parameters]\na = { unit = \"N\", low = -20, high = 20, default = 1, linear = true }\n\
     b = { unit = \"N\", low = -20, high = 20, default = 0, linear = true }\n\
     p = { unit = \"m\", low = 2e-4, high = 2e-3, default = 6e-4 }\n",
    "name = \"wear\"\nlevel = \"c*abs(x - x_0)\"\nshows = \"more friction away from a place\"\n\
     [parameters]\nc = { unit = \"N/m\", low = 0, high = 50, default = 1, linear = true }\n\
     x_0 = { unit = \"m\", low = -1, high = 1, default = 0, from = \"stroke-begin\" }\n",
];
const MODELS: [&str; 2] = [
    r#"{"axis": "linear", "mass": 33.0, "effects": [{"effect": "coulomb", "parameters": {"F_C": 4.0}},
       {"effect": "viscous", "parameters": {"F_v": 400.0}}, {"effect": "offset", "parameters": {"F_0": 0.1}}]}"#,
    r#"{"axis": "rotary", "mass": 0.01, "effects": [{"effect": "presliding", "parameters": {"k_t": 2e5}},
       {"effect": "coulomb", "parameters": {"F_C": 0.4}}], "known": {"fixed": {"mass": 0.01}}}"#,
];

fn texts(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}

/// What is no text is refused before anything is read of it.
fn text(input: &[u8], run: fn(&str) -> String) -> String {
    std::str::from_utf8(input).map_or_else(|_| "no text".to_owned(), run)
}

fn mapping(text: &str) -> String {
    let mapping = match Mapping::parse(text, Path::new("run.toml")) {
        Ok(mapping) => mapping,
        Err(error) => return outline(&error.to_string()),
    };
    let again = Mapping::parse(&mapping.to_toml(), Path::new("run.toml"));
    assert!(again.is_ok(), "what is written is read: {again:?}");
    let rows: Vec<String> = (0..40).map(|k| format!("{k},{},{}\n", k % 7, k % 5)).collect();
    let table = format!("t_ms,u,q\n{}", rows.concat());
    match parse(Path::new("run.csv"), table.into_bytes(), &mapping) {
        Ok(loaded) => format!("{} channels", loaded.recording.channels().len()),
        Err(error) => outline(&error.to_string()),
    }
}

fn formula(text: &str) -> String {
    match Formula::parse(text) {
        Ok(formula) => {
            let count = formula.names().len();
            let values = [0.0, -1.0, 0.3, f64::NAN, f64::INFINITY, -1e308, 4.9e-324];
            let kinds = values.map(|value| formula.value(&vec![value; count]).classify());
            format!("{count} names {kinds:?}")
        }
        Err(error) => outline(&error.to_string()),
    }
}

fn effect(text: &str) -> String {
    match effects::formula::read(text) {
        Ok(effect) => {
            let about = effect.about();
            let model = Model::new(friction_ident::Axis::Linear, 1.0);
            let model = model.and_then(|model| model.with_effect(effect));
            format!(
                "{} parameters {}",
                about.parameters.len(),
                model.map_or_else(|e| outline(&e.to_string()), |m| moved(&m))
            )
        }
        Err(error) => outline(&error.to_string()),
    }
}

fn model(text: &str) -> String {
    match Model::from_json(text, &Library::builtin()) {
        Ok(model) => {
            let written = model.to_json().map_err(|error| error.to_string());
            let again = written.and_then(|text| {
                Model::from_json(&text, &Library::builtin()).map_err(|error| error.to_string())
            });
            assert!(again.is_ok(), "what is written is read: {again:?}");
            moved(&model)
        }
        Err(error) => outline(&error.to_string()),
    }
}

/// How a simulation of a model ends.
fn moved(model: &Model) -> String {
    let time: Vec<f64> = (0..50).map(|k| 1e-3 * f64::from(k)).collect();
    let force: Vec<f64> = (0..50).map(|k| 10.0 * f64::from(k % 11 - 5)).collect();
    let input = Input::new(&time, &force, Hold::ZeroOrder);
    match simulate(model, &input, &Start::at(0.0, 0.0)) {
        Ok(_) => "moves".to_owned(),
        Err(error) => outline(&error.to_string()),
    }
}
