//! The ladder: errors as bars that fall to the noise floor.

use missing_physics::Discovery;
use missing_physics::report::{NamedError, Rung, SplitError};

use crate::html::{self, escape, table};
use crate::source::Source;
use crate::words::{self, ErrorName};

const LEAD: &str = "Each model has one effect more. What counts is the error on held-out data, \
    which took no part in the fit; the line marks the noise floor, as estimated from the data.";

const AHEAD: &str = "Each model has one effect more than the one above it. What counts is the error of predictions one sample \
    ahead, in multiples of what the sensors alone make; the line marks what they make. The gain says how much likelier the \
    effect makes measurements that took no part in its fit, as a natural logarithm (nats). p is the chance of as large a gain \
    where the errors are shifted in time, so that they have nothing to do with the motion. The errors on held-out data beside \
    it are views that decide nothing.";

/// Title of the section.
const TITLE: &str = "The models, one effect more each";

/// The section of the ladder.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    // Where there is a first screen the bars stand there.
    let bars = if source.samples.time.is_empty() { bars(discovery) } else { String::new() };
    let ahead = words::has_budget(discovery);
    if !ahead && words::main_error(discovery).is_none() {
        return String::new();
    }
    let (lead, numbers) =
        if ahead { (AHEAD, numbers_ahead(discovery, source)) } else { (LEAD, numbers(discovery)) };
    html::section("ladder", TITLE, lead, &(bars + &numbers))
}

/// The errors of the models as bars that fall to what the sensors make or to the noise floor.
pub(super) fn bars(discovery: &Discovery) -> String {
    if words::has_budget(discovery) {
        return bars_ahead(discovery);
    }
    words::main_error(discovery).map(|name| bars_held_out(discovery, &name)).unwrap_or_default()
}

/// Prediction errors as bars.
fn bars_ahead(discovery: &Discovery) -> String {
    let sizes = discovery.ladder.iter().filter_map(|rung| rung.budget);
    let largest = sizes.filter(|size| size.is_finite()).fold(1.0, f64::max);
    let row = |rung: &Rung| {
        let size = rung.budget.filter(|size| size.is_finite())?;
        Some(format!(
            "<div class=rung><span class=name>{}</span><span class=track>\
             <span class=held style=\"width:{:.2}%\"></span><span class=floor style=\"left:{:.2}%\"></span></span>\
             <span class=value>{} ×</span></div>",
            escape(&words::rung(rung)),
            100.0 * (size / largest).clamp(0.0, 1.0),
            100.0 / largest,
            escape(&words::times(size)),
        ))
    };
    let rows: String = discovery.ladder.iter().filter_map(row).collect();
    let key = "<div class=legend><span><i class=c1></i>prediction error</span>\
               <span><i class=floor></i>what the sensors make</span></div>";
    format!("{key}<div class=ladder>{rows}</div>")
}

fn numbers_ahead(discovery: &Discovery, source: &Source) -> String {
    let names = words::views_beside(discovery);
    let fixed = ["Model", "#Prediction error (× sensors)", "#Gain (nats)", "#p"];
    let mut headings: Vec<String> = fixed.map(str::to_owned).to_vec();
    headings.extend(names.iter().map(|name| format!("#{} (held out)", name.heading())));
    let dash = || "-".to_owned();
    let row = |rung: &Rung| {
        let mut cells = vec![
            words::rung(rung),
            rung.budget.map_or_else(dash, words::times),
            rung.likelihood_gain.map_or_else(dash, words::nats),
            rung.p_value.map_or_else(dash, words::chance),
        ];
        cells.extend(names.iter().map(|name| {
            rung.error.get(&name.key).map_or_else(dash, |error| name.value(error.validation))
        }));
        let mut cells: Vec<String> = cells.iter().map(|cell| escape(cell)).collect();
        cells[0] = super::effects::model(rung, source);
        cells
    };
    let rows: Vec<Vec<String>> = discovery.ladder.iter().map(row).collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let smallest = if discovery.ladder.iter().any(|rung| rung.p_value.is_some()) {
        format!("<p class=lead>{}</p>", escape(&words::smallest_chance()))
    } else {
        String::new()
    };
    table(&headings, &rows) + &smallest
}

fn bars_held_out(discovery: &Discovery, name: &ErrorName) -> String {
    let errors: Vec<(&Rung, SplitError)> = discovery
        .ladder
        .iter()
        .filter_map(|rung| rung.error.get(&name.key).map(|error| (rung, error.size())))
        .collect();
    let sizes = errors.iter().flat_map(|(_, error)| [error.fit, error.validation]);
    let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
    if largest == 0.0 {
        return String::new();
    }
    let floor = words::floor(discovery, name).map(|floor| floor / largest);
    let rows: String =
        errors.iter().map(|(rung, error)| row(rung, *error, name, largest, floor)).collect();
    let key = "<div class=legend><span><i class=c1></i>held-out data</span>\
               <span><i class=c5></i>fitted data</span><span><i class=floor></i>noise floor</span></div>";
    format!("{key}<div class=ladder>{rows}</div>")
}

fn row(
    rung: &Rung,
    error: SplitError,
    name: &ErrorName,
    largest: f64,
    floor: Option<f64>,
) -> String {
    let width = |size: f64| 100.0 * (size / largest).clamp(0.0, 1.0);
    let floor = floor
        .filter(|floor| *floor <= 1.0)
        .map(|floor| format!("<span class=floor style=\"left:{:.2}%\"></span>", 100.0 * floor))
        .unwrap_or_default();
    format!(
        "<div class=rung><span class=name>{}</span><span class=track>\
         <span class=held style=\"width:{:.2}%\"></span><span class=fit style=\"width:{:.2}%\"></span>{floor}</span>\
         <span class=value>{}</span></div>",
        escape(&words::rung(rung)),
        width(error.validation),
        width(error.fit),
        escape(&name.value(error.validation)),
    )
}

fn numbers(discovery: &Discovery) -> String {
    let names = words::errors(discovery);
    let mut headings = vec!["Model".to_owned()];
    for name in &names {
        headings.push(format!("#{} (held out)", name.heading()));
        headings.push("#fitted".to_owned());
    }
    headings.push("#p-value".to_owned());
    let rows: Vec<Vec<String>> = discovery
        .ladder
        .iter()
        .map(|rung| {
            let mut cells = vec![escape(&words::rung(rung))];
            for name in &names {
                let error = rung.error.get(&name.key);
                let text = |pick: fn(&NamedError) -> f64| {
                    error.map_or("-".to_owned(), |error| escape(&name.value(pick(error))))
                };
                cells.push(text(|error| error.validation));
                cells.push(text(|error| error.fit));
            }
            cells.push(rung.p_value.map_or_else(|| "-".to_owned(), |p| escape(&words::p_value(p))));
            cells
        })
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    table(&headings, &rows)
}
