//! The error in several views side by side.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::View;

use crate::html::{self, concat, escape, table};
use crate::words;

const LEAD: &str = "The same model, judged in different ways. Fit % is 100 (1 - |e| / |y - mean y|); numbers \
    are of held-out data.";

/// The section of the views; nothing where they were not asked for.
pub(super) fn section(discovery: &Discovery) -> String {
    if discovery.views.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = discovery.views.iter().map(row).collect();
    let headings = [
        "View",
        "#rms",
        "#fitted data",
        "#noise floor",
        "#Relative",
        "#Fit %",
        "#Variance accounted for %",
    ];
    html::section("views", "In several views", LEAD, &(table(&headings, &rows) + &notes(discovery)))
}

fn row(view: &View) -> Vec<String> {
    let (out, fitted) = (&view.metrics.validation, &view.metrics.fit);
    let hundredths =
        |value: Option<f64>| value.map(|value| format!("{value:.2}")).unwrap_or_default();
    vec![
        format!("{}<small>{}</small>", escape(&view.name), escape(&words::compares(view))),
        escape(&quantity(out.rms, &view.unit)),
        escape(&quantity(fitted.rms, &view.unit)),
        view.floor.map(|floor| escape(&quantity(floor, &view.unit))).unwrap_or_default(),
        out.relative.map(|share| escape(&percent(share))).unwrap_or_default(),
        hundredths(out.fit_percent),
        hundredths(out.variance_accounted_for_percent),
    ]
}

fn notes(discovery: &Discovery) -> String {
    let of_views = discovery.views.iter().filter_map(words::caveat);
    let items = concat(
        of_views
            .chain(words::notes(discovery))
            .map(|note| format!("<li class=warning>{}</li>", escape(&note))),
    );
    if items.is_empty() { items } else { format!("<ul class=findings>{items}</ul>") }
}
