//! The axes of one file side by side: a row each.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::percent;

use super::{errors, is_cut, times, verdict};

/// Headings of the table; those that begin with `#` are of numbers.
pub const AXES_HEADINGS: [&str; 7] = [
    "axis",
    "#base error (x sensors)",
    "what it lacks",
    "#error after",
    "#force error",
    "#after",
    "verdict",
];

/// What became of an axis.
#[derive(Clone, Copy, Debug)]
pub enum AxisResult<'a> {
    /// It was searched.
    Found(&'a Discovery),
    /// It could not be.
    Refused(&'a str),
    /// Its search was not done before the end.
    NotDone,
}

/// The cells of an axis.
pub fn axis_row(name: &str, result: AxisResult<'_>) -> [String; 7] {
    let dash = || "-".to_owned();
    let discovery = match result {
        AxisResult::Found(discovery) => discovery,
        AxisResult::Refused(_) | AxisResult::NotDone => {
            let said = match result {
                AxisResult::Refused(why) => format!("not searched: {why}"),
                _ => "not done".to_owned(),
            };
            return [name.to_owned(), dash(), dash(), dash(), dash(), dash(), said];
        }
    };
    let (first, last) = (discovery.ladder.first(), discovery.ladder.last());
    let relative = errors(discovery).into_iter().find(super::ErrorName::is_relative);
    let of = |rung: Option<&missing_physics::report::Rung>| {
        let error = rung?.error.get(&relative.as_ref()?.key)?;
        Some(percent(error.validation)).filter(|_| error.validation.is_finite())
    };
    let budget = discovery.budget;
    let added = if discovery.added.is_empty() { dash() } else { discovery.added.join(" + ") };
    let mut said = verdict(discovery).to_owned();
    match budget {
        _ if is_cut(discovery) => said.push_str(", cut"),
        Some(budget) if !budget.complete && !discovery.added.is_empty() => {
            said.push_str(", incomplete");
        }
        _ => {}
    }
    [
        name.to_owned(),
        budget.map_or_else(dash, |budget| times(budget.base)),
        added,
        budget.map_or_else(dash, |budget| times(budget.last)),
        of(first).unwrap_or_else(dash),
        of(last).unwrap_or_else(dash),
        said,
    ]
}
