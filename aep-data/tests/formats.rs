//! The same recording in every format is the same to the bit.

use std::path::{Path, PathBuf};

use aep_data::{Mapping, Source, parse, read};
use missing_physics::Recording;
use proptest::prelude::*;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/formats").join(name)
}

fn bits(recording: &Recording) -> Vec<(String, Vec<u64>)> {
    let channel = |name: &str, values: &[f64]| {
        (name.to_owned(), values.iter().map(|value| value.to_bits()).collect())
    };
    let channels = recording.channels().iter().map(|c| channel(&c.name, &c.values));
    std::iter::once(channel("time", recording.time())).chain(channels).collect()
}

fn loaded(name: &str, mapping: &Mapping) -> Vec<(String, Vec<u64>)> {
    let loaded = read(&file(name), mapping).unwrap_or_else(|error| panic!("{name}: {error}"));
    bits(&loaded.recording)
}

#[test]
fn every_format_holds_the_same_numbers() {
    let csv = loaded("run.csv", &Mapping::default());
    assert_eq!(csv.len(), 3);
    for name in ["run.npz", "packed.npz", "run.parquet", "run.xlsx"] {
        assert_eq!(loaded(name, &Mapping::default()), csv, "{name}");
    }
}

#[test]
fn lists_of_a_data_frame_are_columns() {
    let mapping = Mapping {
        position: Source::column("observation.state_0"),
        force: Source::column("observation.state_1"),
        ..Mapping::default()
    };
    assert_eq!(loaded("lerobot.parquet", &mapping), loaded("run.csv", &Mapping::default()));
}

#[test]
fn a_preamble_a_row_of_units_and_utf_16_change_nothing() {
    let csv = std::fs::read_to_string(file("run.csv")).unwrap();
    let rows = csv.split_once('\n').unwrap().1;
    let written =
        format!("Recorder X\n2026-01-01 12:00\n\ntime,force,position\n[s],[N],[m]\n{rows}");
    let as_read = |bytes: Vec<u8>| {
        bits(&parse(Path::new("run.csv"), bytes, &Mapping::default()).unwrap().recording)
    };
    let plain = as_read(csv.clone().into_bytes());
    assert_eq!(as_read(written.clone().into_bytes()), plain);
    let wide = std::iter::once(0xfeff).chain(written.encode_utf16());
    assert_eq!(as_read(wide.flat_map(u16::to_le_bytes).collect()), plain);
    // Columns are called by their names, with or without the unit of the row below.
    let mapping = Mapping { force: Source::column("force"), ..Mapping::default() };
    let loaded = parse(Path::new("run.csv"), written.into_bytes(), &mapping).unwrap();
    assert_eq!(bits(&loaded.recording), plain);
}

#[test]
fn a_broken_row_still_names_its_line() {
    let text = "Recorder X\n\ntime_s,force_N,position_m\n0,1,2\n1,x,3\n";
    let error = parse(Path::new("run.csv"), text.into(), &Mapping::default()).unwrap_err();
    assert_eq!(error.line, Some(5), "{error}");
}

proptest! {
    #[test]
    fn damaged_files_are_refused_and_never_panic(
        name in prop::sample::select(vec!["run.npz", "packed.npz", "run.parquet", "lerobot.parquet", "run.xlsx", "run.csv"]),
        cuts in prop::collection::vec((0.0f64..1.0, any::<u8>()), 1..6),
        length in 0.0f64..1.2,
    ) {
        let mut bytes = std::fs::read(file(name)).unwrap();
        let size = bytes.len();
        for (place, byte) in cuts {
            bytes[(place * size as f64) as usize] = byte;
        }
        bytes.truncate((length * size as f64) as usize);
        let _ = parse(&file(name), bytes, &Mapping::default()).map_err(|error| (error.to_string(), error.hint()));
    }
}
