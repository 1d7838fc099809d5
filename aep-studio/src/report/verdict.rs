//! The verdict, on top and in words.

use missing_physics::Discovery;
use missing_physics::report::{Budget, Verdict};

use crate::html::{concat, escape};
use crate::report::effects;
use crate::source::Source;
use crate::words;

/// Head of the page: verdict, summary, and the numbers that carry it.
pub(super) fn head(discovery: &Discovery, source: &Source) -> String {
    let tone = match discovery.verdict {
        Verdict::EffectsFound | Verdict::NothingMissing if !is_doubtful(discovery) => "good",
        _ => "doubt",
    };
    format!(
        "<header class={tone}><p class=file>{}</p><h1>{}</h1>{}<p class=summary>{}</p>{}</header>\n",
        escape(&source.name),
        headline(discovery, source),
        // The summary beside a first screen says it, too.
        if source.samples.time.is_empty() { completeness(discovery) } else { String::new() },
        escape(&words::summary(discovery)),
        beside(discovery, source),
    )
}

/// The numbers, where no first screen has them.
fn beside(discovery: &Discovery, source: &Source) -> String {
    if source.samples.time.is_empty() { numbers(discovery) } else { String::new() }
}

/// Head of a page without a verdict: the model and its errors.
pub(super) fn plain_head(discovery: &Discovery, source: &Source) -> String {
    let effects = discovery.ladder.last().map(|rung| rung.effects.join(" + ")).unwrap_or_default();
    format!(
        "<header class=good><p class=file>{}</p><h1>How well the model fits</h1>\
         <p class=summary>{}</p>{}</header>\n",
        escape(&source.name),
        escape(&effects),
        beside(discovery, source),
    )
}

/// Whether the search was cut or the model leaves more than the sensors make.
fn is_doubtful(discovery: &Discovery) -> bool {
    words::is_cut(discovery) || discovery.budget.is_some_and(|budget| !budget.complete)
}

fn headline(discovery: &Discovery, source: &Source) -> String {
    let verdict = words::verdict(discovery);
    if discovery.added.is_empty() {
        return escape(verdict);
    }
    let chips = concat(
        discovery
            .added
            .iter()
            .map(|effect| format!("<span class=chip>{}</span>", effects::linked(effect, source))),
    );
    format!("{}: {chips}", escape(verdict))
}

fn completeness(discovery: &Discovery) -> String {
    let said = words::completeness(discovery);
    said.map(|text| format!("<p class=budget>The model is {}.</p>", escape(&text)))
        .unwrap_or_default()
}

/// What the models leave one sample ahead.
fn ahead(budget: &Budget, several: bool) -> Vec<(String, String)> {
    let times = |value: f64| format!("{} ×", words::times(value));
    let first = if several { "the base model" } else { "the model" };
    let mut facts = vec![(times(budget.base), format!("what the sensors make is left by {first}"))];
    if several {
        facts.push((times(budget.last), "with what was added".to_owned()));
    }
    facts
}

fn numbers(discovery: &Discovery) -> String {
    let Some(name) = words::main_error(discovery) else {
        return String::new();
    };
    let at = |rung: Option<&missing_physics::report::Rung>| {
        rung.and_then(|rung| rung.error.get(&name.key)).map(|error| error.validation)
    };
    let several = discovery.ladder.len() > 1;
    let mut facts = discovery.budget.map(|budget| ahead(&budget, several)).unwrap_or_default();
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
