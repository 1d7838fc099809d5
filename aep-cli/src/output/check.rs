//! The check of the data.

use std::fmt::Write;

use aep_data::{LeftOut, Loaded};
use aep_studio::words;
use anstyle::AnsiColor;
use missing_physics::Hold;
use missing_physics::measurement::check::{DataCheck, Severity};
use missing_physics::measurement::quantity::{percent, quantity};

use super::style::{dim, heading, paint};
use super::table::{Align, Table};

/// What was read, and what is to be known of it before any model.
pub fn data_check(loaded: &Loaded, check: &DataCheck) -> String {
    let mut text = heading(&format!("The data: {}", loaded.recording.name()));
    // Writing to a string cannot fail.
    let _ = writeln!(text, " {}", overview(loaded, check));
    text.push_str(&channels(loaded, check));
    if loaded.switched_off > 0 {
        let (mark, samples) = (dim("·"), loaded.switched_off);
        let _ =
            writeln!(text, " {mark} the drive was switched off for {samples} samples: left out");
    }
    if let Some(said) = left_out(&loaded.left_out) {
        let _ = writeln!(text, " {} {said}", dim("·"));
    }
    for finding in &check.findings {
        let mark = match finding.severity() {
            Severity::Info => dim("·"),
            Severity::Warning => paint(AnsiColor::Yellow, "!"),
            Severity::Serious => paint(AnsiColor::Red, "!!"),
        };
        let _ = writeln!(text, " {mark} {}", words::finding(finding));
    }
    text
}

/// How many rows are not among the samples.
fn left_out(rows: &LeftOut) -> Option<String> {
    let each = [
        (rows.missing, "without a number in a column that is used"),
        (rows.repeated, "with the time of the row before"),
    ];
    let told = each.iter().filter(|(count, _)| *count > 0);
    let told: Vec<String> = told
        .map(|(count, what)| format!("{count} {} {what}", if *count == 1 { "row" } else { "rows" }))
        .collect();
    (!told.is_empty()).then(|| format!("left out: {}", told.join(", ")))
}

fn overview(loaded: &Loaded, check: &DataCheck) -> String {
    let pieces = match check.segments {
        1 => String::new(),
        pieces => format!(" in {pieces} segments"),
    };
    let layout = loaded.layout.map(|name| format!("; recognised as {name}")).unwrap_or_default();
    let hold = match loaded.recording.known_hold() {
        Some(Hold::ZeroOrder) => "; the force is a command, held between samples",
        Some(Hold::Sampled) => "; the force is taken as sampled",
        None => "",
    };
    format!(
        "{} samples{pieces} over {}, one every {}{layout}{hold}",
        check.samples,
        quantity(check.sampling.duration_s, "s"),
        quantity(check.sampling.interval_s, "s"),
    )
}

fn channels(loaded: &Loaded, check: &DataCheck) -> String {
    let mut table = Table::new(&[
        ("channel", Align::Left),
        ("read from", Align::Left),
        ("smallest", Align::Right),
        ("largest", Align::Right),
        ("rms", Align::Right),
        ("one count", Align::Right),
        ("held at a limit", Align::Left),
    ]);
    for channel in &check.channels {
        let origin = loaded.origins.iter().find(|origin| origin.channel == channel.name);
        let value = |value: f64| quantity(value, &channel.unit);
        let held = channel.saturation.iter().map(|limit| percent(limit.share));
        table.row([
            channel.name.clone(),
            origin.map(|origin| origin.column.clone()).unwrap_or_default(),
            value(channel.min),
            value(channel.max),
            value(channel.rms),
            channel.quantum.map_or_else(|| "-".to_owned(), value),
            held.collect::<Vec<String>>().join(", "),
        ]);
    }
    table.text()
}
