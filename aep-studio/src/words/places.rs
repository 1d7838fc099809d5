//! How a dependence of the error on a coordinate is told.

use missing_physics::measurement::quantity::quantity;
use missing_physics::report::{Pattern, Where};

/// What it looks like: `largest mean error +2.00 N near 3.00 mm`; empty where nothing is there.
pub fn pattern(place: &Where) -> String {
    let (of_error, of_place) = (&place.error_unit, &place.unit);
    match place.pattern {
        None => String::new(),
        Some(Pattern::Mean { .. }) => format!("largest mean error {}", largest(place)),
        Some(Pattern::Step { height, time }) => {
            format!("a step of {height:+.3} {of_error} at {time:.2} {of_place}")
        }
        Some(Pattern::Sine { amplitude, period }) => {
            let (amplitude, period) = (quantity(amplitude, of_error), quantity(period, of_place));
            format!("a swing of {amplitude} with a period of {period}")
        }
    }
}

/// The same without what it is, where a heading says that: `+2.00 N near 3.00 mm`.
pub fn largest(place: &Where) -> String {
    let Some(Pattern::Mean { error, at, against_motion }) = place.pattern else {
        return pattern(place);
    };
    let opposes = if against_motion { " against the motion" } else { "" };
    let sign = if error > 0.0 { "+" } else { "" };
    let (size, near) = (quantity(error, &place.error_unit), quantity(at, &place.unit));
    format!("{sign}{size}{opposes} near {near}")
}
