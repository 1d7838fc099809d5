//! Several axes in one file.

use boon::{Compiler, Schemas};
use serde_json::Value;

use crate::harness::Desk;

/// Recordings of challenges side by side as joints of one machine: what is hidden in each, from joint 1 on.
fn machine(desk: &Desk, hidden: &[&str]) -> String {
    let mut joints: Vec<Vec<Vec<String>>> = Vec::new();
    for (k, hidden) in hidden.iter().enumerate() {
        let folder = format!("c{k}");
        desk.challenge(hidden, k as u64 + 1, &folder);
        let text = desk.read(&format!("{folder}/recording.csv"));
        let row = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<String>>();
        joints.push(text.lines().skip(1).map(row).collect());
    }
    let names = (1..=joints.len()).map(|k| format!(",force_{k}_N,position_{k}_m"));
    let row = |row: usize| {
        let own = joints.iter().map(|joint| format!(",{},{}", joint[row][1], joint[row][2]));
        format!("\n{}{}", joints[0][row][0], own.collect::<String>())
    };
    let rows: String = (0..joints[0].len()).map(row).collect();
    format!("time_s{}{rows}\n", names.collect::<String>())
}

#[track_caller]
fn checked(value: &Value) {
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    let place = |name: &str| format!("http://localhost/{name}.schema.json");
    let own = include_str!("../../schema/axes.schema.json");
    for (name, text) in [("axes", own), ("discovery", missing_physics::report::SCHEMA)] {
        compiler.add_resource(&place(name), serde_json::from_str(text).unwrap()).unwrap();
    }
    let index = compiler.compile(&place("axes"), &mut schemas).unwrap();
    schemas.validate(value, index).map_err(|error| format!("{error:#}")).unwrap();
}

#[test]
fn two_of_six_joints_hide_an_effect_and_the_others_are_silent() {
    let desk = Desk::new();
    let hidden = ["nothing", "stribeck", "nothing", "nothing", "ripple", "nothing"];
    desk.write("arm.csv", machine(&desk, &hidden));
    desk.write("arm.toml", "hold = \"zero-order\"\n");
    let line = "discover arm.csv --axes all --time-limit none --json a.json --html a.html";
    let run = desk.aep(&format!("{line} -o m_{{}}.json --series s_{{}}.csv"));
    assert!(run.done().contains("What each axis lacks"), "{}", run.out);
    let json = desk.json("a.json");
    checked(&json);
    for (k, (axis, hidden)) in json["axes"].as_array().unwrap().iter().zip(hidden).enumerate() {
        assert_eq!(axis["axis"], (k + 1).to_string());
        let added = axis["discovery"]["added"].as_array().unwrap();
        match hidden {
            "nothing" => assert!(added.is_empty(), "{added:?}"),
            hidden => {
                let name = added[0].as_str().unwrap();
                assert!(added.len() == 1 && name.starts_with(hidden), "{added:?}");
            }
        }
        assert!(desk.path(&format!("m_{}.json", k + 1)).exists());
        assert!(desk.path(&format!("s_{}.csv", k + 1)).exists());
    }
    // A page with every axis, each place on it once.
    let page = desk.read("a.html");
    for k in 1..=6 {
        assert_eq!(page.matches(&format!("<article id=\"axis-{k}\">")).count(), 1);
        assert_eq!(page.matches(&format!("id=\"axis-{k}-ladder\"")).count(), 1, "{k}");
    }
    // An axis by itself is the same to the bit.
    let line = "discover arm.csv --force force_2_N --position position_2_m --time-limit none";
    desk.aep(&format!("{line} --json b.json -q")).done();
    assert_eq!(desk.json("b.json")["ladder"], json["axes"][1]["discovery"]["ladder"]);
}

#[test]
fn some_axes_by_number_and_columns_of_another_as_regressor() {
    let desk = Desk::new();
    desk.write("arm.csv", machine(&desk, &["nothing", "stribeck"]));
    let line = "discover arm.csv --axes joint2 --hold zero-order --time-limit none --json a.json";
    let words = format!("{line} --regressor couple=force_1_N");
    let run = desk.aep(&words);
    assert!(run.done().contains("force_2_N"), "{}", run.out);
    let json = desk.json("a.json");
    assert_eq!(json["axes"].as_array().unwrap().len(), 1);
    let ranked = json["axes"][0]["discovery"]["ranking"].to_string();
    assert!(ranked.contains("couple"), "{ranked}");
}

#[test]
fn what_is_no_axis_is_told_with_what_was_looked_for() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    desk.aep("discover c/recording.csv --axes all").refused(&[
        "no axes found",
        "force_N",
        "tau_0 and q_0",
        "{} in place of the axis",
    ]);
    desk.write("arm.csv", machine(&desk, &["nothing", "nothing"]));
    desk.aep("discover arm.csv --axes 3").refused(&["no axis '3'", "1, 2"]);
    desk.aep("discover --axes all").refused(&["needs a file"]);
    desk.aep("discover arm.csv --axes all -o m.json").refused(&["several axes", "m_{}.json"]);
    let line = "discover arm.csv --axes all --surrogates 3";
    desk.aep(line).refused(&["--surrogates is for one axis"]);
    // The recordings that are to confirm it must have the same axes.
    desk.aep("discover arm.csv --axes all --validate c/recording.csv").refused(&["no axes found"]);
}

#[test]
fn other_recordings_confirm_each_axis_and_what_was_compared_is_told_of_each() {
    let desk = Desk::new();
    desk.write("arm.csv", machine(&desk, &["stribeck", "nothing"]));
    let line = "discover arm.csv --axes all --hold zero-order --most-effects 1 --time-limit none";
    let run = desk.aep(&format!("{line} --validate arm.csv --explain --json a.json"));
    for axis in [1, 2] {
        for part in [
            format!("What was compared: axis {axis}"),
            format!("axis {axis}, on other recordings: arm.csv"),
        ] {
            assert!(run.done().contains(&part), "'{part}' is not in\n{}", run.out);
        }
    }
    let json = desk.json("a.json");
    checked(&json);
    let confirmation = &json["axes"][0]["discovery"]["confirmation"];
    assert_eq!(confirmation["recording"], "arm.csv");
    // Confirmed on itself it holds.
    assert_eq!(confirmation["rungs"][1]["holds"], true, "{confirmation}");
}

#[cfg(unix)]
#[test]
fn after_ctrl_c_the_axes_that_are_done_are_kept() {
    let desk = Desk::new();
    desk.write("arm.csv", machine(&desk, &["stribeck", "ripple", "nothing", "nothing"]));
    let line = "discover arm.csv --threads 1 --axes all --hold zero-order --time-limit none";
    let run = desk.interrupted(&format!("{line} --json a.json"), 1.0);
    assert_eq!(run.code, Some(130), "{}{}", run.out, run.err);
    assert!(run.out.contains("not done"), "{}", run.out);
    let json = desk.json("a.json");
    checked(&json);
    assert_eq!(json["interrupted"], true);
    assert_eq!(json["axes"].as_array().unwrap().len(), 4);
}
