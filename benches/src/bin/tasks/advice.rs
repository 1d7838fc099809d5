//! What the advice of [`aep_core::methods::recommend`] is worth on the table.

use std::fmt::Write;

use aep_core::methods::recommend;

use crate::case::Case;
use crate::result::{Cell, Group, best, cell};

/// The advice for each task, and its expected evaluations beside those of our best method.
pub fn table(cases: &[Case], cells: &[Cell], per_parameter: u64) -> String {
    let mut text =
        String::from("\n## The advice\n\nExpected evaluations over those of our best method.\n\n");
    text.push_str("| task | advice | times the best | best |\n|---|---|---:|---|\n");
    for case in cases {
        let advice = recommend(&case.facts, case.budget(per_parameter)).method.name;
        let (Some(own), Some(best)) =
            (cell(cells, &case.name, advice), best(cells, &case.name, Group::Ours))
        else {
            continue;
        };
        let times = own.expected() / best.expected();
        let times = if times.is_finite() { format!("{times:.2}") } else { "-".into() };
        let _ = writeln!(text, "| {} | {advice} | {times} | {} |", case.name, best.method);
    }
    text
}
