//! How a discovery is put into words, the same on the page and in the terminal.

use missing_physics::measurement::quantity::{number, percent, quantity};
use missing_physics::report::{
    Confirmation, Confirmed, DetectionLimit, Diagnosis, Discovery, Estimate, MissingForce,
    NamedError, NamedValue, Remark, Rung, Surrogates, Verdict, Whiteness, floor_key,
};

mod axes;
mod combinations;
mod compared;
mod findings;
mod lines;
mod places;
mod refusals;
mod remains;
mod remarks;
mod summary;
mod views;

pub use axes::{AXES_HEADINGS, AxisResult, axis_row};
pub use combinations::{combinations, not_alone};
pub use compared::{
    COMPARED, COMPARED_HEADINGS, Compared, compared, comparisons, effects_of, needed, outcome,
    why_nothing,
};
pub use findings::finding;
pub use lines::{line, relation};
pub use places::{largest, pattern};
pub use refusals::{reason, refusal};
pub use remains::remains;
pub use remarks::{disagreement, remark};
pub use summary::{experiment, summary};
pub use views::{caveat, compares};

/// What is said of a search that was cut, by Ctrl-C or at the end of its time.
pub const STOPPED: &str =
    "stopped early: this is what was found until then, and what takes long was left out";
/// Smallest chance that shifts in time can tell.
const SMALLEST: f64 = 1.0 / (missing_physics::ahead::chance::SHIFTS as f64 + 1.0);
/// From this p-value on a finding may well be chance.
const CHANCE: f64 = 0.05;

/// What an error of a rung is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ErrorName {
    /// Its key in the JSON, e.g. `force_rms_N`.
    pub key: String,
    /// What is compared, e.g. `force`.
    pub quantity: String,
    /// SI unit; nothing for a fraction of the quantity's own size.
    pub unit: Option<String>,
}

impl ErrorName {
    /// The name of an error.
    pub fn of(error: &NamedError) -> Self {
        let NamedError { quantity, unit, .. } = error;
        Self { key: error.key(), quantity: quantity.clone(), unit: unit.clone() }
    }

    /// Whether it is a fraction of the quantity's own size.
    pub fn is_relative(&self) -> bool {
        self.unit.is_none()
    }

    /// Heading of a column: `force error`, `window error`.
    pub fn heading(&self) -> String {
        if self.is_relative() {
            format!("{} error, relative", self.quantity)
        } else {
            format!("{} error", self.quantity)
        }
    }

    /// A value of it with its unit.
    pub fn value(&self, value: f64) -> String {
        in_unit(value, self.unit.as_deref())
    }
}

/// A number in its unit, or in per cent where it is a fraction.
fn in_unit(value: f64, unit: Option<&str>) -> String {
    unit.map_or_else(|| percent(value), |unit| quantity(value, unit))
}

/// The errors of the ladder: those relative first, then absolute ones of the same quantity, then
/// the other views.
pub fn errors(discovery: &Discovery) -> Vec<ErrorName> {
    discovery.ladder.first().map(errors_of).unwrap_or_default()
}

/// The errors of one model, in the same order.
pub fn errors_of(rung: &Rung) -> Vec<ErrorName> {
    let mut names: Vec<ErrorName> = rung.error.values().map(ErrorName::of).collect();
    let main = names.iter().find(|name| name.is_relative()).map(|name| name.quantity.clone());
    names.sort_by_key(|name| (!name.is_relative(), Some(&name.quantity) != main.as_ref()));
    names
}

/// The error that the ladder is judged by: the first of [`errors`].
pub fn main_error(discovery: &Discovery) -> Option<ErrorName> {
    errors(discovery).into_iter().next()
}

/// The noise floor in the measure of `name`, where it is known.
pub fn floor(discovery: &Discovery, name: &ErrorName) -> Option<f64> {
    let floor = |unit: &str| discovery.noise_floor.get(&floor_key(&name.quantity, unit)).copied();
    if let Some(unit) = &name.unit {
        return floor(unit);
    }
    // A fraction of the quantity's size, which is the absolute error over the relative one.
    let base = discovery.ladder.first()?;
    let relative = base.error.get(&name.key)?.validation;
    let same = |error: &&NamedError| error.quantity == name.quantity && error.unit.is_some();
    let absolute = base.error.values().find(same)?;
    let floor = floor(absolute.unit.as_deref()?)?;
    (absolute.validation > 0.0).then(|| floor * relative / absolute.validation)
}

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
    let at = |rung: &Rung| rung.error.get(&name.key).map(|error: &NamedError| error.validation);
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

/// Whether a residual is noise, as sentences.
pub fn residual_tests(diagnosis: &Diagnosis) -> Vec<String> {
    diagnosis.whiteness.iter().map(whiteness).chain(independence(diagnosis)).collect()
}

/// Whether a residual resembles itself.
pub(crate) fn whiteness(test: &Whiteness) -> String {
    if test.p_value > CHANCE {
        return format!("The residual is white (p = {}).", p_value(test.p_value));
    }
    let memory = match test.memory_s {
        Some(memory) if memory > 0.0 => {
            format!("it resembles itself for about {}", quantity(memory, "s"))
        }
        Some(_) => "it resembles itself at longer lags".to_owned(),
        None => format!(
            "it resembles itself for more than {}",
            quantity(test.interval_s * test.autocorrelation.len() as f64, "s")
        ),
    };
    format!("The residual is not white (p {}): {memory}.", at(test.p_value))
}

fn independence(diagnosis: &Diagnosis) -> Option<String> {
    let all = &diagnosis.independence;
    if all.is_empty() {
        return None;
    }
    // One of several tests is below its level more often than a single one.
    let level = CHANCE / all.len() as f64;
    let follows: Vec<String> = all
        .iter()
        .filter(|test| test.p_value <= level.max(1.0 / 200.0))
        .map(|test| {
            let side = if test.worst_lag_s < 0.0 { "before" } else { "after" };
            let lag = quantity(test.worst_lag_s.abs(), "s");
            format!("{} (correlation {:.2}, {lag} {side} it)", test.input, test.worst)
        })
        .collect();
    Some(if follows.is_empty() {
        let names: Vec<&str> = all.iter().map(|test| test.input.as_str()).collect();
        format!("It does not follow {}.", names.join(", "))
    } else {
        format!("It follows {}.", follows.join(", "))
    })
}

/// A p-value within a sentence: `= 0.012`, `< 0.001`.
fn at(value: f64) -> String {
    let text = p_value(value);
    if text.starts_with('<') { text } else { format!("= {text}") }
}

/// How to read the table of a confirmation.
pub const CONFIRMATION: &str = "parameters as found, but for what belongs to a recording; 'gain anew': all of them \
                                fitted there";

/// The head of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// What stands there.
    pub text: String,
    /// Whether numbers stand below it.
    pub numbers: bool,
}

/// Headings of the table of a confirmation.
pub fn confirmation_headings(discovery: &Discovery) -> Vec<Heading> {
    let heading = |text: &str, numbers| Heading { text: text.to_owned(), numbers };
    let errors = errors(discovery).into_iter().map(|name| heading(&name.heading(), true));
    let rest = [("holds", false), ("gain anew", true), ("p-value", true)];
    let rest = rest.map(|(text, numbers)| heading(text, numbers));
    std::iter::once(heading("model", false)).chain(errors).chain(rest).collect()
}

/// Its rows, one for each rung.
pub fn confirmation_rows(discovery: &Discovery, confirmed: &Confirmed) -> Vec<Vec<String>> {
    let names = errors(discovery);
    let dash = || "-".to_owned();
    let row = |(rung, here): (&Rung, &Confirmation)| {
        let errors = names
            .iter()
            .map(|name| here.error.get(&name.key).map_or_else(dash, |error| name.value(*error)));
        let holds = here.holds.map_or_else(dash, |holds| yes(holds).to_owned());
        let gain = here.gain.map_or_else(dash, percent);
        let p = here.p_value.map_or_else(dash, p_value);
        std::iter::once(self::rung(rung)).chain(errors).chain([holds, gain, p]).collect()
    };
    discovery.ladder.iter().zip(&confirmed.rungs).map(row).collect()
}

fn yes(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

/// What a confirmation says of each effect.
pub fn confirmations(confirmed: &Confirmed) -> Vec<String> {
    let said = |here: &Confirmation| {
        let said = if here.holds? { "confirmed" } else { "not confirmed" };
        let added = (!here.added.is_empty()).then(|| here.added.join(" + "))?;
        Some(format!("{added} is {said} by the other recordings."))
    };
    confirmed.rungs.iter().filter_map(said).chain(own(confirmed)).collect()
}

/// What belongs to a recording, as the last rung has it.
fn own(confirmed: &Confirmed) -> Option<String> {
    let last = confirmed.rungs.last().filter(|last| !last.own.is_empty())?;
    let each = last.own.iter().map(|own| match own.name.as_str() {
        "home" => format!("the position's zero lies {} further on", quantity(own.value, &own.unit)),
        "shear" => format!("viscous friction is {} times as large", number(own.value)),
        name => format!("{name} is {}", quantity(own.value, &own.unit)),
    });
    let each: Vec<String> = each.collect();
    Some(format!(
        "Fitted there, as it belongs to a recording and not to the axis: {}.",
        each.join("; ")
    ))
}

/// What surrogates say of false alarms: the sum, and every name.
pub fn surrogates(found: &Surrogates) -> Vec<String> {
    let Surrogates { asked, count, named } = found;
    let sum = format!(
        "{} of {count} surrogates were given a name: recordings that the last model would have made, with its own errors \
         in another order. They hold nothing to find, so that every name is a false alarm.",
        named.len()
    );
    let cut = (count < asked).then(|| {
        format!(
            "{} more were asked for and do not count: they could not be made from the last model, or were not searched to \
             the end (--time-limit gives each of them more time).",
            asked - count
        )
    });
    std::iter::once(sum).chain(cut).chain(named.iter().map(|set| set.join(" + "))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::SplitError;

    #[test]
    fn surrogates_that_were_not_searched_to_the_end_are_no_silence() {
        let named = vec![vec!["spring".to_owned()]];
        let all = surrogates(&Surrogates { asked: 3, count: 3, named: named.clone() });
        assert!(all[0].starts_with("1 of 3 surrogates were given a name"), "{all:?}");
        assert_eq!(all[1..], ["spring"]);
        let cut = surrogates(&Surrogates { asked: 3, count: 1, named });
        assert!(cut[0].starts_with("1 of 1 surrogates"), "{cut:?}");
        assert!(cut[1].starts_with("2 more were asked for and do not count"), "{cut:?}");
    }

    #[test]
    fn errors_have_headings_and_values_in_their_unit() {
        let error = SplitError { fit: 1.0, validation: 2.0 };
        let relative = ErrorName::of(&NamedError::relative("force", error));
        assert_eq!(
            (relative.key.as_str(), relative.heading().as_str(), relative.value(0.0408)),
            ("force_relative", "force error, relative", "4.08 %".into())
        );
        let window = ErrorName::of(&NamedError::absolute("window", "m", error));
        assert_eq!(
            (window.key.as_str(), window.heading().as_str(), window.value(2e-6)),
            ("window_rms_m", "window error", "2.00 µm".into())
        );
    }

    #[test]
    fn the_floor_of_a_fraction_is_a_fraction() {
        let both = |value: f64| SplitError { fit: value, validation: value };
        let errors = [
            NamedError::relative("force", both(0.05)),
            NamedError::absolute("force", "N", both(0.5)),
            NamedError::absolute("window", "m", both(1e-6)),
        ];
        let json = serde_json::json!({"added": [], "effects": [], "parameters": {}, "error": {}, "p_value": null});
        let mut rung: Rung = serde_json::from_value(json).unwrap();
        rung.error = errors.iter().map(|error| (error.key(), error.clone())).collect();
        let mut found = discovery("effects_found", true);
        found.ladder = vec![rung];
        found.noise_floor = [("force_N".to_owned(), 0.1), ("position_m".to_owned(), 1e-7)].into();
        let floors: Vec<Option<f64>> =
            errors.iter().map(|error| floor(&found, &ErrorName::of(error))).collect();
        assert_eq!(floors, [Some(0.1 * 0.05 / 0.5), Some(0.1), None]);
    }

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
