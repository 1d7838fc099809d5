//! What the advice of [`aep_core::methods::recommend`] is worth on the table.

use std::fmt::Write;

use aep_core::methods::recommend;

use crate::case::Case;
use crate::result::{Cell, Group, TOLD, best, cell, number};

/// The advice for each task, and its expected evaluations beside those of our best method; where the task has residuals,
/// both are told them.
pub fn table(cases: &[Case], cells: &[Cell], per_parameter: u64) -> String {
    let mut text = String::from("\n## The advice\n\nExpected evaluations.\n\n");
    text.push_str("| task | advice | evaluations | times our best | our best |\n");
    text.push_str("|---|---|---:|---:|---|\n");
    for case in cases {
        let advice = recommend(&case.facts, case.budget(per_parameter)).method.name;
        let told = case.facts.residuals && advice == "aep-lineages";
        let own = cell(cells, &case.name, if told { TOLD } else { advice });
        let (Some(own), Some(searched)) = (own, best(cells, &case.name, Group::Ours)) else {
            continue;
        };
        let polished = cell(cells, &case.name, "polish").filter(|_| told);
        let all = [Some(own), Some(searched), polished].into_iter().flatten();
        let Some(best) = all.min_by(|a, b| a.expected().total_cmp(&b.expected())) else { continue };
        let (evaluations, times) = (own.expected(), own.expected() / best.expected());
        let _ = writeln!(
            text,
            "| {} | {} | {} | {times:.2} | {} |",
            case.name,
            own.method,
            number(evaluations),
            best.method
        );
    }
    text
}
