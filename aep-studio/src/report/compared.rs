//! The record of what was compared, folded.

use missing_physics::Discovery;

use crate::html::{self, concat, escape, table};
use crate::source::Source;
use crate::words::{self, Compared};

/// The section of the record; nothing where there is none.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    let Some(comparisons) = words::comparisons(discovery) else {
        return String::new();
    };
    let groups = words::compared(discovery, &source.thresholds);
    let lead = format!("{comparisons}. {}.", sentence(words::COMPARED));
    html::section(
        "compared",
        "What was compared",
        &escape(&lead),
        &concat(groups.iter().map(group)),
    )
}

fn group(group: &Compared) -> String {
    let headings: Vec<String> = words::COMPARED_HEADINGS
        .iter()
        .map(|heading| match *heading {
            "set" | "compared with" | "outcome" => sentence(heading),
            number => format!("#{}", sentence(number)),
        })
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> =
        group.rows.iter().map(|row| row.iter().map(|cell| escape(cell)).collect()).collect();
    format!(
        "<details><summary>{}: {}</summary>{}</details>",
        escape(&group.title),
        rows.len(),
        table(&headings, &rows)
    )
}

/// The text with a large letter first.
fn sentence(text: &str) -> String {
    let mut rest = text.chars();
    let first = rest.next().into_iter().flat_map(char::to_uppercase);
    first.chain(rest).collect()
}
