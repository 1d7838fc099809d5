//! The rungs of a discovery as a table.

use std::fmt::Write;

use aep_studio::words;
use missing_physics::Discovery;
use missing_physics::report::{NamedError, Rung};

use super::bars::{BAR, bar};
use super::style::dim;
use super::table::{Align, LINE, Table};

/// The rungs with what they predict one sample ahead, which decides, and other errors beside it.
fn ladder_ahead(discovery: &Discovery, first: &str) -> String {
    let names = words::views_beside(discovery);
    let headings: Vec<String> =
        names.iter().map(|name| format!("{}\nerror", name.quantity)).collect();
    let mut columns = vec![
        ("model", Align::Left),
        ("", Align::Bar),
        ("prediction\nerror\n(x sensors)", Align::Right),
        ("gain\n(nats)", Align::Right),
        ("p-value", Align::Right),
    ];
    columns.extend(headings.iter().map(|heading| (heading.as_str(), Align::Right)));
    let mut table = Table::new(&columns).at_most(LINE);
    let sizes = discovery.ladder.iter().filter_map(|rung| rung.budget);
    let largest = sizes.filter(|size| size.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    let dash = || "-".to_owned();
    for rung in &discovery.ladder {
        let name = if rung.added.is_empty() { first.to_owned() } else { words::rung(rung) };
        let mut cells = vec![
            name.replace(" + ", "\n+ "),
            bar(rung.budget.unwrap_or(0.0) / largest, BAR),
            rung.budget.map_or_else(dash, words::times),
            rung.likelihood_gain.map_or_else(dash, words::nats),
            rung.p_value.map_or_else(dash, words::chance),
        ];
        cells.extend(names.iter().map(|name| {
            rung.error.get(&name.key).map_or_else(dash, |error| name.value(error.validation))
        }));
        table.row(cells);
    }
    let views: Vec<&str> = names.iter().map(|name| name.quantity.as_str()).collect();
    let note = format!(
        "the prediction error decides; errors of {} are on held-out data and decide nothing",
        views.join(" and ")
    );
    table.text() + &if views.is_empty() { String::new() } else { format!(" {}\n", dim(&note)) }
}

/// The rungs with their errors; `first` is what the lowest one is called.
pub fn ladder(discovery: &Discovery, first: &str) -> String {
    if words::has_budget(discovery) {
        return ladder_ahead(discovery, first);
    }
    let names = words::errors(discovery);
    let Some(main) = names.first() else {
        return String::new();
    };
    let largest = discovery.ladder.iter().filter_map(|rung| rung.error.get(&main.key));
    let largest = largest.map(|error| error.validation).fold(f64::MIN_POSITIVE, f64::max);
    let headings: Vec<String> = names
        .iter()
        .map(|name| {
            let kind = if name.is_relative() { "error" } else { "rms" };
            format!("{} {kind}", name.quantity)
        })
        .collect();
    let tested = discovery.ladder.iter().any(|rung| rung.p_value.is_some());
    let of = |fitted: bool| {
        let mut columns = vec![("model", Align::Left), ("", Align::Bar)];
        for heading in &headings {
            columns.push((heading, Align::Right));
            if fitted {
                columns.push(("fitted", Align::Right));
            }
        }
        if tested {
            columns.push(("p-value", Align::Right));
        }
        let mut table = Table::new(&columns);
        for rung in &discovery.ladder {
            let name = if rung.added.is_empty() { first.to_owned() } else { words::rung(rung) };
            // Effects that were added together stand below each other: the table is wide as it is.
            let name = name.replace(" + ", "\n+ ");
            let p_value = rung.p_value.map_or_else(|| "-".to_owned(), words::p_value);
            let cells = ladder_cells(rung, &names, largest, fitted);
            table.row(std::iter::once(name).chain(cells).chain(tested.then_some(p_value)));
        }
        table
    };
    // On a narrow terminal without the errors on fitted data.
    let table = Some(of(true)).filter(Table::fits).unwrap_or_else(|| of(false));
    let mut text = table.text();
    if let Some(floor) = words::floor(discovery, main) {
        let _ = writeln!(
            text,
            " {}",
            dim(&format!("errors on held-out data; noise floor {}", main.value(floor)))
        );
    }
    text
}

/// Bar and errors of a rung.
fn ladder_cells(
    rung: &Rung,
    names: &[words::ErrorName],
    largest: f64,
    fitted: bool,
) -> Vec<String> {
    let error = |name: &words::ErrorName| rung.error.get(&name.key);
    let main = error(&names[0]).map_or(0.0, |error| error.validation);
    let mut cells = vec![bar(main / largest, BAR)];
    for name in names {
        let text = |pick: fn(&NamedError) -> f64| {
            error(name).map_or_else(|| "-".to_owned(), |error| name.value(pick(error)))
        };
        cells.push(text(|error| error.validation));
        if fitted {
            cells.push(text(|error| error.fit));
        }
    }
    cells
}
