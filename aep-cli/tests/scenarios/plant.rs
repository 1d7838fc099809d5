//! The plant: effects of one's own, identification by simulation, the paper's figures of the table.

use crate::harness::Desk;

const DRAG: &str = r#"
name = "seal"
force = "a * tanh(v / w)"
[parameters]
a = { unit = "N", low = -20.0, high = 20.0, default = 1.0, linear = true }
w = { unit = "m/s", low = 1e-3, high = 0.2, default = 0.02 }
"#;

#[test]
fn an_effect_of_ones_own_goes_through_every_command() {
    let desk = Desk::new();
    desk.challenge("nothing", 2, "c");
    desk.write("seal.toml", DRAG);
    let with = |line: &str| desk.aep(&format!("{line} --effects-file seal.toml"));
    assert!(with("effects").done().contains("a * tanh(v / w)"));
    assert!(with("effects seal").done().contains("m/s"));
    let data = "c/recording.csv";
    with(&format!("identify {data} --effects coulomb,viscous,seal -o m.json")).done();
    let model = desk.json("m.json");
    assert_eq!(model["effects"][2]["effect"], "seal");
    with(&format!("simulate --model m.json --input {data} -o out.csv")).done();
    with(&format!("compare {data} --model m.json")).done();
    desk.aep(&format!("compare {data} --model m.json")).refused(&["unknown effect 'seal'"]);
    with(&format!("identify {data} --effects coulomb,viscous -o base.json")).done();
    let suggested = with(&format!("suggest {data} --model base.json --json s.json"));
    suggested.done();
    let ranking = desk.json("s.json")["ranking"][0].to_string();
    assert!(ranking.contains("\"seal\""), "{ranking}");
    desk.write("bad.toml", DRAG.replace("tanh(v / w)", "tanh(v / u)"));
    // A name that is no parameter is a column of the recording, or nothing.
    let bad = format!("identify {data} --effects coulomb,seal -o b.json --effects-file bad.toml");
    desk.aep(&bad).refused(&["no column for the effect called 'u'"]);
}

#[test]
fn a_model_is_identified_by_simulating_it() {
    let desk = Desk::new();
    desk.challenge("nothing", 2, "c");
    let recorded = desk.read("c/recording.csv");
    let some: Vec<&str> = recorded.lines().take(3001).collect();
    desk.write("c/some.csv", some.join("\n"));
    desk.write("c/some.toml", desk.read("c/recording.toml"));
    let line = "identify c/some.csv --effects coulomb,viscous --horizon free-run \
                --max-step 0.002 --population 16 --generations 20 --json f.json -o m.json";
    let run = desk.aep(line);
    assert!(run.done().contains("95 % interval"), "{}", run.out);
    let mass = &desk.json("f.json")["parameters"]["mass"];
    assert!(mass["low"].as_f64() <= mass["value"].as_f64(), "{mass}");
    let stopped = desk.aep(&format!("{line} --time-limit 1e-3"));
    assert!(stopped.done().contains("stopped before"), "{}", stopped.out);
    assert_eq!(desk.json("m.json")["effects"][0]["effect"], "coulomb");
    desk.aep("identify c/recording.csv --effects coulomb --horizon closed-loop")
        .refused(&["needs the gains", "--gains"]);
}

#[test]
fn the_tables_friction_and_training_data_are_reproduced() {
    let desk = Desk::new();
    let run = desk.aep("reproduce fig8 fig11 -o paper");
    assert!(run.done().contains("stick-slip motion"), "{}", run.out);
    assert!(desk.read("paper/fig8.csv").starts_with("velocity_cm_s,friction_kgf"));
    assert_eq!(desk.read("paper/fig11.csv").lines().count(), 8001);
    assert!(desk.read("paper/fig11-output.svg").contains("position in cm"));
}
