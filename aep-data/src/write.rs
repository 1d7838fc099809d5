//! Recordings to CSV, in the form that [`load`](crate::load) reads without any mapping.

use std::fmt::Write;

use missing_physics::Recording;

use crate::mapping::hold_name;
use crate::role::{self, Facts};

/// The recording as CSV: `time_s,force_N,position_m,...`, numbers exact to the bit.
pub fn to_csv(recording: &Recording) -> String {
    // {:?} is the shortest text that reads back the same.
    csv(recording, |_| |value| format!("{value:?}"))
}

/// Like [`to_csv`], with `digits` digits of each channel's largest value: what an instrument gives.
pub fn to_csv_rounded(recording: &Recording, digits: usize) -> String {
    csv(recording, |values| {
        let largest =
            values.iter().fold(f64::MIN_POSITIVE, |most: f64, value| most.max(value.abs()));
        let decimals = (digits as f64 - largest.log10().ceil()).clamp(0.0, 17.0) as usize;
        move |value| trimmed(format!("{value:.decimals$}"))
    })
}

/// Writes every channel with the writer that `writer` makes for its values.
fn csv<W: Fn(f64) -> String>(recording: &Recording, writer: impl Fn(&[f64]) -> W) -> String {
    let channels = recording.channels();
    let segmented = recording.segments().len() > 1;
    let columns: Vec<&[f64]> = std::iter::once(recording.time())
        .chain(channels.iter().map(|channel| channel.values.as_slice()))
        .collect();
    let writers: Vec<W> = columns.iter().map(|values| writer(values)).collect();
    let mut text = "time_s".to_owned();
    for channel in channels {
        text.push(',');
        text.push_str(&header(&channel.name, &channel.unit));
    }
    text.push_str(if segmented { ",segment\n" } else { "\n" });
    for (number, range) in recording.segments().iter().enumerate() {
        for sample in range.clone() {
            let row = columns.iter().zip(&writers).map(|(values, write)| write(values[sample]));
            text.push_str(&row.collect::<Vec<String>>().join(","));
            if segmented {
                // Writing to a string cannot fail.
                let _ = write!(text, ",{number}");
            }
            text.push('\n');
        }
    }
    text
}

/// Without zeros at the end, and without a sign before nothing.
fn trimmed(text: String) -> String {
    if !text.contains('.') {
        return text;
    }
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// What the CSV cannot say: the `DATA.toml` to lie beside it.
pub fn to_toml(recording: &Recording) -> String {
    format!("hold = \"{}\"\n", hold_name(recording.hold()))
}

fn header(channel: &str, unit: &str) -> String {
    let known = |facts: &&Facts| facts.name == channel;
    match role::ALL.iter().find(known) {
        Some(facts) if unit == facts.linear.si() => facts.header.to_owned(),
        Some(facts) if unit == facts.rotary.si() => facts.rotary_header.to_owned(),
        _ if unit.is_empty() => channel.to_owned(),
        _ => format!("{channel}_{}", unit.replace('/', "_")),
    }
}
