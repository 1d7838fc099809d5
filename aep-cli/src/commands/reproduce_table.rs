//! The statements of the paper beside ours, as CSV, Markdown and HTML.

use std::fmt::Write;

use aep_problems::paper::Claim;
use aep_studio::escape;

use super::reproduce::quote;

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

/// A page of its own.
pub fn html(rows: &[(&str, Claim)]) -> String {
    let row_of = |tag: &str, cells: [&str; 6]| {
        let cells = cells.map(|cell| format!("<{tag}>{}</{tag}>", escape(cell)));
        format!("<tr>{}</tr>\n", cells.concat())
    };
    let body: Vec<String> =
        rows.iter().map(|row| row_of("td", cells(row, &row.1.verdict.to_string()))).collect();
    format!(
        "<!doctype html>\n<html lang=en><meta charset=utf-8><title>The paper and here</title>\n\
         <style>:root{{color-scheme:light dark}}body{{font:15px/1.4 system-ui,sans-serif;margin:2em}}\
         table{{border-collapse:collapse}}th,td{{text-align:left;vertical-align:top;\
         padding:.3em .8em;border-bottom:1px solid #8884}}</style>\n\
         <h1>The paper's statements and ours</h1>\n<table><thead>{}</thead><tbody>\n{}</tbody></table>\n</html>\n",
        row_of("th", HEADINGS),
        body.concat()
    )
}
