//! Files are written completely or not at all.

use crate::harness::Desk;

#[test]
fn a_file_that_cannot_be_written_is_named_and_nothing_is_destroyed() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    desk.aep("identify c/recording.csv -q --effects coulomb --json nowhere/out.json").refused(&[
        "error: cannot write the file",
        "  nowhere/out.json",
        "hint: ",
    ]);
    desk.aep("identify c/recording.csv -q --effects coulomb -o c")
        .refused(&["it is a directory", "  c"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_not_half_a_file() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    // A device that is always full.
    desk.aep("identify c/recording.csv -q --effects coulomb --json /dev/full")
        .refused(&["error: cannot write the file", "/dev/full"]);
}

#[test]
fn quiet_prints_nothing_and_writes_all_the_same() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let run = desk.aep("identify c/recording.csv -q --effects coulomb,viscous -o model.json");
    assert_eq!(run.done(), "");
    assert_eq!(run.err, "");
    assert!(desk.read("model.json").contains("viscous"));
}

#[test]
fn json_on_standard_output_is_alone_there() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let run = desk.aep("identify c/recording.csv --effects coulomb --json -");
    let json: serde_json::Value = serde_json::from_str(run.done()).unwrap();
    assert_eq!(json["effects"][0], "coulomb");
}

#[test]
fn the_same_challenge_is_the_same_file() {
    let desk = Desk::new();
    desk.challenge("stribeck", 5, "a");
    desk.challenge("stribeck", 5, "b");
    assert_eq!(desk.read("a/recording.csv"), desk.read("b/recording.csv"));
    assert_eq!(desk.json("a/truth.json")["hidden"], "stribeck");
    assert!(desk.read("a/recording.toml").contains("zero-order"));
}
