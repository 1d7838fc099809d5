//! Recordings as they come: what is read alike, what is told, what is refused. The rows of docs/hard-inputs.md.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::harness::Desk;

/// Time (s), force (N) and position (m, in counts of 1 µm) of a mass of 20 kg with friction of 5 N and 100 N s/m.
type Row = [f64; 3];

fn rows() -> Vec<Row> {
    let row = |k: u32| {
        let t = 1e-3 * f64::from(k);
        let wave = |size: f64, hertz: f64| {
            let (rate, turn) = (TAU * hertz, TAU * hertz * t);
            [size * turn.sin(), size * rate * turn.cos(), -size * rate * rate * turn.sin()]
        };
        let (slow, fast) = (wave(0.02, 0.8), wave(0.005, 2.3));
        let [x, v, a] = [0, 1, 2].map(|n| slow[n] + fast[n]);
        let noise = f64::from((k * 7919) % 1000) / 1000.0 - 0.5;
        [t, 20.0 * a + 100.0 * v + 5.0 * v.signum() + 0.1 * noise, (x * 1e6).round() * 1e-6]
    };
    (0..3000).map(row).collect()
}

fn text(rows: &[Row]) -> String {
    let mut text = String::from("time_s,force_N,position_m\n");
    for [t, force, position] in rows {
        writeln!(text, "{t:.6},{force:.6},{position:.9}").unwrap();
    }
    text
}

/// Every row changed.
fn each(change: impl Fn(usize, Row) -> Row) -> Vec<Row> {
    rows().into_iter().enumerate().map(|(k, row)| change(k, row)).collect()
}

#[test]
fn a_table_is_read_alike_however_it_is_written() {
    let desk = Desk::new();
    let plain = text(&rows());
    let identified = |content: Vec<u8>| {
        desk.write("run.csv", content);
        desk.aep("identify run.csv --effects coulomb,viscous").done().to_owned()
    };
    let expected = identified(plain.clone().into_bytes());
    assert!(expected.contains("coulomb.F_C"), "{expected}");
    let body = plain.split_once('\n').unwrap().1;
    let mut twice: Vec<&str> = plain.lines().collect();
    twice.insert(2000, twice[2000]);
    let latin = [b"# Pr\xfcfstand\n", plain.as_bytes()].concat();
    let wide = std::iter::once(0xfeff).chain(plain.encode_utf16()).flat_map(u16::to_be_bytes);
    for (what, content) in [
        ("byte-order mark", format!("\u{feff}{plain}").into_bytes()),
        ("Windows line ends", plain.replace('\n', "\r\n").into_bytes()),
        ("old Mac line ends", plain.replace('\n', "\r").into_bytes()),
        ("semicolons, decimal commas", plain.replace(',', ";").replace('.', ",").into_bytes()),
        ("tabs", plain.replace(',', "\t").into_bytes()),
        ("Latin-1", latin),
        ("UTF-16", wide.collect()),
        ("units row", format!("time,force,position\ns,N,m\n{body}").into_bytes()),
        ("preamble", format!("Drive 7\n2026-03-01\n\n{plain}").into_bytes()),
        ("a row twice", twice.join("\n").into_bytes()),
    ] {
        assert_eq!(identified(content), expected, "{what}");
    }
}

#[test]
fn what_limits_a_recording_is_told() {
    let desk = Desk::new();
    let wobble = |k: usize| 3e-4 * ((k * 37) % 100) as f64 / 100.0;
    let one_way = each(|_, [t, force, x]| [t, force.abs() + 20.0, 0.2 * t + 0.1 * x]);
    for (what, rows, kind) in [
        ("jitter", each(|k, [t, force, x]| [t + wobble(k), force, x]), "jitter"),
        ("a gap of 0.5 s", [&rows()[..1200], &rows()[1700..]].concat(), "gaps"),
        ("clipped force", each(|_, [t, force, x]| [t, force.clamp(-10.0, 10.0), x]), "clipped"),
        ("force turned", each(|_, [t, force, x]| [t, -force, x]), "negative_work"),
        ("position turned", each(|_, [t, force, x]| [t, force, -x]), "negative_work"),
        ("mm read as m", each(|_, [t, force, x]| [t, force, 1e3 * x]), "fast"),
        ("one direction", one_way, "one_direction"),
        ("two changes of direction", rows()[..600].to_vec(), "few_reversals"),
        (
            "a quarter is missing",
            rows()
                .into_iter()
                .enumerate()
                .filter(|(k, _)| k % 4 != 3)
                .map(|(_, row)| row)
                .collect(),
            "jitter",
        ),
    ] {
        desk.write("run.csv", text(&rows));
        desk.aep("discover run.csv --time-limit 0.2 --json run.json --quiet").done();
        let json = desk.json("run.json");
        let findings = json["data"]["findings"].as_array().unwrap();
        assert!(findings.iter().any(|f| f["kind"] == kind), "{what}: {findings:?}");
        let turned =
            kind == "negative_work" || findings.iter().all(|f| f["kind"] != "negative_work");
        assert!(turned, "{what}: {findings:?}");
    }
}

#[test]
fn what_says_nothing_of_a_drive_is_refused() {
    let desk = Desk::new();
    let half = |k: usize, force: f64| if k.is_multiple_of(2) { f64::NAN } else { force };
    for (rows, parts) in [
        (
            each(|_, [t, force, x]| [1e3 * t, force, x]),
            ["the samples are 1 s apart", "--time-unit ms"],
        ),
        (each(|_, [t, force, x]| [t, 1e11 * force, x]), ["out of all reason", "--force-unit"]),
        (each(|_, [t, _, x]| [t, 3.0, x]), ["'force' never changes", "hint:"]),
        (each(|_, [t, force, _]| [t, force, 0.01]), ["never changes", "hint:"]),
        (each(|k, [t, force, x]| [t, half(k, force), x]), ["1500 of 3000 rows", "run.csv"]),
        (
            each(|k, [_, force, x]| [1e-3 * (k / 2) as f64, force, x]),
            ["1500 of 3000 rows have the time of the row before", "hint:"],
        ),
        (rows()[..20].to_vec(), ["too short", "hint:"]),
    ] {
        desk.write("run.csv", text(&rows));
        desk.aep("discover run.csv").refused(&parts);
    }
    desk.write("run.csv", text(&rows()));
    desk.aep("discover run.csv --position-gain 1e-300")
        .refused(&["the position changes by", "--position-gain"]);
}

#[test]
fn what_is_asked_in_two_ways_or_of_nothing_is_refused() {
    let desk = Desk::new();
    desk.write("run.csv", text(&rows()));
    desk.aep("discover run.csv --base coulomb,stribeck,stribeck:free")
        .refused(&["'stribeck' and 'stribeck:free' are two forms of one effect", "leave one out"]);
    desk.aep("discover --force force_N")
        .refused(&["no recording to read with --force", "aep discover DATA"]);
    desk.aep("identify run.csv --effects coulomb,viscous -o m.json").done();
    let model = desk.read("m.json");
    for line in [
        "simulate --model m.json --input run.csv -o m.json",
        "simulate --model m.json --input run.csv -o run.csv",
        "export --model m.json --to mjcf -o m.json",
        "suggest run.csv --model m.json --json m.json",
        "control --model m.json --reference sine:5mm,0.5Hz -o m.json",
    ] {
        desk.aep(line).refused(&["would write over a file that is read", "another name"]);
    }
    assert_eq!(desk.read("m.json"), model);
}

#[test]
fn more_threads_than_make_sense_are_not_started() {
    let desk = Desk::new();
    desk.write("run.csv", text(&rows()));
    let run = desk.aep("identify run.csv --effects coulomb,viscous --threads 1000000");
    assert!(run.done().contains("coulomb.F_C"));
    assert!(run.err.contains("threads are used, not 1000000"), "{}", run.err);
}
