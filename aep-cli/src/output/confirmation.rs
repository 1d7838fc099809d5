//! What other recordings say of a discovery.

use std::fmt::Write;

use aep_studio::words::{self, Heading};
use missing_physics::Discovery;
use missing_physics::report::{Confirmed, Surrogates};

use super::style::{dim, heading};
use super::table::{Align, Table};

/// What surrogates of the recording say of false alarms.
pub fn surrogates(found: &Surrogates) -> String {
    let mut text = heading("On surrogates of this recording");
    for line in words::surrogates(found) {
        let _ = writeln!(text, " {line}");
    }
    text
}

/// The rungs of a discovery on recordings that had no part in it, under a title.
pub fn confirmation(discovery: &Discovery, confirmed: &Confirmed, title: &str) -> String {
    let headings = words::confirmation_headings(discovery);
    let align = |heading: &Heading| if heading.numbers { Align::Right } else { Align::Left };
    let columns: Vec<(&str, Align)> =
        headings.iter().map(|heading| (heading.text.as_str(), align(heading))).collect();
    let mut table = Table::new(&columns);
    for row in words::confirmation_rows(discovery, confirmed) {
        table.row(row);
    }
    let mut text = heading(title) + &table.text();
    // Writing to a string cannot fail.
    let _ = writeln!(text, " {}", dim(words::CONFIRMATION));
    for sentence in words::confirmations(confirmed) {
        let _ = writeln!(text, " {sentence}");
    }
    text
}
