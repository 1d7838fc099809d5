//! CSV as instruments, spreadsheets and people write it.

use std::path::Path;

use aep_data::{Loaded, Mapping, Source, load, parse, to_csv, to_csv_rounded, to_toml};
use missing_physics::{Channel, Hold, Recording};

fn read(text: &str, mapping: &Mapping) -> Loaded {
    parse(Path::new("run.csv"), text.as_bytes().to_vec(), mapping).unwrap()
}

/// A table with `header` and 20 rows made by `row`.
fn table(header: &str, row: impl Fn(u32) -> String) -> String {
    let rows: Vec<String> = (0..20).map(row).collect();
    format!("{header}\n{}\n", rows.join("\n"))
}

fn plain(k: u32) -> String {
    format!("{k},{},{}", 2 * k, 3 * k)
}

#[test]
fn units_in_the_header_become_si() {
    let text = table("t [ms],Force (mN),x_um", plain);
    let recording = read(&text, &Mapping::default()).recording;
    assert!((recording.time()[1] - 1e-3).abs() < 1e-15);
    assert!((recording.require("force").unwrap()[1] - 2e-3).abs() < 1e-15);
    assert!((recording.require("position").unwrap()[1] - 3e-6).abs() < 1e-15);
    assert_eq!(recording.channel("force").unwrap().unit, "N");
}

#[test]
fn a_rotary_axis_is_recognised_by_its_units() {
    let recording =
        read(&table("time_s,torque_mNm,angle_deg", plain), &Mapping::default()).recording;
    assert_eq!(recording.channel("force").unwrap().unit, "Nm");
    assert_eq!(recording.channel("position").unwrap().unit, "rad");
    assert!((recording.require("position").unwrap()[1] - 3_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn semicolons_decimal_commas_tabs_and_marks_are_read() {
    let semicolons = table("\u{feff}time_s;force_N;position_m", |k| format!("{k};1,5;0,25;"));
    let recording = read(&semicolons, &Mapping::default()).recording;
    assert_eq!(recording.require("force").unwrap()[0], 1.5);
    let tabs = table("% exported\ntime_s\tforce_N\tposition_m", |k| format!("{k}\t1.5\t0.25"));
    assert_eq!(read(&tabs, &Mapping::default()).recording.len(), 20);
    let windows = table("time_s,force_N,position_m", plain).replace('\n', "\r\n");
    assert_eq!(read(&windows, &Mapping::default()).recording.len(), 20);
}

#[test]
fn text_in_columns_nobody_needs_is_no_error() {
    let text = table("time_s,force_N,position_m,comment", |k| format!("{},ok", plain(k)));
    let loaded = read(&text, &Mapping::default());
    assert_eq!(loaded.unused, ["comment"]);
}

#[test]
fn products_gains_and_an_interval_without_a_time() {
    let mapping = Mapping {
        force: Source { column: Some("duty*V".into()), gain: Some(-2.0), unit: Some("mNm".into()) },
        position: Source::column("q_rad"),
        interval_s: Some(0.005),
        hold: Some(Hold::ZeroOrder),
        ..Mapping::default()
    };
    let loaded = read(&table("duty,V,q_rad", plain), &mapping);
    let recording = loaded.recording;
    assert!((recording.require("force").unwrap()[2] + 2.0 * 2.0 * 4.0 * 1e-3).abs() < 1e-15);
    assert!((recording.interval() - 0.005).abs() < 1e-15);
    assert_eq!(recording.hold(), Hold::ZeroOrder);
    assert_eq!(recording.channel("force").unwrap().unit, "Nm");
}

#[test]
fn a_mapping_beside_the_data_is_used() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.csv");
    std::fs::write(&path, table("t_s,u_V,q_m", plain)).unwrap();
    let toml = "hold = \"zero-order\"\nforce = { column = \"u_V\", gain = 35.0 }\n";
    std::fs::write(path.with_extension("toml"), toml).unwrap();
    let recording = load(&path, &Mapping::default()).unwrap();
    assert_eq!(recording.require("force").unwrap()[1], 70.0);
    assert_eq!(recording.hold(), Hold::ZeroOrder);
}

#[test]
fn what_is_written_reads_back_to_the_bit() {
    let values = |scale: f64| (0..40).map(|k| f64::from(k).sin() * scale).collect::<Vec<f64>>();
    let time: Vec<f64> = (0..40).map(|k| f64::from(k % 20) * 1e-3).collect();
    for (force, position, velocity) in [("N", "m", "m/s"), ("Nm", "rad", "rad/s")] {
        let channels = vec![
            Channel::new("force", force, values(1e3)),
            Channel::new("position", position, values(1e-9)),
            Channel::new("velocity", velocity, values(0.1)),
            Channel::new("reference", position, values(1.0)),
            Channel::new("temperature", "C", values(20.0)),
        ];
        let segment = (0..40).map(|k| i64::from(k >= 20)).collect();
        let recording =
            Recording::with_segments("run.csv", time.clone(), channels, segment).unwrap();
        let recording = recording.with_hold(Hold::ZeroOrder);
        let mapping = Mapping::parse(&to_toml(&recording), Path::new("run.toml")).unwrap();
        assert_eq!(read(&to_csv(&recording), &mapping).recording, recording);
    }
}

#[test]
fn rounded_numbers_keep_the_digits_asked_for() {
    let time: Vec<f64> = (0..20).map(|k| f64::from(k) * 1e-3).collect();
    let channels = vec![
        Channel::new("force", "N", (0..20).map(|k| f64::from(k) * 12.345_678_9).collect()),
        Channel::new("position", "m", (0..20).map(|k| -f64::from(k) * 1e-6).collect()),
    ];
    let recording = Recording::new("run.csv", time, channels).unwrap();
    let text = to_csv_rounded(&recording, 6);
    assert_eq!(text.lines().nth(1), Some("0,0,0"));
    assert_eq!(text.lines().nth(4), Some("0.003,37.037,-0.000003"));
}

#[test]
fn time_stamps_are_read_to_the_nanosecond_from_the_first_one_on() {
    let row = |k: u32| {
        let nanoseconds = 990_000_000 + 250_001 * k;
        format!("2026-03-01T23:59:59,{nanoseconds:09};{k};{}\n", 2 * k)
    };
    let text = "Recorder: X\nwhen;force;position\n;N;mm\n".to_owned();
    let text = text + &(0..40).map(row).collect::<Vec<String>>().concat();
    let mapping = Mapping { time: Source::column("when"), ..Mapping::default() };
    let loaded = parse(Path::new("run.csv"), text.into_bytes(), &mapping).unwrap();
    let time = loaded.recording.time();
    assert_eq!(time[0], 0.0);
    assert!((time[39] - 39.0 * 250_001e-9).abs() < 1e-15, "{}", time[39]);
    // Whatever unit the name says.
    let rows = (0..40).map(|k| format!("2026-03-01 10:00:{k:02}Z,1,2\n"));
    let text = "time_ms,force_N,position_m\n".to_owned() + &rows.collect::<Vec<String>>().concat();
    let loaded = parse(Path::new("run.csv"), text.into_bytes(), &Mapping::default()).unwrap();
    assert!((loaded.recording.time()[39] - 39.0).abs() < 1e-12);
}

#[test]
fn volts_and_amperes_without_a_gain_stay_what_they_are() {
    let text = |name: &str| {
        let rows = (0..40).map(|k| format!("{},500,{k},400\n", 0.001 * f64::from(k)));
        format!("time_s,{name},angle_rad,model\n") + &rows.collect::<Vec<String>>().concat()
    };
    let force = |column: &str| Mapping { force: Source::column(column), ..Mapping::default() };
    for (column, unit, value) in [("u_mV", "V", 0.5), ("i_A", "A", 500.0), ("i [mA]", "A", 0.5)] {
        let loaded = read(&text(column), &force(column));
        let channel = loaded.recording.channel("force").unwrap();
        assert_eq!((channel.unit.as_str(), channel.values[0]), (unit, value));
        assert_eq!(loaded.origins[1].unit, unit);
        assert!(to_csv(&loaded.recording).starts_with(&format!("time_s,force_{unit},")));
    }
    // A gain makes a torque of it, and so does nothing else.
    let gain = Mapping {
        force: Source { column: Some("u_V".into()), gain: Some(2.0), ..Source::default() },
        ..Mapping::default()
    };
    assert_eq!(read(&text("u_V"), &gain).recording.channel("force").unwrap().unit, "Nm");
    // The force of a model is in the unit of the force.
    let both = |unit: Option<&str>| Mapping {
        model_force: Source {
            column: Some("model".into()),
            unit: unit.map(str::to_owned),
            gain: None,
        },
        ..force("u_V")
    };
    let loaded = read(&text("u_V"), &both(None));
    assert_eq!(loaded.recording.channel("model_force").unwrap().unit, "V");
    let bytes = text("u_V").into_bytes();
    let error = parse(Path::new("run.csv"), bytes, &both(Some("Nm"))).unwrap_err();
    assert!(error.to_string().contains("no unit of a model_force"), "{error}");
}
