//! Where the model fails: shares of the error by regime, and what it depends on.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::percent;
use missing_physics::report::{RegimeShare, Where};

use super::missing_force;
use crate::html::{self, bar, escape, table};
use crate::words;

const LEAD: &str = "The error of the base model before anything was added, and what the last \
    model leaves. A low p-value says that the error depends on the coordinate for more than chance.";

/// From this p-value on a dependence may well be chance.
const CHANCE: f64 = 0.05;

/// The section of where it fails.
pub(super) fn section(discovery: &Discovery) -> String {
    let of = words::shared_out(discovery, discovery.missing_force_base.as_ref());
    let base = column("Base model", &of, &discovery.regimes_base, &discovery.where_base);
    let changed = discovery.ladder.len() > 1;
    let last = if changed || base.is_empty() {
        let of = words::shared_out(discovery, discovery.missing_force.as_ref());
        column("Last model", &of, &discovery.regimes, &discovery.where_it_fails)
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
        &format!("{}<div class=columns>{base}{last}</div>", missing_force::shown(discovery)),
    )
}

fn column(title: &str, of: &str, regimes: &[RegimeShare], places: &[Where]) -> String {
    if regimes.is_empty() && places.is_empty() {
        return String::new();
    }
    let (shares, places) = (shares(of, regimes), dependences(places));
    format!("<div><h3>{}</h3>{shares}{places}</div>", escape(title))
}

fn shares(of: &str, regimes: &[RegimeShare]) -> String {
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
    table(&["Regime", "", &format!("#{of}"), "#of the time"], &rows)
}

fn dependences(places: &[Where]) -> String {
    let (likely, others): (Vec<&Where>, Vec<&Where>) =
        places.iter().partition(|place| place.p_value <= CHANCE);
    let others = if others.is_empty() {
        String::new()
    } else {
        format!(
            "<details><summary>Dependences that chance alone makes more often than once in 20 (p above 0.05)</summary>{}</details>",
            listed(&others)
        )
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
                format!(
                    "{}<small>{}</small>",
                    escape(&place.coordinate),
                    escape(&words::pattern(place))
                ),
                bar(place.share, class),
                percent(place.share),
                escape(&words::p_value(place.p_value)),
            ]
        })
        .collect();
    table(&["Depends on", "", "#of the error", "#p-value"], &rows)
}
