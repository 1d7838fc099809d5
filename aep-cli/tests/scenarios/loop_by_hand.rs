//! The loop, one command a step: identify, compare, suggest, extend, compare again, simulate.

use crate::harness::Desk;

#[test]
fn friction_is_told_as_level_and_viscosity_where_its_parameters_are_not_determined() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let line = "identify c/recording.csv --effects coulomb,viscous,offset,asymmetry";
    let run = desk.aep(&format!("{line} --json i.json --html i.html"));
    assert!(run.done().contains("friction level forwards"), "{}", run.out);
    let truth = &desk.json("c/truth.json")["model"]["effects"];
    let of = |effect: &str, parameter: &str| {
        let found = truth.as_array().unwrap().iter().find(|e| e["effect"] == effect);
        found.map_or(0.0, |effect| effect["parameters"][parameter].as_f64().unwrap())
    };
    let json = desk.json("i.json");
    let told = |name: &str| {
        let all = json["friction"]["quantities"].as_array().unwrap();
        let found = all.iter().find(|quantity| quantity["name"] == name).unwrap();
        assert_eq!(found["identifiable"], true, "{found}");
        ["low", "value", "high"].map(|key| found[key].as_f64().unwrap())
    };
    let (level, offset) = (of("coulomb", "F_C"), of("offset", "F_0"));
    for (name, value) in [("F_C+", level + offset), ("F_C-", level - offset)] {
        let [low, found, high] = told(name);
        assert!((found / value - 1.0).abs() < 0.03, "{name}: {found} {value}");
        assert!(low < value && value < high && high - low < 0.1 * value, "{name} {low} {high}");
    }
    let [_, found, _] = told("F_v mean");
    assert!((found / of("viscous", "F_v") - 1.0).abs() < 0.05, "{found}");
    assert!(desk.read("i.html").contains("What they make together"));
}

#[test]
fn the_loop_by_hand_finds_and_adds_the_hidden_effect() {
    let desk = Desk::new();
    desk.challenge("stribeck", 2, "c");
    let data = "c/recording.csv";

    let identified =
        desk.aep(&format!("identify {data} --effects coulomb,viscous,offset -o model.json"));
    assert!(identified.done().contains("coulomb.F_C"));

    let compared = desk
        .aep(&format!("compare {data} --model model.json --json before.json --html before.html"));
    assert!(compared.done().contains("of the error"));
    assert!(desk.read("before.html").contains("How well the model fits"));
    for part in ["In several views", "windows of 0.1 s", "free run", "closed loop"] {
        assert!(compared.out.contains(part), "{part}");
    }
    let views = &desk.json("before.json")["views"];
    assert!(views[0]["metrics"]["validation"]["fit_percent"].is_f64());

    let suggested = desk
        .aep(&format!("suggest {data} --time-limit none --model model.json --json suggested.json"));
    assert!(suggested.done().contains("--add stribeck"), "{}", suggested.out);
    let ranking = &desk.json("suggested.json")["ranking"][0];
    assert_eq!(ranking[0]["effect"], "stribeck");

    let extended =
        desk.aep(&format!("extend {data} --model model.json --add stribeck -o better.json"));
    assert!(extended.done().contains("+ stribeck"));
    let line = "compare {data} --model better.json --model model.json --json after.json";
    let both = desk.aep(&line.replace("{data}", data));
    assert!(both.done().contains("better"), "{}", both.out);
    assert_eq!(desk.json("after.json")["models"].as_array().unwrap().len(), 2);
    let error =
        |name: &str| desk.json(name)["error"]["force_relative"]["validation"].as_f64().unwrap();
    assert!(error("after.json") < 0.4 * error("before.json"));

    let simulated = desk.aep(&format!("simulate --model better.json --input {data} -o motion.csv"));
    assert!(simulated.done().contains("rms away from the measured position"));
    let header = "time_s,force_N,position_m,velocity_m_s,measured_position_m";
    assert_eq!(desk.read("motion.csv").lines().next(), Some(header));
}

#[test]
fn another_optimizer_finds_the_same_parameters() {
    let desk = Desk::new();
    desk.challenge("stribeck", 2, "c");
    let value = |algorithm: &str| {
        let line = format!(
            "identify c/recording.csv --effects coulomb,viscous,offset,stribeck --algorithm {algorithm} --json -"
        );
        let run = desk.aep(&line);
        let json: serde_json::Value = serde_json::from_str(run.done()).unwrap();
        json["parameters"]["stribeck.v_s"]["value"].as_f64().unwrap()
    };
    let (aep, meta_ep) = (value("aep"), value("meta-ep"));
    assert!((aep / meta_ep - 1.0).abs() < 1e-3, "{aep} {meta_ep}");
}

#[test]
fn an_effect_that_the_model_has_is_not_added_again() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    desk.aep("identify c/recording.csv -q --effects coulomb,viscous -o model.json").done();
    desk.aep("extend c/recording.csv --model model.json --add viscous -o better.json")
        .refused(&["has 'viscous' already", "  model.json"]);
    assert!(!desk.path("better.json").exists());
}

#[test]
fn a_gain_of_the_motor_without_a_known_mass_is_not_determined() {
    let desk = Desk::new();
    desk.challenge("stribeck", 2, "c");
    let line = "identify c/recording.csv --effects coulomb,viscous,offset,motor-gain --json -";
    let json: serde_json::Value = serde_json::from_str(desk.aep(line).done()).unwrap();
    let parameters = json["parameters"].as_object().unwrap();
    assert_eq!(parameters.len(), 5);
    for (name, parameter) in parameters {
        assert_eq!(parameter["identifiable"], false, "{name}: {parameter}");
    }
}

#[test]
fn parameters_stand_in_the_order_of_the_model() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let run = desk.aep("identify c/recording.csv --effects viscous,offset,coulomb");
    let places = ["mass", "viscous.F_v", "offset.F_0", "coulomb.F_C"].map(|p| run.done().find(p));
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{}", run.out);
}

#[test]
fn a_time_limit_keeps_what_was_found() {
    let desk = Desk::new();
    desk.challenge("stribeck", 2, "c");
    let effects = "coulomb,viscous,offset,stribeck";
    let line = format!("identify c/recording.csv --effects {effects} -o m.json --time-limit 1e-3");
    let run = desk.aep(&line);
    assert!(run.done().contains("stopped early"), "{}", run.out);
    let run = desk.aep("compare c/recording.csv --model m.json --time-limit 1e-3 --json c.json");
    assert!(run.done().contains("stopped early") && desk.path("c.json").exists(), "{}", run.out);
    let line = "extend c/recording.csv --model m.json --add presliding -o b.json --time-limit 1e-3";
    assert!(desk.aep(line).done().contains("stopped early") && desk.path("b.json").exists());
}

#[cfg(unix)]
#[test]
fn after_ctrl_c_identify_saves_what_it_has() {
    let desk = Desk::new();
    desk.challenge("stribeck", 2, "c");
    // Many shapes, so that the search is still on when it is stopped.
    let effects = "coulomb,viscous,offset,stribeck,frictional-memory,presliding";
    let run =
        desk.interrupted(&format!("identify c/recording.csv --effects {effects} -o m.json"), 2.0);
    assert_eq!(run.code, Some(130), "{}{}", run.out, run.err);
    assert!(desk.path("m.json").exists() && run.out.contains("stopped early"), "{}", run.out);
}
