//! Every way a file can be wrong: the error says what, where, and how to mend it.

use std::path::Path;

use aep_data::{DataError, Mapping, Problem, Source, parse};

fn csv(text: &str) -> DataError {
    mapped(text, &Mapping::default())
}

fn mapped(text: &str, mapping: &Mapping) -> DataError {
    parse(Path::new("run.csv"), text.as_bytes().to_vec(), mapping).unwrap_err()
}

/// A good recording of 20 samples with one line replaced; line 1 is the header.
fn with_line(line: usize, text: &str) -> String {
    let mut lines = vec!["time_s,force_N,position_m".to_owned()];
    lines.extend((0..20).map(|k| format!("{},1.5,{}", f64::from(k) * 0.001, f64::from(k) * 0.01)));
    text.clone_into(&mut lines[line - 1]);
    lines.join("\n")
}

/// What, where and how to mend it, as the command line prints it.
fn report(error: &DataError) -> String {
    format!("{} | {} | {}", error.problem, error.place(), error.hint().unwrap_or_default())
}

#[track_caller]
fn assert_says(error: &DataError, parts: &[&str]) {
    let report = report(error);
    for part in parts {
        assert!(report.contains(part), "'{part}' is not in: {report}");
    }
}

#[test]
fn a_missing_column_names_those_present_the_nearest_and_the_flag() {
    let error = csv(&with_line(1, "time_s,motor_forse,position_m"));
    assert_says(
        &error,
        &["force", "time_s, motor_forse, position_m", "--force", "run.toml", "force = \""],
    );
    assert_says(&error, &["did you mean 'motor_forse'?"]);
}

#[test]
fn a_column_that_was_asked_for_and_is_not_there_is_named() {
    let mapping = Mapping { position: Source::column("positon_m"), ..Mapping::default() };
    let error = mapped(&with_line(1, "time_s,force_N,position_m"), &mapping);
    assert_says(&error, &["'positon_m'", "did you mean 'position_m'?", "--position position_m"]);
}

#[test]
fn text_in_place_of_a_number_names_line_column_and_value() {
    let error = csv(&with_line(5, "0.003,1.2.3,0.1"));
    let place = "run.csv, line 5, column 'force_N'";
    assert_says(&error, &["'1.2.3'", place, "delete the row"]);
    // Also where rows before it are left out.
    let text = with_line(5, "0.003,1.2.3,0.1").replace("0.001,1.5", "0.001,nan");
    assert_says(&csv(&text), &["'1.2.3'", place]);
}

#[test]
fn rows_without_a_number_or_with_the_time_before_are_left_out_and_counted() {
    for row in ["0.003,nan,0.1", "0.003,,0.1", "0.003,-inf,0.1", "nan,1.5,0.1", "0.003,null,0.1"] {
        let loaded =
            parse(Path::new("run.csv"), with_line(5, row).into_bytes(), &Mapping::default());
        let loaded = loaded.unwrap();
        assert_eq!((loaded.left_out.missing, loaded.left_out.repeated), (1, 0), "{row}");
        assert_eq!(loaded.recording.len(), 19);
        assert!(!loaded.recording.time().contains(&0.003), "{row}");
    }
    let text = with_line(6, "0.003,1.5,0.1").into_bytes();
    let loaded = parse(Path::new("run.csv"), text, &Mapping::default()).unwrap();
    assert_eq!((loaded.left_out.missing, loaded.left_out.repeated), (0, 1));
    // The row that came first stays.
    assert_eq!(loaded.recording.require("position").unwrap()[3], 0.03);
}

#[test]
fn more_than_a_quarter_of_the_rows_is_too_much_to_leave_out() {
    let rows = |of: &dyn Fn(u32) -> String| {
        let all: Vec<String> = (0..40).map(of).collect();
        format!("time_s,force_N,position_m\n{}\n", all.join("\n"))
    };
    let force = |k: u32| if k % 3 == 1 { "" } else { "1.5" };
    let error = csv(&rows(&|k| format!("{},{},0.1", f64::from(k) * 0.001, force(k))));
    assert_says(&error, &["13 of 40 rows have no number", "line 3, column 'force_N'", "--from"]);
    let error = csv(&rows(&|k| format!("{},1.5,0.1", f64::from(k / 2) * 0.001)));
    assert_says(&error, &["20 of 40 rows have the time of the row before", "--interval"]);
    // What nobody asked for is not used then.
    let text = rows(&|k| format!("{},1.5,0.1,{}", f64::from(k) * 0.001, force(k)));
    let text = text.replace("position_m\n", "position_m,temperature_C\n");
    let loaded = parse(Path::new("run.csv"), text.into_bytes(), &Mapping::default()).unwrap();
    assert_eq!(loaded.unused, ["temperature_C"]);
    assert_eq!(loaded.recording.len(), 40);
}

#[test]
fn a_velocity_is_no_position() {
    let error = csv(&with_line(1, "time_s,force_N,velocity_m_s"));
    assert_says(&error, &["there is a velocity ('velocity_m_s'), but no position", "drifts"]);
}

#[test]
fn lines_are_counted_with_comments_and_blank_lines() {
    let text = format!("# made by hand\n\n{}", with_line(5, "0.003,abc,0.1"));
    assert_eq!(csv(&text).line, Some(7));
}

#[test]
fn time_that_runs_backwards_names_the_line() {
    let error = csv(&with_line(9, "0.0001,1.5,0.1"));
    assert_says(&error, &["0.006 s to 0.0001 s", "line 9, column 'time_s'", "segment"]);
}

#[test]
fn empty_and_header_only_files_are_told_apart() {
    assert_eq!(*csv("").problem, Problem::Empty);
    assert_eq!(*csv(" \n\n").problem, Problem::Empty);
    assert_eq!(*csv("# only a comment\n").problem, Problem::Empty);
    assert_eq!(*csv("time_s,force_N,position_m\n").problem, Problem::HeaderOnly);
    assert_says(&csv(""), &["empty", "time_s,force_N,position_m"]);
}

#[test]
fn ragged_rows_name_the_line() {
    assert_says(&csv(&with_line(4, "0.002,1.5")), &["2 fields", "3", "line 4"]);
    assert_says(&csv(&with_line(4, "0,002,1,5,0")), &["5 fields", "decimal commas"]);
}

#[test]
fn a_header_without_names_or_with_one_twice_is_refused() {
    assert!(matches!(*csv("0,1,2\n0.1,1,2\n").problem, Problem::NoHeader { columns: 3 }));
    assert_says(&csv("time_s,force_N,force_N\n0,1,2\n"), &["'force_N' twice", "line 1"]);
}

#[test]
fn units_that_are_unknown_wrong_or_need_a_gain() {
    let error = csv(&with_line(1, "time_s,force [furlong],position_m"));
    assert_says(&error, &["'furlong'", "mN", "--force-unit"]);
    let error = csv(&with_line(1, "time_s,force_KN,position_m"));
    assert_says(&error, &["'KN'", "did you mean kN?", "--force force_KN --force-unit kN"]);
    let counts = Mapping { force: Source::column("u_counts"), ..Mapping::default() };
    let error = mapped(&with_line(1, "time_s,u_counts,position_m"), &counts);
    assert_says(&error, &["in counts", "--force-gain"]);
    let volts = Mapping { position: Source::column("u_V"), ..Mapping::default() };
    let error = mapped(&with_line(1, "time_s,force_N,u_V"), &volts);
    assert_says(&error, &["in V", "--position-gain"]);
    let metres = Mapping { force: Source::column("position_m"), ..Mapping::default() };
    let error = mapped(&with_line(1, "time_s,u_V,position_m"), &metres);
    assert_says(&error, &["'m' is no unit of a force"]);
}

#[test]
fn values_out_of_all_reason_are_refused() {
    let error = csv(&with_line(5, "0.003,1e300,0.1"));
    assert_says(&error, &["a force of 1.00e300 N", "line 5, column 'force_N'", "--force-unit"]);
    let days =
        Mapping { time: Source { gain: Some(1e6), ..Source::default() }, ..Mapping::default() };
    let error = mapped(&with_line(5, "0.003,1.5,0.03"), &days);
    assert_says(&error, &["one sample every", "--time-unit ms"]);
}

#[test]
fn linear_and_rotary_do_not_mix() {
    let error = csv(&with_line(1, "time_s,force_N,angle_rad"));
    assert_says(&error, &["'force_N' in N is linear", "'angle_rad' in rad is rotary"]);
}

#[test]
fn segments_are_whole_numbers_and_gains_are_not_zero() {
    let text = with_line(3, "0.001,1.5,0.5").replace("position_m", "segment,position_m");
    let text = text.replace(",1.5,", ",1.5,0,").replace("0.001,1.5,0,", "0.001,1.5,0.5,");
    assert_says(&csv(&text), &["segment 0.5", "line 3"]);
    let zero = Source { gain: Some(0.0), ..Source::default() };
    let mapping = Mapping { force: zero, ..Mapping::default() };
    assert_says(&mapped(&with_line(2, "0,1,2"), &mapping), &["gain of the force", "not zero"]);
}

#[test]
fn too_few_samples_are_no_recording() {
    assert_says(&csv("time_s,force_N,position_m\n0,1,2\n"), &["1 samples", "16"]);
}

#[test]
fn other_files_are_recognised() {
    let bytes = |bytes: &[u8], name: &str| {
        parse(Path::new(name), bytes.to_vec(), &Mapping::default()).unwrap_err()
    };
    assert_says(&bytes(b"\xff\xfet\0i", "run.csv"), &["UTF-16", "UTF-8"]);
    assert_says(&bytes(b"PK\x03\x04....", "run.xlsx"), &["spreadsheet"]);
    assert_says(&bytes(b"time,force", "run.mat"), &["not a MATLAB v5 file", "'-v7'"]);
    assert_says(&bytes(b"\x89HDF\r\n\x1a\n....", "run.mat"), &["the HDF5 file cannot be read"]);
}

#[test]
fn a_missing_file_and_a_directory_are_told() {
    let error = aep_data::load(Path::new("/no/such.csv"), &Mapping::default()).unwrap_err();
    assert_eq!(*error.problem, Problem::Absent);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.csv"), "x").unwrap();
    let error = aep_data::load(folder.path(), &Mapping::default()).unwrap_err();
    assert_says(&error, &["directory", "a.csv"]);
}

#[test]
fn a_mapping_beside_the_data_that_is_wrong_names_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, with_line(2, "0,1,2")).unwrap();
    std::fs::write(folder.path().join("run.toml"), "hold = \"sampled\"\nforce = 3\n").unwrap();
    let error = aep_data::load(&path, &Mapping::default()).unwrap_err();
    assert_says(&error, &["run.toml, line 2", "the name of a column"]);
}
