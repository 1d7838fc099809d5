//! Results point by point.

use std::collections::BTreeMap;

use crate::harness::Desk;

/// The columns of a CSV as texts.
fn columns(text: &str) -> BTreeMap<&str, Vec<&str>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut columns: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for line in lines {
        for (name, value) in names.iter().zip(line.split(',')) {
            columns.entry(name).or_default().push(value);
        }
    }
    columns
}

/// Root mean square of the values that are numbers.
fn rms(values: &[&str]) -> f64 {
    let numbers: Vec<f64> = values.iter().filter_map(|value| value.parse().ok()).collect();
    (numbers.iter().map(|value| value * value).sum::<f64>() / numbers.len() as f64).sqrt()
}

#[test]
fn every_sample_is_told_with_prediction_and_residual_of_every_rung() {
    let desk = Desk::new();
    desk.challenge("stribeck", 3, "c");
    let line = "discover c/recording.csv --time-limit none --series s.csv --json d.json -q";
    desk.aep(line).done();
    let text = desk.read("s.csv");
    let series = columns(&text);
    let rows = desk.read("c/recording.csv").lines().count() - 1;
    assert!(series.values().all(|column| column.len() == rows));
    let last = format!("1_{}", desk.json("d.json")["added"][0].as_str().unwrap());
    let of = |rung: &str, what: &str| series[format!("{rung}.{what}").as_str()].clone();
    for what in ["residual_position_m", "residual_force_N"] {
        assert!(rms(&of(&last, what)) < 0.8 * rms(&of("base", what)), "{what}");
    }
    let number = |text: &str| text.parse::<f64>().unwrap();
    for k in (100..rows).step_by(97) {
        let measured = number(series["position_m"][k]);
        let predicted = number(of("base", "position_m")[k]);
        let left = number(of("base", "residual_position_m")[k]);
        assert!((measured - predicted - left).abs() < 1e-12);
        assert_eq!(series["took_part"][k] == "1", series["why_not"][k].is_empty());
    }
    assert_eq!((series["took_part"][0], series["why_not"][0]), ("0", "start of a piece"));
    assert!(series["regime"].contains(&"reversal"));
}

#[test]
fn every_command_that_fits_or_compares_writes_a_series() {
    let desk = Desk::new();
    desk.challenge("stribeck", 3, "c");
    let data = "c/recording.csv";
    desk.aep(&format!("identify {data} --effects coulomb,viscous -o m.json --series i.parquet"))
        .done();
    assert!(std::fs::read(desk.path("i.parquet")).unwrap().ends_with(b"PAR1"));
    desk.aep(&format!("extend {data} --model m.json --add stribeck -o n.json --series e.csv"))
        .done();
    let text = desk.read("e.csv");
    let extended = columns(&text);
    assert!(extended["why_not"].contains(&"held out of the fit"));
    let (before, after) = ("before.residual_force_N", "after.residual_force_N");
    assert!(rms(&extended[after]) < rms(&extended[before]));
    let run = desk.aep(&format!("compare {data} --model m.json --model n.json --series c.csv"));
    assert!(run.done().contains("series written to c.csv"));
    let text = desk.read("c.csv");
    let compared = columns(&text);
    assert_eq!(compared["m.force_N"], extended["before.force_N"]);
}

#[test]
fn an_output_that_is_an_input_is_refused_before_anything_is_done() {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    let data = "c/recording.csv";
    let before = desk.read(data);
    for flags in ["--series c/recording.csv", "--json c/../c/recording.csv"] {
        desk.aep(&format!("discover {data} {flags}"))
            .refused(&["would write over a file that is read", "c/"]);
    }
    desk.aep(&format!("identify {data} --effects coulomb --series a.csv --json a.csv"))
        .refused(&["--json and --series name the same file"]);
    desk.aep(&format!("discover {data} --series a.txt")).refused(&[".csv or .parquet"]);
    assert_eq!(desk.read(data), before);
}
