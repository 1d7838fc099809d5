//! The effects that the page names: what each is, its law with the data in it, and what it is mistaken for.

use missing_physics::Discovery;
use missing_physics::report::{Curve, Explained, Law, Plot, Rung};

use crate::html::{self, concat, escape};
use crate::plot;
use crate::source::Source;
use crate::words;

const LEAD: &str = "Those of the last model with what each contributes: the line is its law as fitted, the points are the same with \
    what the model leaves, which is what the data say of it (a component-plus-residual plot). Where the points leave the line, \
    the law does not fit there, or something else is missing.";

/// The section of the effects; nothing where nothing is known of them.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    if source.effects.is_empty() {
        return String::new();
    }
    let in_model = discovery.ladder.last().map_or(&[][..], |rung| &rung.effects);
    let of = |name: &String| source.effects.iter().find(|effect| effect.name == *name);
    // What was found comes before what the base model has anyway.
    let mut found: Vec<&Explained> = in_model.iter().filter_map(of).collect();
    found.sort_by_key(|effect| !discovery.added.contains(&effect.name));
    let laws = &source.samples.laws;
    let card = |effect: &&Explained| {
        let law = laws.iter().find(|law| law.effect == effect.name);
        let open = discovery.added.contains(&effect.name);
        folded(effect, &law.and_then(picture).unwrap_or_default(), open)
    };
    let others = source.effects.iter().filter(|effect| !in_model.contains(&effect.name));
    let others = concat(others.map(|effect| folded(effect, "", false)));
    let others = if others.is_empty() {
        others
    } else {
        format!("<h3>Effects that are not in the model</h3><div class=others>{others}</div>")
    };
    html::section("effects", "The effects", LEAD, &(concat(found.iter().map(card)) + &others))
}

/// The name of an effect as a link to what it is.
pub(super) fn linked(name: &str, source: &Source) -> String {
    if source.effects.iter().any(|effect| effect.name == name) {
        return format!("<a href=\"#{}\">{}</a>", place(name), escape(name));
    }
    escape(name)
}

/// What a model is called, with links to what its effects are.
pub(super) fn model(rung: &Rung, source: &Source) -> String {
    if rung.added.is_empty() {
        return escape(&words::rung(rung));
    }
    let added: Vec<String> = rung.added.iter().map(|name| linked(name, source)).collect();
    format!("+ {}", added.join(" + "))
}

/// The id of an effect.
fn place(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!("effect-{}", name.chars().map(safe).collect::<String>())
}

fn folded(effect: &Explained, picture: &str, open: bool) -> String {
    let open = if open { " open" } else { "" };
    let mut rows = Vec::new();
    let parameters = effect.parameters.iter();
    let parameters: Vec<String> = parameters
        .map(|[name, meaning]| format!("<code>{}</code> {}", escape(name), escape(meaning)))
        .collect();
    for (title, content) in [
        ("adds to the model", format!("<code>{}</code>", escape(&effect.equation))),
        ("with", parameters.join("; ")),
        ("in residuals", escape(&effect.shows)),
        ("mistaken for", mistaken(effect)),
        ("source", escape(&effect.reference)),
    ] {
        if !content.is_empty() && content != "<code></code>" {
            rows.push(format!("<dt>{title}</dt><dd>{content}</dd>"));
        }
    }
    format!(
        "<details class=effect id=\"{}\"{open}><summary><b>{}</b>: {}</summary><div class=side><dl>{}</dl>{picture}</div></details>\n",
        place(&effect.name),
        escape(&effect.name),
        escape(&effect.title),
        rows.concat(),
    )
}

fn mistaken(effect: &Explained) -> String {
    let each = effect.mistaken_for.iter();
    let each = each.map(|[others, apart]| {
        format!("<b>{}</b>; to tell them apart, {}", escape(others), escape(apart))
    });
    each.collect::<Vec<_>>().join("<br>")
}

/// The law with the data in it.
fn picture(law: &Law) -> Option<String> {
    let curve = |label: &str, of: fn(&missing_physics::report::LawBin) -> f64| Curve {
        label: label.to_owned(),
        x: law.bins.iter().map(|bin| bin.at).collect(),
        y: law.bins.iter().map(of).collect(),
    };
    let [quantity, unit] = &law.quantity;
    let against = if law.against_motion { ", against the motion" } else { "" };
    let plot = Plot {
        title: format!("What {} contributes", law.effect),
        x_label: format!("{} / {}", law.along, law.unit),
        y_label: format!("{quantity}{against} / {unit}"),
        curves: vec![
            curve("the data (measured) (points)", |bin| bin.data),
            curve("the law (last model)", |bin| bin.law),
        ],
    };
    plot::figure(&plot)
}
