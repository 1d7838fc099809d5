//! Everything that can be wrong with what a user gives: exit code 2, what, where, how to mend it.

use crate::harness::{Desk, repository};

/// 30 samples of a motion with one line replaced; line 1 is the header.
fn recording(line: usize, text: &str) -> String {
    let mut lines = vec!["time_s,force_N,position_m".to_owned()];
    lines.extend((0..30).map(|k| {
        let t = f64::from(k) * 0.01;
        format!("{t},{},{}", (20.0 * t).cos(), 0.1 * (20.0 * t).sin())
    }));
    text.clone_into(&mut lines[line - 1]);
    lines.join("\n") + "\n"
}

#[test]
fn a_missing_column_is_named_with_those_present_and_the_flag() {
    let desk = Desk::new();
    desk.write("run.csv", recording(1, "time_s,current_A,position_m"));
    desk.aep("discover run.csv").refused(&[
        "error: no column for the force; the file has: time_s, current_A, position_m",
        "  run.csv",
        "hint: name it with --force NAME, or in run.toml: force = \"NAME\"",
    ]);
}

#[test]
fn an_ampere_is_no_newton_without_a_gain() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let text = desk.read("c/recording.csv").replace("force_N", "current_A");
    desk.write("run.csv", &text);
    let data = "run.csv --force current_A --hold zero-order";
    let line = format!("identify {data} --effects coulomb,viscous,offset");
    let run = desk.aep(&format!("{line} -o m.json --json i.json --html i.html --series s.csv"));
    for unit in ["A s^2/m", "A s/m", "current error", "friction level forwards"] {
        assert!(run.done().contains(unit), "{unit} is not in {}", run.out);
    }
    let json = desk.json("i.json");
    assert!(json["error"]["current_rms_A"].is_object(), "{}", json["error"]);
    for text in [run.out.as_str(), &json["parameters"].to_string(), &json["friction"].to_string()] {
        for unit in [" N ", " N\n", "\"N\"", "\"N s/m\"", "\"kg\"", " kg "] {
            assert!(!text.contains(unit), "'{unit}' is in {text}");
        }
    }
    assert!(desk.read("s.csv").lines().next().unwrap().contains("model.residual_current_A"));
    // The model stays in A, and says so where it does not belong.
    assert_eq!(desk.json("m.json")["effort"], "A");
    desk.aep(&format!("compare {data} --model m.json")).done();
    desk.aep("compare c/recording.csv --model m.json").refused(&["in A", "in N", "--force-gain"]);
    desk.aep("simulate --model m.json --input c/recording.csv -o o.csv").refused(&["in A"]);
    desk.aep("control --model m.json --reference sine:5mm,0.5Hz").refused(&["commands a force"]);
    desk.aep(&format!("simulate --model m.json --input {data} -o o.csv")).done();
    assert!(desk.read("o.csv").starts_with("time_s,force_A,"));
}

#[test]
fn text_in_place_of_a_number_is_named_with_line_and_column() {
    let desk = Desk::new();
    desk.write("run.csv", recording(7, "0.05,1.2.3,0.1"));
    desk.aep("discover run.csv").refused(&[
        "error: '1.2.3' is not a number",
        "  run.csv, line 7, column 'force_N'",
        "hint: ",
    ]);
}

#[test]
fn time_that_runs_backwards_is_named_with_its_line() {
    let desk = Desk::new();
    desk.write("run.csv", recording(7, "0.01,1.0,0.1"));
    desk.aep("discover run.csv").refused(&[
        "error: time goes from 0.04 s to 0.01 s: it must increase",
        "  run.csv, line 7, column 'time_s'",
        "segment",
    ]);
}

#[test]
fn an_empty_file_and_no_file() {
    let desk = Desk::new();
    desk.write("run.csv", "");
    desk.aep("discover run.csv").refused(&["error: the file is empty", "time_s,force_N"]);
    desk.aep("discover nowhere.csv").refused(&["there is no such file", "  nowhere.csv"]);
    desk.aep("discover .").refused(&["this is a directory", "run.csv"]);
}

#[test]
fn an_unknown_effect_is_named_with_the_nearest_and_all() {
    let desk = Desk::new();
    desk.write("run.csv", recording(2, "0,1,0"));
    for line in [
        "discover run.csv --base coulomb,stribek",
        "discover run.csv --exclude stribek",
        "identify run.csv --effects coulomb,stribek",
        "effects stribek",
        "challenge --hide stribek -o made",
    ] {
        desk.aep(line).refused(&[
            "error: unknown effect 'stribek'; did you mean 'stribeck'?",
            "hint: known effects: coulomb, viscous, offset",
        ]);
    }
    assert!(!desk.path("made").exists());
}

#[test]
fn a_mat_file_without_the_variables_lists_those_it_has() {
    let desk = Desk::new();
    let Some(fixture) = repository("aep-data/tests/fixtures/mixed.mat") else { return };
    desk.write("run.mat", std::fs::read(fixture).unwrap());
    desk.aep("discover run.mat").refused(&[
        "error: no variable for the force; the file has: t (1x40), u (40x1), x (1x40)",
        "log.a (1x1), log.b (1x3), names (cell array)",
        "hint: name it with --force NAME",
    ]);
    desk.write("no.mat", "time_s,force_N\n");
    desk.aep("discover no.mat").refused(&["not a MATLAB v5 file", "-v7"]);
}

#[test]
fn too_little_motion_says_what_to_record() {
    let desk = Desk::new();
    desk.write("run.csv", recording(2, "0,1,0"));
    desk.aep("discover run.csv").refused(&["can be compared", "hint: record a motion"]);
}

#[test]
fn a_model_that_is_none_is_named() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    desk.write("model.json", "{\"axis\": \"linear\"}");
    let line = "compare c/recording.csv --model model.json";
    desk.aep(line).refused(&["error: not a model", "  model.json", "hint: a model looks like"]);
    desk.aep("compare c/recording.csv --model none.json").refused(&[
        "cannot read the model",
        "  none.json",
        "aep identify",
    ]);
}

#[test]
fn wrong_usage_is_refused_with_2() {
    let desk = Desk::new();
    desk.aep("").refused(&["Usage: aep"]);
    desk.aep("discovr").refused(&["discover"]);
    desk.aep("discover run.csv --alpha 2").refused(&["--alpha", "probability"]);
    desk.aep("discover run.csv --time-limit -3").refused(&["--time-limit", "'none'"]);
    desk.aep("discover run.csv --share 2").refused(&["--share", "a share from 0"]);
    desk.aep("discover run.csv --better -1").refused(&["--better", "above 0"]);
    desk.aep("discover run.csv --hold first-order").refused(&["zero-order"]);
    desk.aep("discover run.csv --threads 0").refused(&["--threads"]);
    desk.aep("identify run.csv --effects coulomb --algorithm simplex").refused(&["aep, meta-ep"]);
}
