//! The parts of a discovery as tables.

use std::fmt::Write;

use aep_studio::words;
use anstyle::AnsiColor;
use missing_physics::measurement::quantity::{number, percent};
use missing_physics::report::{
    Candidate, Combinations, NamedError, RegimeShare, Rung, Verdict, Where,
};
use missing_physics::{Discovery, Thresholds};

use crate::args::library;

use super::bars::bar;
use super::style::{dim, paint};
use super::table::{Align, Table};

/// From this p-value on a dependence may well be chance.
const CHANCE: f64 = 0.05;
/// How the notes of most coordinates begin.
const MEAN_ERROR: &str = "largest mean error";
/// How to read a ranking by prediction errors.
const RANKING: &str = "share: of the squared prediction error; chance: of as large a gain where errors are shifted in time";
/// Characters of a line.
const LINE: u16 = 100;
/// Width of the bars.
const BAR: usize = 10;

/// The verdict and its summary.
pub fn verdict(discovery: &Discovery) -> String {
    let colour = match discovery.verdict {
        Verdict::EffectsFound | Verdict::NothingMissing if !words::is_cut(discovery) => {
            AnsiColor::Green
        }
        _ => AnsiColor::Yellow,
    };
    let mut title = words::verdict(discovery).to_uppercase();
    if !discovery.added.is_empty() {
        let _ = write!(title, ": {}", discovery.added.join(", "));
    }
    let mut text = format!("\n{}\n", paint(colour, &title));
    if let Some(said) = words::completeness(discovery) {
        let complete = discovery.budget.is_some_and(|budget| budget.complete);
        let colour = if complete { AnsiColor::Green } else { AnsiColor::Yellow };
        let _ = writeln!(text, " {}", paint(colour, &said));
    }
    if let Some(said) = words::missing_force(discovery) {
        let _ = writeln!(text, " {said}");
    }
    for line in wrapped(&words::summary(discovery)) {
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
    words::notes(discovery).iter().map(|text| note(text)).collect()
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
        table.row([effect.clone(), words::detection_limit(size)]);
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

/// Why nothing was added.
pub fn why(text: &str) -> String {
    let lines = wrapped(&format!("Why: {text}."));
    format!(" {}\n", lines.join("\n "))
}

/// Every comparison, grouped by number of effects.
pub fn compared(discovery: &Discovery, thresholds: &Thresholds) -> String {
    let mut text = String::new();
    for group in words::compared(discovery, thresholds) {
        let columns = words::COMPARED_HEADINGS.map(|heading| match heading {
            "set" => (group.title.as_str(), Align::Left),
            "compared with" | "outcome" => (heading, Align::Left),
            number => (number, Align::Right),
        });
        let mut table = Table::new(&columns).at_most(LINE);
        for [set, with, difference, needed, times, outcome] in group.rows {
            // Effects stand below each other: the outcome needs the width.
            let stacked = |effects: String| effects.replace(" + ", "\n+ ");
            table.row([stacked(set), stacked(with), difference, needed, times, outcome]);
        }
        text += &table.text();
        text.push('\n');
    }
    for line in wrapped(words::COMPARED) {
        let _ = writeln!(text, " {}", dim(&line));
    }
    text
}

/// How many comparisons there were, and how to see them.
pub fn comparisons(discovery: &Discovery) -> String {
    let said = words::comparisons(discovery);
    said.map(|said| format!(" {}\n", dim(&format!("{said}: --explain shows them"))))
        .unwrap_or_default()
}

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

/// How many candidates are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Columns {
    /// The best few.
    Best,
    /// Every one.
    All,
}

/// Candidates, best first.
pub fn ranking(candidates: &[Candidate], shown_of: Columns) -> String {
    const FEW: usize = 6;
    let shown = match shown_of {
        Columns::Best => candidates.len().min(FEW),
        Columns::All => candidates.len(),
    };
    // Told by what they predict one sample ahead, or by the force that they explain.
    let ahead = candidates.iter().any(|candidate| candidate.nats.is_some());
    let mut columns = vec![("effect", Align::Left)];
    if ahead {
        columns.push(("gain\n(nats)", Align::Right));
    }
    columns.extend([
        ("", Align::Bar),
        (if ahead { "share" } else { "gain" }, Align::Right),
        (if ahead { "chance" } else { "p-value" }, Align::Right),
        ("size", Align::Left),
    ]);
    let mut table = Table::new(&columns).at_most(LINE);
    let most = if ahead { room(&candidates[..shown]) } else { 46 };
    for candidate in &candidates[..shown] {
        let nats = candidate.nats.map_or_else(|| "-".to_owned(), words::nats);
        let p_value = if ahead { words::chance } else { words::p_value };
        let cells = [
            bar(candidate.gain, BAR),
            percent(candidate.gain),
            p_value(candidate.p_value),
            shortened(&words::size(&candidate.size), most),
        ];
        let first = std::iter::once(candidate.effect.clone()).chain(ahead.then_some(nats));
        table.row(first.chain(cells));
    }
    let mut text = table.text();
    if shown < candidates.len() {
        let rest = candidates.len() - shown;
        let _ = writeln!(text, " {}", dim(&format!("and {rest} more that gain less")));
    }
    if ahead && shown_of == Columns::All {
        let _ = writeln!(text, " {}", dim(RANKING));
    }
    text
}

/// Characters that the other columns of a ranking leave for the sizes.
fn room(candidates: &[Candidate]) -> usize {
    // Numbers, the margin, and what separates six columns.
    const TAKEN: usize = 7 + 6 + 8 + 1 + 6 * 3;
    let widest = |width: fn(&Candidate) -> usize| candidates.iter().map(width).max().unwrap_or(0);
    let names = widest(|candidate| candidate.effect.chars().count());
    let bars = widest(|candidate| bar(candidate.gain, BAR).chars().count());
    usize::from(LINE).saturating_sub(TAKEN + names + bars).max(24)
}

/// A size of many numbers fits on a line; the page and the JSON have all of it.
fn shortened(size: &str, most: usize) -> String {
    if size.chars().count() <= most {
        return size.to_owned();
    }
    let start: String = size.chars().take(most).collect();
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

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::{Budget, Remains};
    use serde_json::{Value, json};

    fn estimate(value: f64) -> Value {
        json!({"value": value, "low": value, "high": value, "unit": "N", "identifiable": true})
    }

    /// A ladder of one effect; `budget` where it is judged by prediction errors.
    fn discovery(budget: bool) -> Discovery {
        let both = |quantity: &str, unit: Option<&str>, value: f64| {
            json!({"quantity": quantity, "unit": unit, "fit": value,
            "validation": value})
        };
        let rung = |added: Option<&str>, effects: &[&str], error: f64, times: f64| {
            let mut rung = json!({"added": added.as_slice(), "effects": effects, "parameters": {"coulomb.F_C": estimate(3.0)},
                "error": {"force_relative": both("force", None, error), "force_rms_N": both("force", Some("N"), 10.0 * error),
                    "window_rms_m": both("window", Some("m"), 1e-5 * error)},
                "p_value": added.map(|_| 0.001)});
            if budget {
                rung["budget"] = times.into();
                rung["likelihood_gain"] = if added.is_some() { 812.3.into() } else { Value::Null };
            }
            rung
        };
        let sizes: Vec<Value> = (1..=4)
            .map(|k| json!({"name": format!("K_{k}"), "value": f64::from(k), "unit": "N/um"}))
            .collect();
        let candidate = json!({"effect": "presliding:free", "gain": 0.31, "p_value": 0.001,
            "size": sizes, "nats": budget.then_some(812.3)});
        let decision = |set: &[&str], outcome: &str, difference: f64| {
            json!({"rung": set.len() - 1, "candidate": set, "compared_with": ["coulomb"], "difference": difference,
                "standard_error": 15.0, "budget": 1.04, "outcome": outcome, "because": {"kind": "best_of_size"}})
        };
        let mut json = json!({
            "verdict": "effects_found",
            "added": ["position-friction:fine"],
            "ladder": [rung(None, &["coulomb"], 0.05, 12.52),
                rung(Some("position-friction:fine"), &["coulomb", "position-friction:fine"], 0.02, 1.04)],
            "ranking": [[candidate]], "where": [], "ambiguous": [], "noise_floor": {"force_N": 0.1}, "seed": 1,
            "wall_s": 1.0,
        });
        if budget {
            json["budget"] =
                json!({"expected": 1e-7, "base": 12.52, "last": 1.04, "complete": true});
            json["decisions"] = json!([
                decision(&["coulomb", "position-friction:fine"], "added", 812.3),
                decision(&["coulomb", "drift"], "worse", 402.0),
                decision(
                    &["coulomb", "position-friction:fine", "reversal-decay"],
                    "too_little",
                    9.0
                ),
            ]);
        }
        serde_json::from_value(json).unwrap()
    }

    fn plain(text: &str) -> String {
        anstream::adapter::strip_str(text).to_string()
    }

    #[track_caller]
    fn fits(text: &str) {
        for line in plain(text).lines() {
            assert!(line.chars().count() <= 100, "{}: {line}", line.chars().count());
        }
    }

    #[test]
    fn the_ladder_is_judged_by_prediction_errors_and_fits_a_terminal() {
        let text = plain(&ladder(&discovery(true), "base model"));
        for part in [
            "prediction",
            "(x sensors)",
            "12.5",
            "1.04",
            "+812",
            "<= 0.001",
            "2.00 %",
            "██████████",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
        assert!(!text.contains("noise floor"), "{text}");
        fits(&text);
    }

    #[test]
    fn without_prediction_errors_the_ladder_is_judged_by_the_force() {
        let text = plain(&ladder(&discovery(false), "base model"));
        assert!(text.contains("noise floor") && text.contains("0.001"), "{text}");
        assert!(!text.contains("sensors"), "{text}");
    }

    #[test]
    fn candidates_are_ranked_in_nats_where_they_have_them() {
        let text = plain(&ranking(&discovery(true).ranking[0], Columns::All));
        for part in [
            "(nats)",
            "share",
            "chance",
            "+812",
            "31.0 %",
            "<= 0.001",
            "K_1 = 1.00 N/um, K_2 = 2.00 N/um, ...",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
        fits(&text);
        let text = plain(&ranking(&discovery(false).ranking[0], Columns::Best));
        assert!(text.contains("p-value") && !text.contains("nats"), "{text}");
    }

    #[test]
    fn the_record_is_a_table_for_each_number_of_effects() {
        let found = discovery(true);
        let text = plain(&compared(&found, &Thresholds::default()));
        for part in [
            "Sets of 1 effect",
            "Sets of 2 effects",
            "+812 ± 15",
            "> +80",
            "another is better",
            "gains too little",
        ] {
            assert!(text.contains(part), "'{part}' is not in\n{text}");
        }
        fits(&text);
        assert!(
            plain(&comparisons(&found)).contains("3 comparisons of models: --explain shows them")
        );
        assert_eq!(comparisons(&discovery(false)), "");
    }

    #[test]
    fn the_verdict_says_how_complete_the_model_is_and_whether_the_search_was_cut() {
        let mut found = discovery(true);
        let text = plain(&verdict(&found));
        assert!(
            text.contains("MISSING EFFECT FOUND: position-friction:fine\n complete: 1.04 times"),
            "{text}"
        );
        found.verdict = Verdict::Stopped;
        let effects = std::mem::take(&mut found.added);
        found.remains = vec![Remains::SoFar { effects, nats: 900.0, last: 1.04 }];
        found.budget = found.budget.map(|budget| Budget { complete: false, ..budget });
        let text = plain(&verdict(&found));
        assert!(
            text.contains("STOPPED BEFORE ANYTHING WAS CERTAIN\n incomplete")
                && text.contains("Found so far:\n position-friction:fine (+900 nats; 1.04 times"),
            "{text}"
        );
        fits(&why(&"a long reason ".repeat(20)));
    }
}
