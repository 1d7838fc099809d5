//! The main job.

use crate::harness::{Desk, shared};

#[test]
fn without_data_the_example_is_solved_and_the_truth_pointed_at() {
    let desk = Desk::new();
    let run = desk.aep("discover --time-limit none --json out.json --html out.html -o model.json");
    for part in
        ["The data", "Where the base model fails", "Which effect", "The ladder", "truth.json"]
    {
        assert!(run.done().contains(part), "{part}");
    }
    let (json, page) = (desk.json("out.json"), desk.read("out.html"));
    let truth = include_str!("../../examples/hidden/truth.json");
    let truth: serde_json::Value = serde_json::from_str(truth).unwrap();
    let next =
        run.out.lines().map(str::trim).find(|line| line.starts_with("aep challenge --example"));
    desk.aep(next.unwrap().strip_prefix("aep ").unwrap()).done();
    assert_eq!(desk.json("example/truth.json"), truth);
    assert_eq!(
        desk.read("example/recording.csv").lines().next(),
        Some("time_s,force_N,position_m,reference_m")
    );
    assert_eq!(json["verdict"], "effects_found");
    assert_eq!(json["added"][0], truth["hidden"]);
    let error = |rung: usize| json["ladder"][rung]["error"]["force_rms_N"]["validation"].as_f64();
    let last = json["ladder"].as_array().unwrap().len() - 1;
    let floor = json["noise_floor"]["force_N"].as_f64().unwrap();
    assert!(error(last).unwrap() < 1.3 * floor && error(0).unwrap() > 3.0 * floor);
    assert!(page.contains(truth["hidden"].as_str().unwrap()));
    assert!(desk.read("model.json").contains(truth["hidden"].as_str().unwrap()));
}

#[test]
fn the_json_keeps_the_contract() {
    let desk = Desk::new();
    desk.aep("discover -q --time-limit none --json out.json --most-effects 1").done();
    let json = desk.json("out.json");
    for key in [
        "verdict",
        "added",
        "ladder",
        "ranking",
        "where",
        "ambiguous",
        "noise_floor",
        "seed",
        "wall_s",
    ] {
        assert!(json.get(key).is_some(), "{key}");
    }
    let rung = &json["ladder"][1];
    assert!(
        json["ladder"][0]["added"].as_array().unwrap().is_empty() && rung["added"][0].is_string()
    );
    let parameter = &rung["parameters"]["coulomb.F_C"];
    for key in ["value", "low", "high", "unit", "identifiable"] {
        assert!(parameter.get(key).is_some(), "{key}");
    }
    assert!(rung["error"]["force_relative"]["fit"].is_f64());
    assert!(rung["p_value"].is_f64());
    assert!(rung["budget"].is_f64() && rung["likelihood_gain"].is_f64());
    for key in ["expected", "base", "last", "complete"] {
        assert!(json["budget"].get(key).is_some(), "{key}");
    }
    for model in ["missing_force_base", "missing_force"] {
        for key in ["rms", "recorded", "share", "band", "known"] {
            assert!(json[model][key].is_f64(), "{model}.{key}");
        }
        for key in ["time", "force", "half_width"] {
            let length = json[model][key].as_array().unwrap().len();
            assert!((1000..=4000).contains(&length), "{model}.{key}: {length}");
        }
    }
    let missing = |model: &str| json[model]["rms"].as_f64().unwrap();
    assert!(missing("missing_force") < 0.1 * missing("missing_force_base"));
    for key in ["rung", "candidate", "compared_with", "difference", "standard_error", "outcome"] {
        assert!(json["decisions"][0].get(key).is_some_and(|value| !value.is_null()), "{key}");
    }
    for candidate in json["ranking"].as_array().unwrap().iter().flat_map(|r| r.as_array().unwrap())
    {
        assert!(candidate["gain"].is_f64() && candidate["p_value"].is_f64(), "{candidate}");
        assert!(candidate["nats"].is_f64(), "{candidate}");
    }
    for key in ["effect", "gain", "p_value", "nats"] {
        assert!(json["ranking"][0][0].get(key).is_some(), "{key}");
    }
    for key in ["coordinate", "share", "p_value", "unit", "error_unit", "pattern"] {
        assert!(json["where"][0].get(key).is_some(), "{key}");
    }
    assert!(json.get("plots").is_none());
}

#[test]
fn a_bandwidth_shows_another_error_of_the_force_and_decides_nothing() {
    let desk = Desk::new();
    for flag in ["", "--bandwidth 8"] {
        let name = if flag.is_empty() { "own" } else { "narrow" };
        desk.aep(&format!("discover -q --time-limit none --json {name}.json {flag}")).done();
    }
    let [own, narrow] = ["own.json", "narrow.json"].map(|name| desk.json(name));
    for key in ["verdict", "added", "budget", "decisions"] {
        assert_eq!(own[key], narrow[key], "{key}");
    }
    let force =
        |json: &serde_json::Value| json["ladder"][0]["error"]["force_relative"]["fit"].as_f64();
    assert!((force(&own).unwrap() / force(&narrow).unwrap() - 1.0).abs() > 0.02);
}

#[test]
fn where_nothing_is_hidden_nothing_is_found() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let run = desk.aep("discover c/recording.csv --time-limit none --json out.json");
    assert!(run.done().contains("NOTHING IS MISSING"));
    let json = desk.json("out.json");
    assert_eq!(json["verdict"], "nothing_missing");
    // What size of each effect would have been seen.
    assert!(run.out.contains("would have been found above"));
    assert_eq!(json["detection_limits"]["stribeck"]["parameter"], "dF");
}

#[test]
fn a_search_without_time_names_nothing_and_says_what_was_not_tried() {
    let desk = Desk::new();
    let run = desk.aep("discover --time-limit 0.000001 --json out.json");
    let said = run.done();
    assert!(said.contains("STOPPED BEFORE ANYTHING WAS CERTAIN"), "{said}");
    assert!(said.contains("Not tried: ") && !said.contains("MISSING EFFECT"), "{said}");
    let json = desk.json("out.json");
    assert_eq!(json["verdict"], "stopped");
    assert_eq!(json["ladder"].as_array().unwrap().len(), 1);
    assert_eq!(json["stopped"], true);
}

#[cfg(unix)]
#[test]
fn after_ctrl_c_discover_tells_what_it_has() {
    let desk = Desk::new();
    // Stopped while it searches: what comes after the search takes time too.
    let line = "discover --time-limit none --better 1 --beam 9 --most-effects 9 --threads 1 --json out.json";
    let searching = |_: &_| desk.json("out.json")["stopped"] == true;
    let run = desk.interrupted_where(line, 3.0, searching);
    assert_eq!(run.code, Some(130), "{}{}", run.out, run.err);
    assert!(run.out.contains("The ladder"), "{}", run.out);
    assert!(!run.out.contains("MISSING EFFECT"), "{}", run.out);
    assert_eq!(desk.json("out.json")["stopped"], true);
}

#[test]
fn every_comparison_is_explained_where_that_is_asked() {
    let desk = Desk::new();
    let line = "discover --time-limit none --most-effects 1 --html out.html";
    let brief = desk.aep(line);
    assert!(brief.done().contains("--explain shows them"), "{}", brief.out);
    assert!(!brief.out.contains("What was compared"), "{}", brief.out);
    let run = desk.aep(&format!("{line} --explain --better 50"));
    for part in ["What was compared", "Sets of 1 effect", "base model", "needed", "> +50", "added"]
    {
        assert!(run.done().contains(part), "'{part}' is not in\n{}", run.out);
    }
    assert!(!run.out.contains("--explain shows them"), "{}", run.out);
    let page = desk.read("out.html");
    assert!(page.contains("What was compared") && page.contains("&gt; +50"));
    // A table that nobody watches fits a line of 100 characters.
    let from = run.out.find("The ladder").unwrap();
    for line in run.out[from..].lines().take_while(|line| !line.starts_with("MISSING")) {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn what_every_drive_has_is_named_before_what_varies_it() {
    let desk = Desk::new();
    // Without a friction level a drift of it gains more than the level.
    for (base, names) in
        [("viscous,offset", "stribeck, coulomb"), ("offset", "viscous, coulomb, stribeck")]
    {
        let run = desk.aep(&format!("discover --base {base} --time-limit none --json out.json"));
        // A drift without end is the level, and no alternative to it.
        let told = format!("MISSING EFFECTS FOUND: {names}\n");
        assert!(run.done().contains(&told), "{}", run.out);
    }
}

#[test]
fn a_threshold_that_nothing_reaches_adds_nothing_and_says_so() {
    let desk = Desk::new();
    let run = desk.aep("discover --time-limit none --most-effects 1 --better 1e9 --json out.json");
    assert!(run.done().contains("nothing is added"), "{}", run.out);
    assert!(run.out.contains("Why: the best refused, "), "{}", run.out);
    assert!(run.out.contains("1000000000 are needed"), "{}", run.out);
    assert_eq!(desk.json("out.json")["added"].as_array().unwrap().len(), 0);
}

#[test]
fn flags_read_other_columns_units_and_gains() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let csv = desk.read("c/recording.csv");
    let mut lines = csv.lines();
    lines.next();
    let rows: Vec<String> = lines
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{};{};{}", cells[0] * 1e3, cells[1] / 35.15, cells[2] * 1e3)
        })
        .collect();
    desk.write("volts.csv", format!("t;u_V;x\n{}\n", rows.join("\n")));
    let flags =
        "--time-unit ms --force u_V --force-gain 35.15 --position-unit mm --hold zero-order";
    desk.aep(&format!("identify volts.csv -q --effects coulomb --json flags.json {flags}")).done();
    desk.aep("identify c/recording.csv -q --effects coulomb --json plain.json").done();
    let mass =
        |name: &str| desk.json(name)["ladder"][0]["parameters"]["mass"]["value"].as_f64().unwrap();
    assert!((mass("flags.json") / mass("plain.json") - 1.0).abs() < 1e-6);
}

#[test]
fn the_published_axis_gives_the_published_error_and_the_known_asymmetry() {
    let Some(data) = shared("emps/DATA_EMPS.mat") else { return };
    let desk = Desk::new();
    let run = desk.aep(&format!(
        "discover {} --hold sampled --time-limit none --json out.json",
        data.display()
    ));
    assert!(run.done().contains("recognised as EMPS"));
    let json = desk.json("out.json");
    assert!(json["added"].as_array().unwrap().contains(&"asymmetry".into()), "{}", json["added"]);
    let error =
        |rung: &serde_json::Value| rung["error"]["force_relative"]["validation"].as_f64().unwrap();
    let ladder = json["ladder"].as_array().unwrap();
    let (base, last) = (error(&ladder[0]), error(ladder.last().unwrap()));
    assert!((base - 0.0408).abs() < 0.0015, "{base}");
    assert!(last < 0.026, "{last}");
}

#[test]
fn an_experiment_is_a_motion_that_the_axis_can_follow() {
    let desk = Desk::new();
    desk.challenge("stribeck", 1, "c");
    desk.aep("identify c/recording.csv -q --effects coulomb,viscous,offset -o base.json").done();
    let run = desk.aep(
        "suggest c/recording.csv --time-limit none --model base.json --experiment next.csv --json out.json --seed 3",
    );
    assert!(run.done().contains("An experiment to tell stribeck"), "{}", run.out);
    let experiment = &desk.json("out.json")["experiment"];
    assert_eq!(experiment["effects"][0], "stribeck");
    assert!(experiment["predicted"]["deviations"].as_f64().unwrap() > 0.0);
    let csv = desk.read("next.csv");
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("time_s,position_m"));
    let rows = lines.count() as f64;
    assert!((rows * 1e-3 - experiment["duration_s"].as_f64().unwrap()).abs() < 2e-3);
}

#[test]
fn where_nothing_is_ambiguous_no_experiment_is_written() {
    let desk = Desk::new();
    let run = desk.aep("discover --time-limit none --experiment next.csv --json out.json");
    assert!(run.done().contains("No experiment is written"));
    assert!(!desk.path("next.csv").exists());
    assert!(desk.json("out.json")["experiment"].is_null());
}

#[test]
fn surrogates_of_a_recording_hold_nothing_to_find() {
    let desk = Desk::new();
    let run = desk
        .aep("discover --time-limit none --surrogates 2 --json out.json --html out.html")
        .done()
        .to_owned();
    assert!(run.contains("0 of 2 surrogates were given a name"), "{run}");
    assert!(desk.read("out.html").contains("0 of 2 surrogates were given a name"));
    let surrogates = &desk.json("out.json")["surrogates"];
    assert_eq!(surrogates["asked"].as_u64(), Some(2));
    assert_eq!(
        (surrogates["count"].as_u64(), surrogates["named"].as_array()),
        (Some(2), Some(&vec![]))
    );
}

/// Files of the XL330 recorded at one gain, as words of a command.
fn servo(gain: &str) -> Option<String> {
    let runs = ["lift_and_drop", "sin_sin", "sin_time_square", "up_and_down"];
    let path = |run: &str| shared(&format!("xl330/xl330_{gain}_{run}.csv"));
    let paths = runs.map(|run| path(run).map(|path| path.display().to_string()));
    let paths: Option<Vec<String>> = paths.into_iter().collect();
    Some(paths?.join(" "))
}

#[test]
fn a_servo_lacks_load_friction_at_one_gain_and_the_other_gain_confirms_it() {
    for (gain, other) in [("kp100", "kp400"), ("kp400", "kp100")] {
        let (Some(data), Some(others)) = (servo(gain), servo(other)) else { return };
        let desk = Desk::new();
        let run = desk.aep(&format!(
            "discover {data} --force duty*v_in_V --base coulomb,viscous,gravity-pendulum \
             --time-limit none --validate {others} --json out.json --html out.html"
        ));
        assert!(run.done().contains("switched off"));
        for said in [run.out.clone(), desk.read("out.html")] {
            assert!(said.contains("load-friction is confirmed"));
        }
        let json = desk.json("out.json");
        assert_eq!(json["added"][0], "load-friction");
        let ranking = json["ranking"][0].as_array().unwrap();
        // What the margin does not tell apart stands beside it.
        assert!(ranking.iter().take(5).any(|row| row["effect"] == "load-friction"));
        let rungs = &json["confirmation"]["rungs"];
        let error = |rung: usize| rungs[rung]["error"]["torque_relative"].as_f64().unwrap();
        // Parameters of the one gain on the other; viscous friction may be that of the recording, with or without the effect.
        assert!(error(1) < 0.96 * error(0), "{gain}: {} {}", error(0), error(1));
        assert_eq!(rungs[1]["holds"], true);
        assert!(rungs[1]["p_value"].as_f64().unwrap() <= 0.05);
    }
}

#[test]
fn a_dent_in_the_way_is_no_effect_of_the_library_and_can_be_added_as_a_generic_term() {
    let desk = Desk::new();
    desk.challenge("nothing", 3, "c");
    let recorded = desk.read("c/recording.csv");
    let mut lines = recorded.lines();
    let header = lines.next().unwrap();
    assert!(header.starts_with("time_s,force_N,position_m"), "{header}");
    let dented = |line: &str| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        let number = |k: usize| fields[k].parse::<f64>().unwrap();
        let dent = 8.0 * (-((number(2) - 0.0331) / 0.0015).powi(2)).exp();
        fields[1] = (number(1) + dent).to_string();
        fields.join(",")
    };
    let rows: Vec<String> = lines.map(dented).collect();
    desk.write("dent.csv", format!("{header}\n{}\n", rows.join("\n")));
    desk.write("dent.toml", desk.read("c/recording.toml"));
    desk.aep("discover dent.csv --time-limit none --json d.json -o m.json").done();
    let found = desk.json("d.json");
    assert_eq!(found["verdict"], "unexplained");
    assert_eq!(found["added"].as_array().unwrap().len(), 0, "{}", found["added"]);
    assert_eq!(found["where"][0]["coordinate"], "position");
    desk.write("term.toml", found["generic_term"].as_str().unwrap());
    let line = "extend dent.csv --model m.json --add local -o better.json --json e.json";
    desk.aep(&format!("{line} --effects-file term.toml")).done();
    let rung = &desk.json("e.json")["ladder"][1];
    for (name, truth) in [("local.a", 8.0), ("local.c", 0.0331), ("local.w", 0.0015)] {
        let value = rung["parameters"][name]["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.05, "{name} {value}");
    }
}
