//! The statements of the paper beside ours, as CSV, Markdown and HTML.

use std::fmt::Write;

use aep_problems::paper::Claim;
use aep_studio::report::plain::{self, Part};

use super::reproduce_figure::quote;
use crate::report::command;

const HEADINGS: [&str; 6] = ["figure", "about", "the paper prints", "here", "verdict", "why"];

fn cells<'a>(row: &'a (&str, Claim), verdict: &'a str) -> [&'a str; 6] {
    let (figure, claim) = row;
    let why = claim.reason.as_deref().unwrap_or_default();
    [figure, &claim.about, &claim.paper, &claim.ours, verdict, why]
}

/// One line per statement.
pub fn csv(rows: &[(&str, Claim)]) -> String {
    let mut text = String::from("figure,about,paper,ours,verdict,reason\n");
    for row in rows {
        let line = cells(row, &row.1.verdict.to_string()).map(quote).join(",");
        let _ = writeln!(text, "{line}");
    }
    text
}

/// A Markdown table.
pub fn markdown(rows: &[(&str, Claim)]) -> String {
    let mut text = format!("| {} |\n|{}\n", HEADINGS.join(" | "), "---|".repeat(HEADINGS.len()));
    for row in rows {
        let clean = |cell: &str| cell.replace('|', "\\|").replace('\n', " ");
        let line = cells(row, &row.1.verdict.to_string()).map(clean).join(" | ");
        let _ = writeln!(text, "| {line} |");
    }
    text
}

/// A page: the table, then the plots of each figure.
pub fn html(rows: &[(&str, Claim)], figures: Vec<Part>) -> String {
    let agreeing = rows.iter().filter(|(_, claim)| claim.agrees()).count();
    let summary = format!("{agreeing} of {} statements agree.", rows.len());
    let row =
        |row: &(&str, Claim)| cells(row, &row.1.verdict.to_string()).map(str::to_owned).to_vec();
    let table = Part {
        id: "table".to_owned(),
        title: "The table".to_owned(),
        headings: HEADINGS.map(str::to_owned).to_vec(),
        rows: rows.iter().map(row).collect(),
        ..Part::default()
    };
    let parts: Vec<Part> = std::iter::once(table)
        .chain(figures.into_iter().filter(|part| !part.figures.is_empty()))
        .collect();
    plain::page("The paper's statements and ours", &summary, &parts, &command())
}
