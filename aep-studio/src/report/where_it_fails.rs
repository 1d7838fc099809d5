//! Where the model fails: shares of the error by regime, and what it depends on.

use missing_physics::Discovery;
use missing_physics::quantity::percent;
use missing_physics::report::{RegimeShare, Where};

use crate::html::{self, bar, escape, table};
use crate::words;

const LEAD: &str = "The error of the base model before anything was added, and what the last \
    model leaves. A low p-value says that the error depends on the coordinate for more than chance.";

/// From this p-value on a dependence may well be chance.
const CHANCE: f64 = 0.05;

/// The section of where it fails.
pub(super) fn section(discovery: &Discovery) -> String {
    let base = column("Base model", &discovery.regimes_base, &discovery.where_base);
    let changed = discovery.ladder.len() > 1;
    let last = if changed || base.is_empty() {
        column("Last model", &discovery.regimes, &discovery.where_it_fails)
    } else {
        String::new()
    };
    if base.is_empty() && last.is_empty() {
        return String::new();
    }
    html::section(
        "where",
        "Where it fails",
        LEAD,
        &format!("<div class=columns>{base}{last}</div>"),
    )
}

fn column(title: &str, regimes: &[RegimeShare], places: &[Where]) -> String {
    if regimes.is_empty() && places.is_empty() {
        return String::new();
    }
    format!("<div><h3>{}</h3>{}{}</div>", escape(title), shares(regimes), dependences(places))
}

fn shares(regimes: &[RegimeShare]) -> String {
    if regimes.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = regimes
        .iter()
        .map(|regime| {
            vec![
                escape(&regime.regime),
                bar(regime.share, "held"),
                percent(regime.share),
                percent(regime.time_share),
            ]
        })
        .collect();
    table(&["Regime", "", "#of the error", "#of the time"], &rows)
}

fn dependences(places: &[Where]) -> String {
    let (likely, others): (Vec<&Where>, Vec<&Where>) =
        places.iter().partition(|place| place.p_value <= CHANCE);
    let others = if others.is_empty() {
        String::new()
    } else {
        format!("<details><summary>It may be chance</summary>{}</details>", listed(&others))
    };
    listed(&likely) + &others
}

fn listed(places: &[&Where]) -> String {
    if places.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = places
        .iter()
        .map(|place| {
            let class = if place.p_value <= CHANCE { "held" } else { "quiet" };
            vec![
                format!("{}<small>{}</small>", escape(&place.coordinate), escape(&place.note)),
                bar(place.share, class),
                percent(place.share),
                escape(&words::p_value(place.p_value)),
            ]
        })
        .collect();
    table(&["Depends on", "", "#of the error", "#p-value"], &rows)
}
