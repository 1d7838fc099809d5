//! MATLAB v5 files, compressed and not, with variables that are no numbers among them.

use std::path::{Path, PathBuf};

use aep_data::{DataError, Mapping, Source, load, parse, read};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

fn mapping(time: &str, force: &str, position: &str) -> Mapping {
    Mapping {
        time: Source::column(time),
        force: Source::column(force),
        position: Source::column(position),
        ..Mapping::default()
    }
}

fn error(mapping: &Mapping) -> String {
    let error: DataError = load(&fixture("mixed.mat"), mapping).unwrap_err();
    format!("{} | {} | {}", error.problem, error.place(), error.hint().unwrap_or_default())
}

#[test]
fn products_rows_columns_and_integers_are_read() {
    let mut mapping = mapping("t", "u*gain", "x");
    mapping.position.unit = Some("mm".to_owned());
    let recording = load(&fixture("mixed.mat"), &mapping).unwrap();
    assert_eq!(recording.len(), 40);
    assert!((recording.require("force").unwrap()[3] - 2.5 * 0.15_f64.sin()).abs() < 1e-12);
    assert!((recording.require("position").unwrap()[0] - 1.0).abs() < 1e-12);
}

#[test]
fn plain_names_need_no_mapping() {
    let loaded = read(&fixture("plain.mat"), &Mapping::default()).unwrap();
    assert_eq!(loaded.recording.len(), 40);
    assert_eq!(loaded.origins[1].column, "force");
}

#[test]
fn a_single_time_is_the_sampling_interval() {
    let recording = load(&fixture("mixed.mat"), &mapping("Ts", "u", "x")).unwrap();
    assert!((recording.interval() - 1e-3).abs() < 1e-15);
}

#[test]
fn missing_variables_list_those_present_with_class_and_size() {
    let text = error(&Mapping::default());
    for part in ["force", "u (40x1)", "x (1x40)", "log.b (1x3)", "names (cell array)", "--force"] {
        assert!(text.contains(part), "'{part}' is not in: {text}");
    }
}

#[test]
fn structures_and_matrices_are_named_and_a_sample_without_a_number_is_left_out() {
    assert!(error(&mapping("t", "log", "x")).contains("'log' is a structure"));
    assert!(error(&mapping("t", "note", "x")).contains("'note' is a text"));
    assert!(error(&mapping("t", "M", "x")).contains("'M' is 3 x 3"));
    let mapping = mapping("t", "nan", "x");
    let loaded = read(&fixture("mixed.mat"), &mapping).unwrap();
    assert_eq!((loaded.left_out.missing, loaded.recording.len()), (1, 39));
}

#[test]
fn fields_of_structures_are_variables_in_both_packings() {
    let mapping = Mapping {
        time: Source::column("out.time"),
        force: Source::column("out.signals_0.values"),
        position: Source { unit: Some("mm".to_owned()), ..Source::column("out.signals_1.values") },
        ..Mapping::default()
    };
    for name in ["structures.mat", "structures_plain.mat"] {
        let recording = load(&fixture(name), &mapping).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(recording.len(), 40, "{name}");
        assert_eq!(recording.require("force").unwrap()[3], 2.25);
        assert!((recording.require("position").unwrap()[39] - 3.9e-3).abs() < 1e-15);
        // Structures within structures, single precision.
        let deep = Mapping { force: Source::column("out.info.motor.u_V"), ..mapping.clone() };
        assert_eq!(load(&fixture(name), &deep).unwrap().require("force").unwrap()[5], 2.5);
        let text = Mapping { force: Source::column("out.info.note"), ..mapping.clone() };
        let error = load(&fixture(name), &text).unwrap_err().to_string();
        assert!(error.contains("'out.info.note' is a text"), "{error}");
        let whole = Mapping { force: Source::column("out.info"), ..mapping.clone() };
        let error = load(&fixture(name), &whole).unwrap_err();
        assert!(error.to_string().contains("'out.info' is a structure"), "{error}");
        assert!(error.hint().unwrap_or_default().contains("out.info.motor.u_V"), "{error}");
    }
}

#[test]
fn one_structure_that_holds_all_needs_no_names() {
    let loaded = read(&fixture("structure.mat"), &Mapping::default()).unwrap();
    assert_eq!(loaded.recording.len(), 40);
    assert_eq!(loaded.origins[1].column, "force_N");
}

#[test]
fn damaged_structures_never_panic() {
    let bytes = std::fs::read(fixture("structures_plain.mat")).unwrap();
    for place in 128..bytes.len().min(1400) {
        for value in [0, 1, 14, 0x7f, 0xff] {
            let mut damaged = bytes.clone();
            damaged[place] = value;
            let _ = parse(Path::new("damaged.mat"), damaged, &mapping("out.time", "Ts", "Ts"));
        }
    }
}

#[test]
fn a_file_that_ends_early_is_damaged_not_short() {
    let bytes = std::fs::read(fixture("mixed.mat")).unwrap();
    for length in (128..bytes.len()).step_by(7) {
        let cut = bytes[..length].to_vec();
        // Wherever it is cut: an error, never a panic and never a recording with fewer samples.
        let result = parse(Path::new("cut.mat"), cut, &mapping("t", "u*gain", "x"));
        assert!(result.is_err() || result.unwrap().recording.len() == 40, "cut at {length}");
    }
}

#[test]
fn no_damaged_byte_makes_it_panic() {
    let bytes = std::fs::read(fixture("mixed.mat")).unwrap();
    for index in 0..bytes.len() {
        for value in [0, 255, bytes[index] ^ 1] {
            let mut damaged = bytes.clone();
            damaged[index] = value;
            let _ = parse(Path::new("damaged.mat"), damaged, &mapping("t", "u*gain", "x"));
        }
    }
}

#[test]
fn the_published_axis_is_recognised_by_its_variables() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/emps");
    let (mat, csv) = (folder.join("DATA_EMPS.mat"), folder.join("emps_train.csv"));
    if !mat.exists() {
        eprintln!("skipped: {} is not there", mat.display());
        return;
    }
    let loaded = read(&mat, &Mapping::default()).unwrap();
    assert_eq!(loaded.layout, Some("EMPS"));
    assert_eq!(loaded.recording.len(), 24_841);
    let force = loaded.recording.require("force").unwrap()[0];
    assert!((force - 89.234_432_21).abs() < 1e-6);
    // The CSV of the same data, by the names of its columns alone.
    let other = load(&csv, &Mapping::default()).unwrap();
    let (a, b) =
        (loaded.recording.require("reference").unwrap(), other.require("reference").unwrap());
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9));
}
