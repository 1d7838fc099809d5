//! Recordings in pieces: several files, and a drive that is switched off in between.

use std::path::PathBuf;

use aep_data::{Mapping, Problem, read, read_all};
use missing_physics::RecordingError;

/// A folder with files of these contents, and their paths.
fn files(texts: &[String]) -> (tempfile::TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let write = |(k, text): (usize, &String)| {
        let path = folder.path().join(format!("run{k}.csv"));
        std::fs::write(&path, text).unwrap();
        path
    };
    let paths = texts.iter().enumerate().map(write).collect();
    (folder, paths)
}

/// 60 rows, the drive switched off in `off`.
fn run(header: &str, interval: f64, off: std::ops::Range<u32>) -> String {
    let row = |k: u32| {
        format!("{},{k},{},{}", interval * f64::from(k), 2 * k, u8::from(!off.contains(&k)))
    };
    format!("{header}\n{}\n", (0..60).map(row).collect::<Vec<_>>().join("\n"))
}

const HEADER: &str = "time_s,force_N,position_m,enabled";

#[test]
fn samples_without_drive_are_left_out_and_end_a_piece() {
    let (_folder, paths) = files(&[run(HEADER, 1e-3, 20..30)]);
    let loaded = read(&paths[0], &Mapping::default()).unwrap();
    assert_eq!(loaded.switched_off, 10);
    assert_eq!(loaded.recording.segments(), &[0..20, 20..50]);
    assert_eq!(loaded.recording.require("force").unwrap()[20], 30.0);
}

#[test]
fn a_drive_that_is_never_on_is_refused() {
    let (_folder, paths) = files(&[run(HEADER, 1e-3, 0..60)]);
    let error = read(&paths[0], &Mapping::default()).unwrap_err();
    assert!(matches!(
        *error.problem,
        Problem::Recording(RecordingError::TooShort { samples: 0, .. })
    ));
}

#[test]
fn several_files_are_pieces_of_one_recording() {
    let (_folder, paths) =
        files(&[run(HEADER, 1e-3, 50..60), run(HEADER, 1e-3, 60..60), run(HEADER, 1e-3, 10..20)]);
    let all = read_all(&paths, &Mapping::default()).unwrap();
    assert_eq!(all.recording.segments(), &[0..50, 50..110, 110..120, 120..160]);
    assert_eq!(all.switched_off, 20);
    assert_eq!(all.recording.name(), "run0.csv, run1.csv, run2.csv");
    assert_eq!(all.recording.require("force").unwrap()[50], 0.0);
}

#[test]
fn a_channel_that_one_file_lacks_is_left_out() {
    let other = HEADER.replace("enabled", "velocity_m_s");
    let (_folder, paths) = files(&[run(&other, 1e-3, 0..0), run(HEADER, 1e-3, 0..0)]);
    let all = read_all(&paths, &Mapping::default()).unwrap();
    assert!(all.recording.channel("velocity").is_none());
    assert!(all.origins.iter().all(|origin| origin.channel != "velocity"));
}

#[test]
fn files_that_do_not_belong_together_are_refused_with_the_one_that_differs() {
    let rotary = "time_s,torque_Nm,angle_rad,enabled";
    for (other, what) in [(run(rotary, 1e-3, 0..0), "force"), (run(HEADER, 0.1, 0..0), "sampling")]
    {
        let (_folder, paths) = files(&[run(HEADER, 1e-3, 0..0), other]);
        let error = read_all(&paths, &Mapping::default()).unwrap_err();
        assert_eq!(error.path, paths[1]);
        assert!(error.to_string().contains(what) && error.hint().is_some(), "{error}");
    }
}
