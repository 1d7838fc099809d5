//! What an identification by simulation found.

use friction_ident::Quantity;
use friction_ident::identify::{FoundParameter, Searched};
use missing_physics::measurement::quantity::{number, quantity};

use super::style::dim;
use super::table::{Align, Table};

/// The parameters as a table, and the error.
pub fn simulated(found: &Searched) -> String {
    let mut table = Table::new(&[
        ("parameter", Align::Left),
        ("value", Align::Right),
        ("unit", Align::Left),
        ("95 % interval", Align::Left),
    ]);
    for parameter in found.parameters() {
        let interval = interval(&parameter);
        let FoundParameter { free, value, unit, .. } = parameter;
        table.row([free.address.clone(), number(value), unit.to_owned(), interval]);
    }
    let rms = quantity(found.rms, found.model.axis().unit(Quantity::Length));
    let end = format!("{} searches, position error {rms} rms", found.searches);
    format!("{}\n {}\n", table.text(), dim(&end))
}

fn interval(found: &FoundParameter<'_>) -> String {
    let Some(interval) = found.interval else { return "stopped before it was known".to_owned() };
    let (low, high) = (number(interval.low), number(interval.high));
    if interval.identifiable {
        return format!("{low} .. {high}");
    }
    let from_end = interval.low <= found.free.low;
    let to_end = interval.high >= found.free.high;
    let fits = match (from_end, to_end) {
        (true, false) => format!("all below {high} fit"),
        (false, true) => format!("all above {low} fit"),
        _ => format!("{low} .. {high} fit"),
    };
    format!("not identifiable from this data ({fits} as well)")
}
