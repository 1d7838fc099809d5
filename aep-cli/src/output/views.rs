//! Errors in several views side by side.

use std::fmt::Write;

use aep_studio::words;
use friction_ident::family::NoView;
use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Disagreement, View};

use super::style::dim;
use super::table::{Align, Table};

/// The views of one or more models, held-out data first.
pub fn views(models: &[(String, Vec<View>)]) -> String {
    let several = models.len() > 1;
    let mut columns = vec![("view", Align::Left)];
    if several {
        columns.push(("model", Align::Left));
    }
    columns.extend([
        ("rms", Align::Right),
        ("fitted", Align::Right),
        ("floor", Align::Right),
        ("relative", Align::Right),
        ("fit %", Align::Right),
        ("variance %", Align::Right),
    ]);
    let mut table = Table::new(&columns);
    let mut names: Vec<&str> = Vec::new();
    for view in models.iter().flat_map(|(_, views)| views) {
        if !names.contains(&view.name.as_str()) {
            names.push(&view.name);
        }
    }
    for name in names {
        let of_models = models.iter().filter_map(|(model, views)| {
            Some((model, views.iter().find(|view| view.name == name)?))
        });
        for (k, (model, view)) in of_models.enumerate() {
            let first = if k == 0 { name.to_owned() } else { String::new() };
            let model = several.then(|| model.clone());
            table.row(std::iter::once(first).chain(model).chain(numbers(view)));
        }
    }
    table.text()
        + &format!(
            " {}\n",
            dim("on held-out data; fit % = 100 (1 - |e| / |y - mean y|), variance % accounted for")
        )
}

fn numbers(view: &View) -> [String; 6] {
    let (out, fitted) = (&view.metrics.validation, &view.metrics.fit);
    let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let hundredths = |value: Option<f64>| or_dash(value.map(|value| format!("{value:.2}")));
    [
        quantity(out.rms, &view.unit),
        quantity(fitted.rms, &view.unit),
        or_dash(view.floor.map(|floor| quantity(floor, &view.unit))),
        or_dash(out.relative.map(percent)),
        hundredths(out.fit_percent),
        hundredths(out.variance_accounted_for_percent),
    ]
}

/// What the user should know about the views: what speaks against each, once, where they disagree, and which are missing.
pub fn warnings(
    between: &[Disagreement],
    models: &[(String, Vec<View>)],
    missing: &[NoView],
) -> String {
    let mut said: Vec<String> = between.iter().map(words::disagreement).collect();
    let mut warned: Vec<&str> = Vec::new();
    for view in models.iter().flat_map(|(_, views)| views) {
        // What holds for a view holds for it with the next model, too.
        let Some(text) = words::caveat(view).filter(|_| !warned.contains(&view.name.as_str()))
        else {
            continue;
        };
        warned.push(&view.name);
        said.push(format!("{}: {text}", view.name));
    }
    said.extend(missing.iter().map(ToString::to_string));
    let mut text = String::new();
    for line in &said {
        // Writing to a string cannot fail.
        let _ = writeln!(text, " {} {line}", dim("note:"));
    }
    text
}
