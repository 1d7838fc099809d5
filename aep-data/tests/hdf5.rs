//! MATLAB files of version 7.3 and plain HDF5, written by `h5py` (`fixtures/v73.py`).

use std::path::{Path, PathBuf};

use aep_data::{Axes, Mapping, Source, parse, read, read_axes};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

#[test]
fn rows_columns_matrices_integers_and_fields_of_structures_are_columns() {
    let mapping = |force: &str, position: &str| Mapping {
        force: Source { unit: Some("N".into()), ..Source::column(force) },
        position: Source { unit: Some("mm".into()), ..Source::column(position) },
        ..Mapping::default()
    };
    let loaded = read(&fixture("v73.mat"), &mapping("force_N", "position_mm")).unwrap();
    let value =
        |loaded: &aep_data::Loaded, channel: &str| loaded.recording.require(channel).unwrap()[39];
    assert_eq!(loaded.recording.len(), 40);
    assert!((loaded.recording.time()[39] - 0.039).abs() < 1e-15);
    assert_eq!(value(&loaded, "force"), 1.5 + 0.25 * 39.0);
    assert!((value(&loaded, "position") - 0.0039).abs() < 1e-12);
    for column in ["q_0", "q_1", "ticks", "log.u_V"] {
        assert!(loaded.unused.iter().any(|name| name == column), "{:?}", loaded.unused);
    }
    let loaded = read(&fixture("v73.mat"), &mapping("log.u_V", "q_1")).unwrap();
    assert_eq!(value(&loaded, "force"), 19.5);
    assert!((value(&loaded, "position") + 0.0117).abs() < 1e-12);
    assert_eq!(
        value(&read(&fixture("v73.mat"), &mapping("ticks", "q_0")).unwrap(), "force"),
        117.0
    );
    // What is there but holds no numbers is told.
    let error = read(&fixture("v73.mat"), &mapping("tau", "q_0")).unwrap_err().to_string();
    for part in ["'tau'", "force_N", "note (text)", "names (cell array)"] {
        assert!(error.contains(part), "'{part}' is not in {error}");
    }
}

#[test]
fn axes_of_a_plain_file_are_columns_of_its_matrices() {
    let mapping = Mapping {
        force: Source::column("data.tau_{}"),
        position: Source::column("data.q_{}"),
        ..Mapping::default()
    };
    let loaded = read_axes(&[fixture("plain.h5")], &mapping, &Axes::All).unwrap();
    let names: Vec<&str> = loaded.axes.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["0", "1"]);
    let force = loaded.axes[1].1.recording.require("force").unwrap();
    assert_eq!((force[1], force[39]), (2.0, 78.0));
}

#[test]
fn more_values_than_a_file_can_hold_are_told_and_not_reserved() {
    let bytes = std::fs::read(fixture("v73.mat")).unwrap();
    let mapping = Mapping { position: Source::column("q_1"), ..Mapping::default() };
    let places = bytes.windows(8).enumerate().filter(|(_, size)| **size == 40u64.to_le_bytes());
    let places: Vec<usize> = places.map(|(place, _)| place).collect();
    let mut told = 0;
    for place in places {
        for rows in [1u64 << 42, u64::MAX] {
            let mut bytes = bytes.clone();
            bytes[place..place + 8].copy_from_slice(&rows.to_le_bytes());
            let read = parse(Path::new("run.mat"), bytes, &mapping);
            told += usize::from(read.is_err_and(|e| e.to_string().contains("can hold")));
        }
    }
    assert!(told > 0);
}

#[test]
fn a_file_that_ends_early_or_is_damaged_is_told_and_never_a_panic() {
    let bytes = std::fs::read(fixture("v73.mat")).unwrap();
    let mapping = Mapping { position: Source::column("q_1"), ..Mapping::default() };
    for length in (512..bytes.len()).step_by(61) {
        let _ = parse(Path::new("run.mat"), bytes[..length].to_vec(), &mapping);
    }
    for place in (512..bytes.len()).step_by(7) {
        let mut broken = bytes.clone();
        broken[place] ^= 0xa5;
        let _ = parse(Path::new("run.mat"), broken, &mapping);
    }
    assert!(parse(Path::new("run.mat"), bytes[..600].to_vec(), &mapping).is_err());
}
