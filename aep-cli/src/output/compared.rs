//! The record of decisions as tables.

use std::fmt::Write;

use aep_studio::words;
use missing_physics::{Discovery, Thresholds};

use super::style::{dim, wrapped};
use super::table::{Align, LINE, Table};

/// Every comparison, grouped by number of effects.
pub fn compared(discovery: &Discovery, thresholds: &Thresholds) -> String {
    let mut text = String::new();
    for group in words::compared(discovery, thresholds) {
        let columns = words::COMPARED_HEADINGS.map(|heading| match heading {
            "set" => (group.title.as_str(), Align::Left),
            "compared with" | "outcome" => (heading, Align::Left),
            number => (number, Align::Right),
        });
        let mut table = Table::new(&columns).at_most(LINE);
        for [set, with, difference, needed, times, outcome] in group.rows {
            // Effects stand below each other: the outcome needs the width.
            let stacked = |effects: String| effects.replace(" + ", "\n+ ");
            table.row([stacked(set), stacked(with), difference, needed, times, outcome]);
        }
        text += &table.text();
        text.push('\n');
    }
    for line in wrapped(words::COMPARED) {
        let _ = writeln!(text, " {}", dim(&line));
    }
    text
}

/// How many comparisons there were, and how to see them.
pub fn comparisons(discovery: &Discovery) -> String {
    let said = words::comparisons(discovery);
    said.map(|said| format!(" {}\n", dim(&format!("{said}: --explain shows them"))))
        .unwrap_or_default()
}
