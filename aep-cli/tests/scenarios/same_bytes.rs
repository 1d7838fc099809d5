//! The same seed gives the same bytes, but for wall time and the command that a page repeats: on any number of threads, and
//! again.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;

use serde_json::Value;

use crate::harness::Desk;

/// The bytes of a file without what a wall clock or the command line says in them.
pub fn content(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).unwrap();
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("json") => {
            let mut value: Value = serde_json::from_slice(&bytes).unwrap();
            stopped(&mut value);
            value.to_string().into_bytes()
        }
        Some("html") => {
            let text = String::from_utf8(bytes).unwrap();
            let (before, rest) = text.split_once("<footer>").unwrap();
            let (footer, after) = rest.split_once("</footer>").unwrap();
            assert!(footer.len() < 1000, "{footer}");
            (before.to_owned() + after).into_bytes()
        }
        _ => bytes,
    }
}

/// Wall times as 0.
fn stopped(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            for (name, value) in fields {
                if ["wall_s", "seconds"].contains(&name.as_str()) {
                    *value = 0.into();
                }
                stopped(value);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(stopped),
        _ => {}
    }
}

/// All files in a folder of the desk, by their names, those in folders of it, too.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(k, v)| (format!("{name}/{k}"), v)));
        } else {
            found.insert(name, content(&path));
        }
    }
    found
}

/// `line` leaves the same files in the folder that it runs in whatever the number of threads, and prints the same.
fn alike(line: &str, count: usize) {
    let on = |threads: usize| {
        let desk = Desk::new();
        desk.write("run.csv", RECORDING.as_str());
        let run = desk.aep(&format!("{line} --threads {threads}"));
        (run.done().to_owned(), files(&desk.path(".")))
    };
    let one = on(1);
    assert_eq!(one.1.len(), 1 + count, "{:?}", one.1.keys());
    for threads in [2, 7] {
        let other = on(threads);
        for (name, bytes) in &one.1 {
            assert!(other.1[name] == *bytes, "{line}: {name} differs on {threads} threads");
        }
        assert_eq!(other.1.len(), one.1.len());
        if !line.contains("optimize") {
            assert_eq!(other.0, one.0, "{line} on {threads} threads");
        }
    }
}

/// A recording with a hidden effect.
static RECORDING: LazyLock<String> = LazyLock::new(|| {
    let desk = Desk::new();
    desk.challenge("stribeck", 1, "c");
    desk.read("c/recording.csv")
});

#[test]
fn a_discovery_with_page_and_series() {
    alike(
        "discover --time-limit none --most 1 --json d.json --html d.html --series d.csv -o m.json",
        4,
    );
}

#[test]
fn an_identification_with_model_page_and_series() {
    let line = "identify run.csv --effects coulomb,viscous,stribeck --series s.parquet";
    alike(&format!("{line} -o m.json --json r.json --html p.html"), 4);
}

#[test]
fn a_comparison_of_optimizers_with_page_and_plot() {
    let line = "optimize rastrigin --dimension 4 --trials 6 --evaluations 3000";
    alike(&format!("{line} -o out --json o.json --html o.html"), 6);
    let line = "optimize two-mass --algorithm auto,de --trials 2 --evaluations 300";
    alike(&format!("{line} -o out --json o.json"), 5);
}

#[test]
fn figures_of_the_paper() {
    alike("reproduce fig4 --trials 4 -o paper", 7);
}

#[test]
fn what_is_made_for_other_simulators_twice() {
    for line in ["export --to fmu --source-only f.fmu", "export --to c compensator"] {
        let made = || {
            let desk = Desk::new();
            desk.aep(line).done();
            files(&desk.path("."))
        };
        let first = made();
        assert!(!first.is_empty());
        assert!(first == made(), "{line}");
    }
}
