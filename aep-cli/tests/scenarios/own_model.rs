//! A model of the user's own: its force as a column, formulas over columns, regressors, parameters that are known.

use crate::harness::Desk;

/// A recording with the force of a model that lacks a Stribeck hump, made by `examples/model_force.py`.
const GIVEN: &str = include_str!("../../examples/model_force.csv");

fn desk() -> Desk {
    let desk = Desk::new();
    desk.write("run.csv", GIVEN);
    desk
}

#[test]
fn what_my_own_model_lacks_is_named_alone() {
    let desk = desk();
    let line = "discover run.csv --model-force model_N --time-limit none";
    let run = desk.aep(&format!("{line} --json d.json -o m.json --html d.html"));
    assert!(run.done().contains("timing.shift"), "{}", run.out);
    let json = desk.json("d.json");
    let added: Vec<&str> =
        json["added"].as_array().unwrap().iter().filter_map(|name| name.as_str()).collect();
    assert_eq!(added.len(), 1, "{added:?}");
    assert!(added[0].starts_with("stribeck"), "{added:?}");
    let last = &json["ladder"][1]["parameters"];
    let height = last[format!("{}.dF", added[0])]["value"].as_f64().unwrap();
    assert!((height / 5.0 - 1.0).abs() < 0.15, "{height}");
    // The error is relative to the measured force, not to what the model leaves of it.
    let error = json["ladder"][0]["error"]["force_relative"]["validation"].as_f64().unwrap();
    assert!(error < 0.5, "{error}");
    let model = desk.json("m.json");
    assert!(model["model_force"]["shift_s"].is_number() && model["mass"].is_null(), "{model}");
    // What was found lacks nothing any more.
    let again = "compare run.csv --model-force model_N --model m.json";
    assert!(desk.aep(again).done().contains("given over time"));
    // The same column as a formula, from DATA.toml.
    desk.write("run.toml", "model_force = \"2*model_N/2 + 0*time_s\"\n");
    desk.aep("discover run.csv --time-limit none --json e.json").done();
    assert_eq!(desk.json("e.json")["added"], json["added"]);
}

#[test]
fn every_command_takes_the_models_force() {
    let desk = desk();
    let data = "run.csv --model-force model_N";
    assert!(desk.aep(&format!("compare {data}")).done().contains("given over time"));
    let suggested = desk.aep(&format!("suggest {data} --time-limit none"));
    assert!(suggested.done().contains("--model-force model_N --add stribeck"), "{}", suggested.out);
    desk.aep(&format!("identify {data} --effects offset --model-gain fit -o m.json")).done();
    let gain = &desk.json("m.json")["effects"];
    assert!(gain.to_string().contains("model-gain"), "{gain}");
    desk.aep(&format!("extend {data} --model m.json --add stribeck -o n.json")).done();
    desk.aep("simulate --model n.json --input run.csv -o o.csv").refused(&["cannot be simulated"]);
    desk.aep("compare run.csv --model n.json").refused(&["--model-force COLUMN"]);
    desk.aep(&format!("identify {data} --effects offset --horizon windows"))
        .refused(&["cannot be simulated"]);
    desk.aep("discover run.csv --model-gain fit").refused(&["--model-force COLUMN"]);
    desk.aep("discover run.csv --model-force modl_N").refused(&["did you mean 'model_N'"]);
}

#[test]
fn columns_may_be_formulas_and_mistakes_have_a_place() {
    let desk = desk();
    let line = |force: &str| {
        [
            "identify",
            "run.csv",
            "--effects",
            "coulomb,viscous,offset",
            "--json",
            "-",
            "--force",
            force,
        ]
        .map(str::to_owned)
    };
    let whole = desk.words(&line("force_N")).done().to_owned();
    assert_eq!(desk.words(&line("(force_N + force_N)/2")).done(), whole);
    desk.words(&line("force_N - 9.81*m")).refused(&["'m'"]);
    desk.words(&line("force_N - (2*time_s")).refused(&["not closed", "force_N - (2*time_s", "^"]);
    desk.words(&line("force_N + log(position_m - position_m)")).refused(&[
        "is -inf here",
        "line 2",
        "position_m = 0",
    ]);
    desk.words(&line("sine(force_N)")).refused(&["no function 'sine'", "aep effects --formula"]);
    assert!(desk.aep("effects --formula").done().contains("atan2(y, x)"));
}

#[test]
fn a_regressor_is_an_effect_with_a_factor() {
    let desk = desk();
    let words = |more: &[&str]| -> Vec<String> {
        let start = ["run.csv", "--regressor", "pull=cos(20*position_m)"];
        start.iter().chain(more).map(|word| (*word).to_owned()).collect()
    };
    let identify = |more: &[&str]| {
        let mut all = vec!["identify".to_owned()];
        all.extend(words(more));
        desk.words(&all)
    };
    identify(&["--effects", "coulomb,viscous,offset,pull", "-o", "m.json"]).done();
    assert!(desk.read("m.json").contains("\"pull\""));
    let mut compare = vec!["compare".to_owned()];
    compare.extend(words(&["--model", "m.json"]));
    desk.words(&compare).done();
    desk.aep("compare run.csv --model m.json").refused(&["unknown effect 'pull'"]);
    let named = ["discover", "run.csv", "--regressor", "stribeck=time_s"].map(str::to_owned);
    desk.words(&named).refused(&["name of an effect of the library"]);
    let zero = ["discover", "run.csv", "--regressor", "none0=0*time_s"].map(str::to_owned);
    desk.words(&zero).refused(&["0 at every sample"]);
}

#[test]
fn what_is_known_of_parameters_is_kept() {
    let desk = desk();
    let effects = "--effects coulomb,viscous,offset";
    let line =
        format!("identify run.csv {effects} --fix mass=19.5 --bound viscous.F_v=0..30 -o m.json");
    desk.aep(&line).done();
    let model = desk.json("m.json");
    assert_eq!(model["mass"], 19.5);
    let damping = model["effects"][1]["parameters"]["F_v"].as_f64().unwrap();
    assert!((0.0..=30.0).contains(&damping), "{damping}");
    assert_eq!(model["known"]["fixed"]["mass"], 19.5);
    desk.aep("extend run.csv --model m.json --add stribeck -o n.json").done();
    assert_eq!(desk.json("n.json")["mass"], 19.5);
    desk.aep(&format!("identify run.csv {effects} --fix masss=3"))
        .refused(&["did you mean 'mass'"]);
    desk.aep(&format!("identify run.csv {effects} --fix mass=-3")).refused(&["above 0"]);
    desk.aep(&format!("identify run.csv {effects} --bound mass=3..1")).refused(&["not below"]);
}

#[test]
fn a_law_without_a_value_somewhere_is_told_with_its_place() {
    let desk = desk();
    let effect = |law: &str| {
        format!(
            "name = \"own\"\nforce = \"{law}\"\n[parameters]\nk = {{ unit = \"N\", low = -9.0, high = 9.0, default = 1.0, linear = true }}\n"
        )
    };
    for law in ["k*log(x)", "k*sqrt(x - 9)", "k/(x - x)"] {
        desk.write("own.toml", effect(law));
        desk.aep("discover run.csv --effects-file own.toml").refused(&["'own'", "sample", "t ="]);
    }
    desk.write("own.toml", effect("k*temp_C"));
    desk.aep("discover run.csv --effects-file own.toml").refused(&["temp_C"]);
    desk.write("own.toml", effect("k*tanh(model_N)"));
    desk.aep("identify run.csv --effects coulomb,own --effects-file own.toml -o m.json").done();
    desk.aep("simulate --model m.json --input run.csv -o o.csv --effects-file own.toml")
        .refused(&["reads columns of a recording"]);
    desk.write("own.toml", effect("k*x").replace("own", "ripple"));
    desk.aep("discover run.csv --effects-file own.toml")
        .refused(&["name of an effect of the library"]);
}
