//! What this data cannot tell: effects that look alike, sizes that would have been missed, notes.

use missing_physics::Discovery;

use crate::html::{self, concat, escape, table};
use crate::words;

/// The section of the limits; nothing where there are none.
pub(super) fn section(discovery: &Discovery) -> String {
    let body = ambiguous(discovery) + &generic(discovery) + &limits(discovery) + &notes(discovery);
    if body.is_empty() {
        return String::new();
    }
    html::section("limits", "What this data cannot tell", "", &body)
}

fn ambiguous(discovery: &Discovery) -> String {
    concat(discovery.ambiguous.iter().map(|choice| {
        let names: Vec<String> =
            choice.effects.iter().map(|name| format!("<b>{}</b>", escape(name))).collect();
        format!(
            "<div class=doubt><p>{}: which of them is at work does not follow from this data.</p>\
                 <p>The experiment that would tell: {}</p></div>",
            names.join(" or "),
            escape(&words::experiment(choice))
        )
    }))
}

fn generic(discovery: &Discovery) -> String {
    let Some(term) = &discovery.generic_term else { return String::new() };
    format!(
        "<details><summary>An effect file that describes what remains without explaining it</summary>\
             <pre>{}</pre></details>",
        escape(term)
    )
}

fn limits(discovery: &Discovery) -> String {
    if discovery.detection_limits.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = discovery
        .detection_limits
        .iter()
        .map(|(effect, size)| vec![escape(effect), escape(&words::detection_limit(size))])
        .collect();
    format!(
        "<details open><summary>Effects that were not found, and the size at which they would have been</summary>{}</details>",
        table(&["Effect", "Would have been found above"], &rows)
    )
}

fn notes(discovery: &Discovery) -> String {
    let notes = words::notes(discovery);
    if notes.is_empty() {
        return String::new();
    }
    let items = concat(notes.iter().map(|note| format!("<li>{}</li>", escape(note))));
    format!("<h3>Notes</h3><ul>{items}</ul>")
}
