//! What other recordings say of a discovery.

use std::fmt::Write;

use aep_studio::words;
use missing_physics::Discovery;
use missing_physics::confirm::Confirmation;
use missing_physics::quantity::percent;

use super::style::{dim, heading};
use super::table::{Align, Table};

/// The rungs of a discovery on recordings called `name` that had no part in it.
pub fn confirmation(discovery: &Discovery, rungs: &[Confirmation], name: &str) -> String {
    let names = words::errors(discovery);
    let headings: Vec<String> = names.iter().map(words::ErrorName::heading).collect();
    let mut columns = vec![("rung", Align::Left)];
    columns.extend(headings.iter().map(|heading| (heading.as_str(), Align::Right)));
    columns.extend([
        ("holds", Align::Left),
        ("gain anew", Align::Right),
        ("p-value", Align::Right),
        ("place", Align::Right),
    ]);
    let mut table = Table::new(&columns);
    let dash = || "-".to_owned();
    for (rung, here) in discovery.ladder.iter().zip(rungs) {
        let errors = names
            .iter()
            .map(|name| here.error.get(&name.key).map_or_else(dash, |error| name.value(*error)));
        let holds =
            here.holds.map_or_else(dash, |holds| if holds { "yes" } else { "no" }.to_owned());
        let gain = here.gain.map_or_else(dash, percent);
        let p_value = here.p_value.map_or_else(dash, words::p_value);
        let place = here.place.map_or_else(dash, |place| place.to_string());
        let cells = errors.chain([holds, gain, p_value, place]);
        table.row(std::iter::once(words::rung(rung)).chain(cells));
    }
    let mut text = heading(&format!("On other recordings: {name}")) + &table.text();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        " {}",
        dim(
            "parameters as found, nothing fitted; 'gain anew': screened there with the model below \
             it identified anew, 'place' among the likely"
        )
    );
    for here in rungs {
        if let (Some(effect), Some(holds)) = (&here.added, here.holds) {
            let said = if holds { "confirmed" } else { "not confirmed" };
            let _ = writeln!(text, " {effect} is {said} by the other recordings.");
        }
    }
    text
}
