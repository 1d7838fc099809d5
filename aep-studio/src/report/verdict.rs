//! The verdict, on top and in words.

use missing_physics::Discovery;
use missing_physics::report::Verdict;

use crate::html::{concat, escape};
use crate::report::Source;
use crate::words;

/// Head of the page: verdict, summary, and the numbers that carry it.
pub(super) fn head(discovery: &Discovery, source: &Source) -> String {
    let tone = match discovery.verdict {
        Verdict::EffectsFound | Verdict::NothingMissing => "good",
        Verdict::Unexplained | Verdict::Ambiguous | Verdict::Stopped => "doubt",
    };
    format!(
        "<header class={tone}><p class=file>{}</p><h1>{}</h1><p class=summary>{}</p>{}</header>\n",
        escape(&source.name),
        headline(discovery),
        escape(&discovery.summary),
        numbers(discovery),
    )
}

/// Head of a page without a verdict: the model and its errors.
pub(super) fn plain_head(discovery: &Discovery, source: &Source) -> String {
    let effects = discovery.ladder.last().map(|rung| rung.effects.join(" + ")).unwrap_or_default();
    format!(
        "<header class=good><p class=file>{}</p><h1>How well the model fits</h1>\
         <p class=summary>{}</p>{}</header>\n",
        escape(&source.name),
        escape(&effects),
        numbers(discovery),
    )
}

fn headline(discovery: &Discovery) -> String {
    let verdict = words::verdict(discovery);
    if discovery.added.is_empty() {
        return escape(verdict);
    }
    let chips = concat(
        discovery.added.iter().map(|effect| format!("<span class=chip>{}</span>", escape(effect))),
    );
    format!("{}: {chips}", escape(verdict))
}

fn numbers(discovery: &Discovery) -> String {
    let Some(name) = words::main_error(discovery) else {
        return String::new();
    };
    let at = |rung: Option<&missing_physics::report::Rung>| {
        rung.and_then(|rung| rung.error.get(&name.key)).map(|error| error.validation)
    };
    let mut facts = Vec::new();
    let (first, last) = (at(discovery.ladder.first()), at(discovery.ladder.last()));
    if let Some(first) = first {
        facts.push((
            name.value(first),
            format!(
                "{} error of the {}",
                name.quantity,
                if discovery.ladder.len() > 1 { "base model" } else { "model" }
            ),
        ));
    }
    if let Some(last) = last.filter(|_| discovery.ladder.len() > 1) {
        facts.push((name.value(last), "with what was added".to_owned()));
    }
    if let Some(floor) = words::floor(discovery, &name) {
        facts.push((name.value(floor), "noise floor".to_owned()));
    }
    let facts = concat(facts.into_iter().map(|(value, text)| {
        format!("<div><b>{}</b><span>{}</span></div>", escape(&value), escape(&text))
    }));
    format!("<div class=numbers>{facts}</div>")
}
