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
fn rows_without_a_number_and_repeated_times_are_left_out_and_told() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let text = desk.read("c/recording.csv");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let with = |line: &str, column: usize, value: &str| {
        let mut fields: Vec<&str> = line.split(',').collect();
        fields[column] = value;
        fields.join(",")
    };
    lines[500] = with(&lines[500], 1, "NaN");
    lines[700] = with(&lines[700], 2, "");
    let before = lines[899].split(',').next().unwrap().to_owned();
    lines[900] = with(&lines[900], 0, &before);
    desk.write("holes.csv", lines.join("\n"));
    let line = "holes.csv --hold zero-order --time-limit none --json d.json";
    let run = desk.aep(&format!("discover {line}"));
    let told = "left out: 2 rows without a number in a column that is used, 1 row with the time";
    assert!(run.done().contains(told), "{}", run.out);
    let json = desk.json("d.json");
    assert_eq!(json["data"]["rows_left_out"]["without_number"], 2);
    assert_eq!(json["data"]["rows_left_out"]["time_repeated"], 1);
    assert_eq!(json["verdict"], "nothing_missing");
}

#[test]
fn a_part_of_a_recording_by_time_and_every_few_samples() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let identify = |part: &str| {
        let line = format!("identify c/recording.csv --effects coulomb,viscous,offset {part}");
        desk.aep(&format!("{line} --series s.csv")).done();
        let text = desk.read("s.csv");
        let times = text.lines().skip(1).map(|line| line.split(',').next().unwrap().to_owned());
        times.map(|time| time.parse().unwrap()).collect::<Vec<f64>>()
    };
    let all = identify("");
    let part = identify("--from 2 --to 9.5");
    assert_eq!((part[0], part[part.len() - 1]), (2.0, 9.5));
    assert_eq!(part.len(), 7501);
    let every = identify("--from 2 --to 9.5 --every 5");
    assert_eq!((every.len(), every[1]), (1501, 2.005));
    assert!(all.len() > part.len());
    // Printed commands repeat the part.
    let run = desk.aep("suggest c/recording.csv --from 2 --to 9.5 --model-force force_N*1.01");
    assert!(!run.out.contains("--add") || run.out.contains("--from 2 --to 9.5"), "{}", run.out);
    desk.aep("identify c/recording.csv --effects coulomb --from 900")
        .refused(&["leave too little", "the file goes from 0 s to"]);
    desk.aep("identify c/recording.csv --effects coulomb --every 0").refused(&["--every"]);
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
