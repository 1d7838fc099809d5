//! The parameters of the last model, and how they came there rung by rung.

use std::collections::BTreeSet;

use missing_physics::Discovery;
use missing_physics::measurement::quantity::number;
use missing_physics::report::{Estimate, Rung};

use crate::html::{self, escape, table};
use crate::source::Source;
use crate::words;

const LEAD: &str = "Values of the last model with their 95 % intervals, then the values in each \
    model: a parameter that moves when an effect is added had been standing in for it.";

/// The section of the parameters.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    let Some(last) = discovery.ladder.last().filter(|rung| !rung.parameters.is_empty()) else {
        return String::new();
    };
    let history =
        if discovery.ladder.len() > 1 { history(&discovery.ladder) } else { String::new() };
    html::section("parameters", "Parameters", LEAD, &(values(last) + &together(source) + &history))
}

fn values(rung: &Rung) -> String {
    let rows: Vec<Vec<String>> = rung
        .parameters
        .iter()
        .map(|(name, estimate)| {
            vec![
                format!("<code>{}</code>", escape(name)),
                number(estimate.value),
                escape(&estimate.unit),
                whisker(estimate),
                interval(estimate),
            ]
        })
        .collect();
    table(&["Parameter", "#Value", "Unit", "", "95 % interval"], &rows)
}

/// What parameters make together.
fn together(source: &Source) -> String {
    let told = words::combinations(&source.together);
    if told.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> =
        told.iter().map(|row| row.iter().map(|cell| escape(cell)).collect()).collect();
    let note = words::not_alone(&source.together)
        .map(|note| format!("<p>{}.</p>", escape(&note)))
        .unwrap_or_default();
    format!(
        "<h3>What they make together</h3>{}{note}",
        table(&["Quantity", "What it is", "#Value", "Unit", "95 % interval"], &rows)
    )
}

fn interval(estimate: &Estimate) -> String {
    let text = escape(&words::interval(estimate));
    if estimate.identifiable { text } else { format!("<span class=warn>{text}</span>") }
}

/// The interval relative to the value, drawn to the scale 0.5 .. 1.5 of it.
fn whisker(estimate: &Estimate) -> String {
    let place = |value: f64| (50.0 + 100.0 * (value / estimate.value - 1.0)).clamp(0.0, 100.0);
    if !estimate.identifiable || estimate.value == 0.0 || !estimate.value.is_finite() {
        return String::new();
    }
    let (a, b) = (place(estimate.low), place(estimate.high));
    let (left, width) = (a.min(b), (b - a).abs().max(1.0));
    if !(left.is_finite() && width.is_finite()) {
        return String::new();
    }
    format!(
        "<span class=whisker title=\"scale: half to one and a half times the value\">\
         <span style=\"left:{left:.1}%;width:{width:.1}%\"></span></span>"
    )
}

fn history(ladder: &[Rung]) -> String {
    let names: BTreeSet<&String> = ladder.iter().flat_map(|rung| rung.parameters.keys()).collect();
    let mut headings = vec!["Parameter".to_owned()];
    headings.extend(ladder.iter().map(|rung| format!("#{}", words::rung(rung))));
    headings.push("Unit".to_owned());
    let rows: Vec<Vec<String>> = names
        .into_iter()
        .map(|name| {
            let estimates = ladder.iter().map(|rung| rung.parameters.get(name));
            let unit = estimates.clone().flatten().next().map(|e| escape(&e.unit));
            let mut cells = vec![format!("<code>{}</code>", escape(name))];
            cells.extend(estimates.map(|e| e.map(|e| number(e.value)).unwrap_or_default()));
            cells.push(unit.unwrap_or_default());
            cells
        })
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    format!("<details><summary>In every model</summary>{}</details>", table(&headings, &rows))
}
