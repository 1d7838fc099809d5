//! The parts of a discovery as tables.

use std::fmt::Write;

use aep_studio::words;
use anstyle::AnsiColor;
use missing_physics::Discovery;
use missing_physics::quantity::{number, percent};
use missing_physics::report::{Candidate, RegimeShare, Rung, SplitError, Verdict, Where};

use crate::args::library;

use super::bars::bar;
use super::style::{dim, paint};
use super::table::{Align, Table};

/// From this p-value on a dependence may well be chance.
const CHANCE: f64 = 0.05;
/// How the notes of most coordinates begin.
const MEAN_ERROR: &str = "largest mean error";
/// Width of the bars.
const BAR: usize = 10;

/// The verdict and its summary.
pub fn verdict(discovery: &Discovery) -> String {
    let colour = match discovery.verdict {
        Verdict::EffectsFound | Verdict::NothingMissing => AnsiColor::Green,
        Verdict::Unexplained | Verdict::Ambiguous | Verdict::Stopped => AnsiColor::Yellow,
    };
    let mut title = words::verdict(discovery).to_uppercase();
    if !discovery.added.is_empty() {
        let _ = write!(title, ": {}", discovery.added.join(", "));
    }
    let mut text = format!("\n{}\n", paint(colour, &title));
    for line in wrapped(&discovery.summary) {
        let _ = writeln!(text, " {line}");
    }
    text += &notes(discovery);
    let unexplained = discovery.verdict == Verdict::Unexplained;
    if let Some(term) = discovery.generic_term.as_ref().filter(|_| unexplained) {
        let _ =
            writeln!(text, "\n An effect file that describes what remains without explaining it:");
        for line in term.lines() {
            let _ = writeln!(text, "   {}", dim(line));
        }
    }
    if discovery.verdict == Verdict::NothingMissing {
        text += &limits(discovery);
    }
    text
}

/// What there is to add, a line each.
pub fn notes(discovery: &Discovery) -> String {
    discovery.notes.iter().map(|text| note(text)).collect()
}

/// A line that adds something.
pub fn note(text: &str) -> String {
    format!(" {} {text}\n", dim("note:"))
}

/// How large each effect would have had to be.
fn limits(discovery: &Discovery) -> String {
    if discovery.detection_limits.is_empty() {
        return String::new();
    }
    let mut table =
        Table::new(&[("effect", Align::Left), ("would have been found above", Align::Left)]);
    for (effect, size) in &discovery.detection_limits {
        table.row([effect.clone(), size.clone()]);
    }
    format!("\n{}", table.text())
}

/// Lines of at most 98 characters.
fn wrapped(text: &str) -> Vec<String> {
    const WIDTH: usize = 98;
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last =
            lines.last_mut().filter(|line| line.chars().count() + word.chars().count() < WIDTH);
        match last {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) => {
                line.push(' ');
                line.push_str(word);
            }
            None => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The rungs with their errors; `first` is what the lowest one is called.
pub fn ladder(discovery: &Discovery, first: &str) -> String {
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
        let mut columns = vec![("rung", Align::Left), ("", Align::Bar)];
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
            let name = rung.added.as_ref().map_or_else(|| first.to_owned(), |_| words::rung(rung));
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
        let text = |pick: fn(&SplitError) -> f64| {
            error(name).map_or_else(|| "-".to_owned(), |error| name.value(pick(error)))
        };
        cells.push(text(|error| error.validation));
        if fitted {
            cells.push(text(|error| error.fit));
        }
    }
    cells
}

/// Shares of the error by regime.
pub fn regimes(regimes: &[RegimeShare]) -> String {
    if regimes.is_empty() {
        return String::new();
    }
    let mut table = Table::new(&[
        ("regime", Align::Left),
        ("", Align::Bar),
        ("of the error", Align::Right),
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
            place.note.strip_prefix(MEAN_ERROR).unwrap_or(&place.note).trim().to_owned(),
        ]);
    }
    others(table.text())
}

/// How many candidates are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// The best few.
    Best,
    /// Every one.
    All,
}

/// Candidates, best first.
pub fn ranking(candidates: &[Candidate], columns: Columns) -> String {
    const FEW: usize = 6;
    let shown = match columns {
        Columns::Best => candidates.len().min(FEW),
        Columns::All => candidates.len(),
    };
    let mut table = Table::new(&[
        ("effect", Align::Left),
        ("", Align::Bar),
        ("gain", Align::Right),
        ("p-value", Align::Right),
        ("size", Align::Left),
    ]);
    for candidate in &candidates[..shown] {
        table.row([
            candidate.effect.clone(),
            bar(candidate.gain, BAR),
            percent(candidate.gain),
            words::p_value(candidate.p_value),
            shortened(&candidate.size),
        ]);
    }
    let mut text = table.text();
    if shown < candidates.len() {
        let rest = candidates.len() - shown;
        let _ = writeln!(text, " {}", dim(&format!("and {rest} more that gain less")));
    }
    text
}

/// A size of many numbers fits on a line; the page and the JSON have all of it.
fn shortened(size: &str) -> String {
    const MOST: usize = 46;
    if size.chars().count() <= MOST {
        return size.to_owned();
    }
    let start: String = size.chars().take(MOST).collect();
    let end = start.rfind(", ").unwrap_or(start.len());
    format!("{}, ...", &start[..end])
}

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

/// Place of the parameter called `name`: number of its effect, none for the mass, and its number there.
fn place(rung: &Rung, name: &str) -> (Option<usize>, Option<usize>) {
    let Some((effect, parameter)) = name.rsplit_once('.') else { return (None, None) };
    let number = rung.effects.iter().position(|other| other == effect);
    let about = library().find(effect).ok().map(friction_ident::Effect::about);
    // What is unknown comes last.
    (Some(number.unwrap_or(usize::MAX)), about.and_then(|about| about.parameter(parameter)))
}
