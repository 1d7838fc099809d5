//! Parameters of a rung as tables.

use aep_studio::words;
use missing_physics::measurement::quantity::number;
use missing_physics::report::{Combinations, Rung};

use super::style::{dim, wrapped};
use super::table::{Align, Table};
use crate::args::library;

/// The parameters of a rung with their intervals: the mass, then effect by effect in the order of the
/// model, as their tables list them.
pub fn parameters(rung: &Rung) -> String {
    let mut table = Table::new(&[
        ("parameter", Align::Left),
        ("value", Align::Right),
        ("unit", Align::Left),
        ("95 % interval", Align::Left),
    ]);
    let mut rows: Vec<_> = rung.parameters.iter().collect();
    rows.sort_by_cached_key(|(name, _)| place(rung, name));
    for (name, estimate) in rows {
        table.row([
            name.clone(),
            number(estimate.value),
            estimate.unit.clone(),
            words::interval(estimate),
        ]);
    }
    table.text()
}

/// What parameters make together, under their table.
pub fn together(told: &Combinations) -> String {
    if told.quantities.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        ("together", Align::Left),
        ("", Align::Left),
        ("value", Align::Right),
        ("unit", Align::Left),
        ("95 % interval", Align::Left),
    ]);
    for row in words::combinations(told) {
        table.row(row);
    }
    let said = words::not_alone(told).map(|said| wrapped(&format!("{said}.")).join("\n "));
    let said = said.map(|said| format!(" {}\n", dim(&said))).unwrap_or_default();
    format!("\n{}{said}", table.text())
}

/// Place of the parameter called `name`: number of its effect, none for the mass, and its number there.
fn place(rung: &Rung, name: &str) -> (Option<usize>, Option<usize>) {
    let Some((effect, parameter)) = name.rsplit_once('.') else { return (None, None) };
    let number = rung.effects.iter().position(|other| other == effect);
    let about = library().find(effect).ok().map(friction_ident::Effect::about);
    // What is unknown comes last.
    (Some(number.unwrap_or(usize::MAX)), about.and_then(|about| about.parameter(parameter)))
}
