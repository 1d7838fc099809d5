//! Recordings to CSV, in the form that [`load`](crate::load) reads without any mapping.

use std::fmt::Write;

use missing_physics::Recording;

use crate::mapping::hold_name;
use crate::role::{self, Facts};

/// The recording as CSV: `time_s,force_N,position_m,...`, numbers exact to the bit.
pub fn to_csv(recording: &Recording) -> String {
    let channels = recording.channels();
    let segmented = recording.segments().len() > 1;
    let mut text = String::with_capacity(recording.len() * 24 * (channels.len() + 1));
    text.push_str("time_s");
    for channel in channels {
        text.push(',');
        text.push_str(&header(&channel.name, &channel.unit));
    }
    text.push_str(if segmented { ",segment\n" } else { "\n" });
    for (number, range) in recording.segments().iter().enumerate() {
        for sample in range.clone() {
            // Writing to a string cannot fail. {:?} is the shortest text that reads back the same.
            let _ = write!(text, "{:?}", recording.time()[sample]);
            for channel in channels {
                let _ = write!(text, ",{:?}", channel.values[sample]);
            }
            if segmented {
                let _ = write!(text, ",{number}");
            }
            text.push('\n');
        }
    }
    text
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
