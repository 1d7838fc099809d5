//! How a discovery is put into words, the same on the page and in the terminal.

use missing_physics::measurement::quantity::{number, percent, quantity};
use missing_physics::report::{
    DetectionLimit, Discovery, Estimate, MissingForce, NamedValue, Remark, Rung, Verdict,
};

mod axes;
mod combinations;
mod compared;
mod confirmation;
mod errors;
mod findings;
mod lines;
mod places;
mod refusals;
mod remains;
mod remarks;
mod residual;
mod summary;
mod views;

pub use axes::{AXES_HEADINGS, AxisResult, axis_row};
pub use combinations::{combinations, not_alone};
pub use compared::{
    COMPARED, COMPARED_HEADINGS, Compared, compared, comparisons, effects_of, needed, outcome,
    why_nothing,
};
pub use confirmation::{
    CONFIRMATION, Heading, confirmation_headings, confirmation_rows, confirmations, surrogates,
};
pub use errors::{ErrorName, errors, errors_of, floor, main_error};
pub use findings::finding;
pub use lines::{line, relation};
pub use places::{largest, pattern};
pub use refusals::{reason, refusal};
pub use remains::remains;
pub use remarks::{disagreement, remark};
pub use residual::residual_tests;
pub(crate) use residual::whiteness;
pub use summary::{experiment, summary};
pub use views::{caveat, compares};

/// What is said of a search that was cut, by Ctrl-C or at the end of its time.
pub const STOPPED: &str =
    "stopped early: this is what was found until then, and what takes long was left out";
/// Smallest chance that shifts in time can tell.
const SMALLEST: f64 = 1.0 / (missing_physics::ahead::chance::SHIFTS as f64 + 1.0);
/// From this p-value on a finding may well be chance.
const CHANCE: f64 = 0.05;

/// Whether the search was cut before its end, so that what was found is what was found so far.
pub fn is_cut(discovery: &Discovery) -> bool {
    let stopped = discovery.stopped || discovery.verdict == Verdict::Stopped;
    stopped || !discovery.untried.is_empty()
}

/// What the user should know besides: that the search was cut, the engine's remarks, and what whoever asked says.
pub fn notes(discovery: &Discovery) -> Vec<String> {
    let stopped = discovery.stopped.then(|| STOPPED.to_owned());
    let remarks = discovery.remarks.iter().map(remark);
    stopped.into_iter().chain(remarks).chain(discovery.notes.iter().cloned()).collect()
}

/// Parameters of a candidate: `dF = 8.20 N, v_S = 1.10 mm/s`.
pub fn size(of: &[NamedValue]) -> String {
    let words = of.iter().map(|of| format!("{} = {}", of.name, quantity(of.value, &of.unit)));
    words.collect::<Vec<_>>().join(", ")
}

/// How large an effect would have had to be: `dF 1.20 N at v_S 1.10 mm/s`.
pub fn detection_limit(limit: &DetectionLimit) -> String {
    let name = &limit.parameter;
    let mut text = limit.size.map_or_else(
        || format!("no {name} within its limits"),
        |size| format!("{name} {}", quantity(size, &limit.unit)),
    );
    for (k, at) in limit.at.iter().enumerate() {
        text.push_str(if k == 0 { " at " } else { ", " });
        text.push_str(&at.name);
        text.push(' ');
        text.push_str(&quantity(at.value, &at.unit));
    }
    text
}

/// The verdict in two or three words.
pub fn verdict(discovery: &Discovery) -> &'static str {
    match discovery.verdict {
        Verdict::Stopped => "Stopped before anything was certain",
        Verdict::EffectsFound if discovery.added.len() > 1 => "Missing effects found",
        Verdict::EffectsFound => "Missing effect found",
        Verdict::NothingMissing => "Nothing is missing",
        Verdict::Unexplained => "Unexplained structure",
        Verdict::Ambiguous => "Found, but ambiguous",
    }
}

/// Whether the last model explains all that the sensors do not: `complete: 1.05 times what the sensors make is
/// left`; nothing where that is not known.
pub fn completeness(discovery: &Discovery) -> Option<String> {
    let budget = discovery.budget?;
    let word = if budget.complete { "complete" } else { "incomplete" };
    let noise = noise_of_input(discovery);
    Some(format!("{word}: {} times what the sensors make is left{noise}", times(budget.last)))
}

/// What makes more than the sensors do, if that is noise of the input: `, which noise of the force makes`.
fn noise_of_input(discovery: &Discovery) -> String {
    let input = discovery.remarks.iter().find_map(|remark| match remark {
        Remark::InputNoise { input, .. } => Some(input),
        _ => None,
    });
    input.map_or_else(String::new, |input| format!(", which noise of the {input} makes"))
}

/// A multiple of what the sensors make: `1.05`, `3.1`, `120`.
pub fn times(value: f64) -> String {
    match value {
        _ if !value.is_finite() => "-".to_owned(),
        _ if value < 2.0 => format!("{value:.2}"),
        _ if value < 100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// A gain in log-likelihood, signed: `+340`, `-2.4`.
pub fn nats(value: f64) -> String {
    match value {
        _ if !value.is_finite() => "-".to_owned(),
        _ if value.abs() < 0.05 => "0.0".to_owned(),
        _ if value.abs() < 9.95 => format!("{value:+.1}"),
        _ => format!("{value:+.0}"),
    }
}

/// Chance of a gain as large, as shifts in time tell it: they cannot tell less than one over their number.
pub fn chance(p_value: f64) -> String {
    if is_smallest(p_value) {
        format!("<= {}", self::p_value(SMALLEST))
    } else {
        self::p_value(p_value)
    }
}

/// Whether a chance is the smallest that shifts in time can tell.
fn is_smallest(p_value: f64) -> bool {
    p_value <= SMALLEST * (1.0 + 1e-9)
}

/// How small a chance can be that shifts in time tell.
pub fn smallest_chance() -> String {
    format!(
        "{} shifts can give no p below {}, which is multiplied by the number of trials that were ranked for each one that was \
         shifted: where no shift gained as much, that product stands here.",
        missing_physics::ahead::chance::SHIFTS,
        p_value(SMALLEST)
    )
}

/// Whether the rungs are judged by what they predict one sample ahead.
pub fn has_budget(discovery: &Discovery) -> bool {
    discovery.ladder.iter().any(|rung| rung.budget.is_some())
}

/// The errors that stand beside prediction errors, for people: the main one, and those of other quantities.
pub fn views_beside(discovery: &Discovery) -> Vec<ErrorName> {
    let names = errors(discovery);
    let main = names.first().map(|name| name.quantity.clone());
    let kept = |(k, name): &(usize, ErrorName)| *k == 0 || Some(&name.quantity) != main.as_ref();
    names.into_iter().enumerate().filter(kept).map(|(_, name)| name).collect()
}

/// What a rung is called: `base model` or `+ stribeck`.
pub fn rung(rung: &Rung) -> String {
    if rung.added.is_empty() {
        "base model".to_owned()
    } else {
        format!("+ {}", rung.added.join(" + "))
    }
}

/// Value of an estimate, digits as its interval supports.
pub fn value(estimate: &Estimate) -> String {
    format!("{} {}", number(estimate.value), estimate.unit).trim_end().to_owned()
}

/// Interval of an estimate: `200 .. 207`, or why there is none.
pub fn interval(estimate: &Estimate) -> String {
    if !estimate.identifiable {
        return "not determined by this data".to_owned();
    }
    format!("{} .. {}", number(estimate.low), number(estimate.high))
}

/// A p-value as it can be claimed: `0.012`, `< 0.001`, or nothing where there is none.
pub fn p_value(value: f64) -> String {
    match value {
        _ if !value.is_finite() => "-".to_owned(),
        _ if value < 0.001 => "< 0.001".to_owned(),
        _ if value < 0.095 => format!("{value:.3}"),
        _ => format!("{value:.2}"),
    }
}

/// The part of the way from the base model's error to the noise floor that the last rung has gone,
/// 0..1.
pub fn explained(discovery: &Discovery) -> Option<f64> {
    let name = main_error(discovery)?;
    let floor = floor(discovery, &name)?;
    let at = |rung: &Rung| rung.error.get(&name.key).map(|error| error.validation);
    let (first, last) = (at(discovery.ladder.first()?)?, at(discovery.ladder.last()?)?);
    (first > floor).then(|| ((first - last) / (first - floor)).clamp(0.0, 1.0))
}

/// Unit of the compared quantity; empty where no error is known.
pub fn main_unit(discovery: &Discovery) -> String {
    let Some(main) = main_error(discovery) else { return String::new() };
    let same = |name: &ErrorName| name.quantity == main.quantity && !name.is_relative();
    errors(discovery).into_iter().find(same).and_then(|name| name.unit).unwrap_or_default()
}

/// The force that base and last model lack: `missing force: 2.31 N rms of 14.2 N (16.3 %), known to ±0.12 N; with what
/// was found 0.31 N`; nothing where that is not known.
pub fn missing_force(discovery: &Discovery) -> Option<String> {
    let base = discovery.missing_force_base.as_ref()?;
    let size = |value: f64| quantity(value, &base.unit);
    let mut text = format!(
        "missing {}: {} rms of {} ({}), known to ±{}",
        main_quantity(discovery),
        size(base.rms),
        size(base.recorded),
        percent(base.share),
        size(base.band),
    );
    if let Some(last) = discovery.missing_force.as_ref().filter(|_| discovery.ladder.len() > 1) {
        text.push_str("; with what was found ");
        text.push_str(&size(last.rms));
    }
    Some(text)
}

/// What shares by regime are shares of.
pub fn shared_out(discovery: &Discovery, missing: Option<&MissingForce>) -> String {
    missing.map_or_else(
        || "of the error".to_owned(),
        |_| format!("of the missing {}", main_quantity(discovery)),
    )
}

/// Name of the compared quantity.
pub fn main_quantity(discovery: &Discovery) -> String {
    main_error(discovery).map_or_else(|| "force".to_owned(), |name| name.quantity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_limits_are_numbers_until_here() {
        let named = |name: &str, value, unit: &str| NamedValue {
            name: name.into(),
            value,
            unit: unit.into(),
        };
        let at = vec![named("v_S", 1.1e-3, "m/s")];
        assert_eq!(size(&[named("dF", 8.2, "N"), at[0].clone()]), "dF = 8.20 N, v_S = 1.10 mm/s");
        let limit =
            |size, at| DetectionLimit { parameter: "dF".into(), unit: "N".into(), size, at };
        assert_eq!(detection_limit(&limit(Some(1.2), at)), "dF 1.20 N at v_S 1.10 mm/s");
        assert_eq!(detection_limit(&limit(None, Vec::new())), "no dF within its limits");
    }

    #[test]
    fn p_values_claim_no_more_than_they_can() {
        assert_eq!(p_value(0.0), "< 0.001");
        assert_eq!(p_value(0.0123), "0.012");
        assert_eq!(p_value(0.5), "0.50");
        assert_eq!(p_value(f64::NAN), "-");
    }

    #[test]
    fn chances_say_where_shifts_end() {
        assert_eq!(chance(0.001), "<= 0.001");
        assert_eq!(chance(0.0013), "0.001");
        assert_eq!(chance(0.25), "0.25");
        assert_eq!(chance(f64::NAN), "-");
    }

    #[test]
    fn multiples_and_gains_have_the_digits_that_matter() {
        assert_eq!([1.046, 3.12, 123.4, f64::NAN].map(times), ["1.05", "3.1", "123", "-"]);
        assert_eq!([340.4, -2.44, 0.01, f64::INFINITY].map(nats), ["+340", "-2.4", "0.0", "-"]);
    }

    fn discovery(verdict: &str, complete: bool) -> Discovery {
        let json = serde_json::json!({
            "verdict": verdict, "added": ["stribeck"], "ladder": [], "ranking": [], "where": [], "ambiguous": [],
            "noise_floor": {}, "seed": 1, "wall_s": 1.0,
            "budget": {"expected": 1e-7, "base": 9.0, "last": 3.12, "complete": complete},
        });
        serde_json::from_value(json).unwrap()
    }

    #[test]
    fn a_verdict_says_whether_the_model_is_complete() {
        let said = |complete| completeness(&discovery("effects_found", complete)).unwrap();
        assert_eq!(said(true), "complete: 3.1 times what the sensors make is left");
        assert_eq!(said(false), "incomplete: 3.1 times what the sensors make is left");
        let unknown = Discovery { budget: None, ..discovery("effects_found", true) };
        assert_eq!(completeness(&unknown), None);
        let noise = Remark::InputNoise { input: "force".into(), deviation: 0.5, unit: "N".into() };
        let noisy = Discovery { remarks: vec![noise], ..discovery("nothing_missing", true) };
        let of_noise = "3.1 times what the sensors make is left, which noise of the force makes";
        assert_eq!(completeness(&noisy).unwrap(), format!("complete: {of_noise}"));
        assert!(
            summary(&noisy).contains("the sensors make it, which noise of the force makes, and no")
        );
    }

    #[test]
    fn a_search_that_was_cut_has_a_verdict_of_its_own() {
        assert_eq!(verdict(&discovery("effects_found", true)), "Missing effect found");
        assert_eq!(verdict(&discovery("stopped", false)), "Stopped before anything was certain");
    }
}
