//! Where a model fails, as tables.

use aep_studio::words;
use missing_physics::measurement::quantity::percent;
use missing_physics::report::{RegimeShare, Where};

use super::bars::{BAR, bar};
use super::style::dim;
use super::table::{Align, Table};

/// From this p-value on a dependence may well be chance.
const CHANCE: f64 = 0.05;
/// How the notes of most coordinates begin.
const MEAN_ERROR: &str = "largest mean error";

/// Shares by regime, `of` what.
pub fn regimes(regimes: &[RegimeShare], of: &str) -> String {
    if regimes.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        ("regime", Align::Left),
        ("", Align::Bar),
        (of, Align::Right),
        ("of the time", Align::Right),
    ]);
    for regime in regimes {
        table.row([
            regime.regime.clone(),
            bar(regime.share, BAR),
            percent(regime.share),
            percent(regime.time_share),
        ]);
    }
    table.text()
}

/// What the error depends on; what may well be chance is only counted.
pub fn where_it_fails(places: &[Where]) -> String {
    const MOST: usize = 6;
    let likely: Vec<&Where> = places.iter().filter(|p| p.p_value <= CHANCE).take(MOST).collect();
    let rest = places.len() - likely.len();
    let others = |text: String| match rest {
        0 => text,
        rest => {
            text + &format!(" {}\n", dim(&format!("{rest} other coordinates show less or nothing")))
        }
    };
    if likely.is_empty() {
        return others(String::new());
    }
    let mut table = Table::new(&[
        ("depends on", Align::Left),
        ("", Align::Bar),
        ("share", Align::Right),
        ("p-value", Align::Right),
        (MEAN_ERROR, Align::Left),
    ]);
    for place in likely {
        table.row([
            place.coordinate.clone(),
            bar(place.share, BAR),
            percent(place.share),
            words::p_value(place.p_value),
            // The heading says it once for all.
            words::largest(place),
        ]);
    }
    others(table.text())
}
