//! The candidates of every rung, best first.

use missing_physics::Discovery;
use missing_physics::quantity::percent;
use missing_physics::report::Candidate;

use crate::html::{self, bar, escape, table};
use crate::words;

const LEAD: &str = "Every effect of the library, tried on what the model of the rung leaves. Gain: share of \
    the held-out squared error it would remove. p-value: chance of as large a gain by any effect \
    where none is missing.";

/// The section of the rankings, one foldable list per rung.
pub(super) fn section(discovery: &Discovery) -> String {
    let lists: String = discovery
        .ranking
        .iter()
        .enumerate()
        .filter(|(_, candidates)| !candidates.is_empty())
        .map(|(rung, candidates)| list(discovery, rung, candidates))
        .collect();
    if lists.is_empty() {
        return String::new();
    }
    html::section("ranking", "Which effect", LEAD, &lists)
}

fn list(discovery: &Discovery, rung: usize, candidates: &[Candidate]) -> String {
    let next = discovery.ladder.get(rung + 1).and_then(|next| next.added.as_deref());
    let outcome = next.map_or_else(
        || "nothing was added".to_owned(),
        |effect| format!("<b>{}</b> was added", escape(effect)),
    );
    let model = match discovery.ladder.get(rung).and_then(|rung| rung.added.as_deref()) {
        _ if rung == 0 => "For the base model".to_owned(),
        Some(effect) => format!("After {}", escape(effect)),
        None => format!("Rung {}", rung + 1),
    };
    let added: Vec<&str> =
        next.map(|names| names.split('+').map(str::trim).collect()).unwrap_or_default();
    let rows: Vec<Vec<String>> = candidates.iter().map(|c| row(c, &added)).collect();
    let open = if rung == 0 { " open" } else { "" };
    format!(
        "<details{open}><summary>{model}: {outcome}</summary>{}</details>",
        table(&["Effect", "Size", "", "#Gain", "#p-value"], &rows)
    )
}

fn row(candidate: &Candidate, added: &[&str]) -> Vec<String> {
    let chosen = added.contains(&candidate.effect.as_str());
    let name = escape(&candidate.effect);
    vec![
        if chosen { format!("<b>{name}</b>") } else { name },
        escape(&candidate.size),
        bar(candidate.gain, if candidate.p_value <= 0.05 { "held" } else { "quiet" }),
        percent(candidate.gain),
        escape(&words::p_value(candidate.p_value)),
    ]
}
