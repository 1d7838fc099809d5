//! The candidates of every rung, best first.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::percent;
use missing_physics::report::{Candidate, Decision};

use crate::html::{self, bar, escape, table};
use crate::report::effects;
use crate::source::Source;
use crate::words;

const LEAD: &str = "Every effect of the library, tried on what the model before it leaves. Gain: share of \
    the held-out squared error it would remove. p-value: chance of as large a gain by any effect \
    where none is missing.";

const AHEAD: &str = "Every effect of the library, beside the model so far. Gain: held-out log-likelihood of the \
    prediction errors, in nats (to first order where the effect promised too little to be fitted). Share: \
    of the squared prediction error. p: chance of as large a gain by any effect where the errors are shifted \
    in time, so that they have nothing to do with the motion.";

/// The section of the rankings, one foldable list per rung.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    let lists: String = discovery
        .ranking
        .iter()
        .enumerate()
        .filter(|(_, candidates)| !candidates.is_empty())
        .map(|(rung, candidates)| list((discovery, source), rung, candidates))
        .collect();
    if lists.is_empty() {
        return String::new();
    }
    let ahead = discovery.ranking.iter().any(|candidates| is_ahead(candidates));
    html::section("ranking", "Which effect", if ahead { AHEAD } else { LEAD }, &lists)
}

/// Whether candidates are told by what they gain one sample ahead.
fn is_ahead(candidates: &[Candidate]) -> bool {
    candidates.iter().any(|candidate| candidate.nats.is_some())
}

fn list(
    (discovery, source): (&Discovery, &Source),
    rung: usize,
    candidates: &[Candidate],
) -> String {
    let at = |rung: usize| discovery.ladder.get(rung).map_or(&[][..], |rung| &rung.added);
    let (before, added) = (at(rung), at(rung + 1));
    let outcome = match added {
        [] => "nothing was added".to_owned(),
        effects => format!("<b>{}</b> was added", escape(&effects.join(" + "))),
    };
    let model = match before {
        _ if rung == 0 => "For the base model".to_owned(),
        [] => format!("After {rung} effects"),
        effects => format!("After {}", escape(&effects.join(" + "))),
    };
    let ahead = is_ahead(candidates);
    let rows = candidates.iter().map(|candidate| {
        let mut cells = row(candidate, added, ahead);
        cells[0] = effects::linked(&candidate.effect, source);
        if added.contains(&candidate.effect) {
            cells[0] = format!("<b>{}</b>", cells[0]);
        }
        if ahead {
            let said = came_of((discovery, source), rung, candidate);
            cells.push(escape(&said));
        }
        cells
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let headings: &[&str] = if ahead {
        &["Effect", "Size", "#Gain, nats", "", "#Share", "#p", "What came of it"]
    } else {
        &["Effect", "Size", "", "#Gain", "#p-value"]
    };
    let why = words::why_nothing(discovery, rung, &source.thresholds);
    let why = why.map(|why| format!("<p>Why: {}.</p>", escape(&why))).unwrap_or_default();
    let open = if rung == 0 { " open" } else { "" };
    format!(
        "<details{open}><summary>{model}: {outcome}</summary>{why}{}</details>",
        table(headings, &rows)
    )
}

/// What the comparison of a candidate with the model so far came to.
fn came_of(
    (discovery, source): (&Discovery, &Source),
    rung: usize,
    candidate: &Candidate,
) -> String {
    let adds = |decision: &&Decision| {
        let more = decision.candidate.iter().filter(|e| !decision.compared_with.contains(e));
        decision.rung == rung + 1 && more.eq([&candidate.effect])
    };
    // The last word counts.
    let decision = discovery.decisions.iter().rev().find(adds);
    decision.map_or_else(
        || "not among those that were compared".to_owned(),
        |decision| words::outcome(discovery, decision, &source.thresholds),
    )
}

fn row(candidate: &Candidate, added: &[String], ahead: bool) -> Vec<String> {
    let chosen = added.contains(&candidate.effect);
    let name = escape(&candidate.effect);
    let mut cells = vec![
        if chosen { format!("<b>{name}</b>") } else { name },
        escape(&words::size(&candidate.size)),
    ];
    if ahead {
        cells.push(escape(&candidate.nats.map_or_else(|| "-".to_owned(), words::nats)));
    }
    let p_value = if ahead { words::chance } else { words::p_value };
    cells.extend([
        bar(candidate.gain, if candidate.p_value <= 0.05 { "held" } else { "quiet" }),
        percent(candidate.gain),
        escape(&p_value(candidate.p_value)),
    ]);
    cells
}
