//! What the advice of [`aep_core::methods::recommend`] is worth on the table.

use std::fmt::Write;

use aep_core::methods::recommend;

use crate::case::Case;
use crate::result::{Cell, Group, best, cell};

/// The advice for each task, and its expected evaluations beside those of our best method; where residuals are told, those of
/// descents too.
pub fn table(cases: &[Case], cells: &[Cell], per_parameter: u64) -> String {
    let mut text = String::from("\n## The advice\n\nExpected evaluations.\n\n");
    text.push_str("| task | advice | evaluations | times our best | our best | with residuals: polish | scipy least_squares |\n");
    text.push_str("|---|---|---:|---:|---|---:|---:|\n");
    for case in cases {
        let advice = recommend(&case.facts, case.budget(per_parameter)).method.name;
        let (Some(own), Some(best)) =
            (cell(cells, &case.name, advice), best(cells, &case.name, Group::Ours))
        else {
            continue;
        };
        let number = |number: f64, digits: usize| {
            if number.is_finite() { format!("{number:.digits$}") } else { "-".to_owned() }
        };
        let told = |method| {
            cell(cells, &case.name, method).map_or(String::new(), |told| number(told.expected(), 0))
        };
        let _ = writeln!(
            text,
            "| {} | {advice} | {} | {} | {} | {} | {} |",
            case.name,
            number(own.expected(), 0),
            number(own.expected() / best.expected(), 2),
            best.method,
            told("polish"),
            told("scipy least_squares")
        );
    }
    text
}
