//! How a discovery is put into words, the same on the page and in the terminal.

use missing_physics::measurement::quantity::{number, percent, quantity};
use missing_physics::report::{
    Candidate, Confirmation, Confirmed, Diagnosis, Discovery, Estimate, MissingForce, Rung,
    SplitError, Surrogates, Verdict, Whiteness,
};

mod compared;

pub use compared::{
    COMPARED, COMPARED_HEADINGS, Compared, compared, comparisons, effects_of, needed, outcome,
    why_nothing,
};

/// From this p-value on a finding may well be chance.
const CHANCE: f64 = 0.05;

/// What an error of a rung is, told by its key in the JSON.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ErrorName {
    /// The key, e.g. `force_rms_N`.
    pub key: String,
    /// What is compared, e.g. `force`.
    pub quantity: String,
    /// SI unit; empty for a fraction.
    pub unit: String,
}

impl ErrorName {
    /// Takes apart `force_relative` (a fraction) or `force_rms_N` (in its unit).
    pub fn parse(key: &str) -> Self {
        let (name, unit) = match key.split_once("_rms_") {
            Some((name, unit)) => (name, unit.replace('_', "/")),
            None => (key.strip_suffix("_relative").unwrap_or(key), String::new()),
        };
        Self { key: key.to_owned(), quantity: name.replace('_', " "), unit }
    }

    /// Whether it is a fraction of the quantity's own size.
    pub fn is_relative(&self) -> bool {
        self.key.ends_with("_relative")
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
        if self.is_relative() { percent(value) } else { quantity(value, &self.unit) }
    }
}

/// The errors of the ladder: those relative first, then absolute ones of the same quantity, then
/// the other views.
pub fn errors(discovery: &Discovery) -> Vec<ErrorName> {
    let first = discovery.ladder.first();
    let keys = first.into_iter().flat_map(|rung| rung.error.keys());
    let mut names: Vec<ErrorName> = keys.map(|key| ErrorName::parse(key)).collect();
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
    let entries = discovery.noise_floor.iter();
    let (key, floor) =
        entries.clone().find(|(key, _)| key.starts_with(&format!("{}_", name.quantity)))?;
    if !name.is_relative() {
        return (key.ends_with(&name.unit)).then_some(*floor);
    }
    // A fraction of the quantity's size, which is the absolute error over the relative one.
    let base = discovery.ladder.first()?;
    let relative = base.error.get(&name.key)?.validation;
    let absolute = base
        .error
        .iter()
        .map(|(key, error)| (ErrorName::parse(key), error))
        .find(|(other, _)| other.quantity == name.quantity && !other.is_relative())?
        .1
        .validation;
    (absolute > 0.0).then(|| floor * relative / absolute)
}

/// Whether the search was cut before its end, so that what was found is what was found so far.
pub fn is_cut(discovery: &Discovery) -> bool {
    let said = |note: &String| note.starts_with("Stopped before the end");
    let stopped = discovery.verdict == Verdict::Stopped;
    stopped || !discovery.untried.is_empty() || discovery.notes.iter().any(said)
}

/// The verdict in two or three words.
pub fn verdict(discovery: &Discovery) -> &'static str {
    match discovery.verdict {
        Verdict::Stopped => "Stopped before anything was found",
        // What stands was compared; what else there is was not looked for.
        Verdict::EffectsFound | Verdict::Ambiguous if is_cut(discovery) => "Found so far",
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
    Some(format!("{word}: {} times what the sensors make is left", times(budget.last)))
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
    const SMALLEST: f64 = 1.0 / (missing_physics::ahead::chance::SHIFTS as f64 + 1.0);
    if p_value <= SMALLEST * (1.0 + 1e-9) {
        format!("<= {}", self::p_value(SMALLEST))
    } else {
        self::p_value(p_value)
    }
}

/// What a candidate that was not to be added promises; nothing where it is not told in nats.
pub fn suggestion(best: &Candidate) -> Option<String> {
    let gain = nats(best.nats?);
    let chance = chance(best.p_value);
    let equals = if chance.starts_with('<') { "" } else { "= " };
    Some(format!(
        "Most likely missing: {}. One sample ahead the model with it gains {gain} nats (p {equals}{chance}). Nothing \
         was added.",
        best.effect
    ))
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
    rung.added.as_ref().map_or_else(|| "base model".to_owned(), |effect| format!("+ {effect}"))
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
    let at = |rung: &Rung| rung.error.get(&name.key).map(|error: &SplitError| error.validation);
    let (first, last) = (at(discovery.ladder.first()?)?, at(discovery.ladder.last()?)?);
    (first > floor).then(|| ((first - last) / (first - floor)).clamp(0.0, 1.0))
}

/// Unit of the compared quantity; empty where no error is known.
pub fn main_unit(discovery: &Discovery) -> String {
    let Some(main) = main_error(discovery) else { return String::new() };
    let same = |name: &ErrorName| name.quantity == main.quantity && !name.is_relative();
    errors(discovery).into_iter().find(same).map(|name| name.unit).unwrap_or_default()
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

fn whiteness(test: &Whiteness) -> String {
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
pub const CONFIRMATION: &str = "parameters as found, nothing fitted; 'gain anew': screened there with the \
    model below it identified anew, 'place' among the likely";

/// Headings of the table of a confirmation.
pub fn confirmation_headings(discovery: &Discovery) -> Vec<String> {
    let errors = errors(discovery).into_iter().map(|name| name.heading());
    let rest = ["holds", "gain anew", "p-value", "place"].map(str::to_owned);
    std::iter::once("rung".to_owned()).chain(errors).chain(rest).collect()
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
        let place = here.place.map_or_else(dash, |place| place.to_string());
        std::iter::once(self::rung(rung)).chain(errors).chain([holds, gain, p, place]).collect()
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
        Some(format!("{} is {said} by the other recordings.", here.added.as_ref()?))
    };
    confirmed.rungs.iter().filter_map(said).collect()
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
    fn keys_of_errors_become_words_with_units() {
        let relative = ErrorName::parse("force_relative");
        assert_eq!(
            (relative.heading().as_str(), relative.value(0.0408)),
            ("force error, relative", "4.08 %".into())
        );
        let window = ErrorName::parse("window_rms_m");
        assert_eq!(
            (window.heading().as_str(), window.value(2e-6)),
            ("window error", "2.00 µm".into())
        );
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
    fn a_suggestion_names_the_effect_and_what_it_gains() {
        let json =
            serde_json::json!({"effect": "drift", "gain": 0.1, "p_value": 0.001, "nats": 340.2});
        let best: Candidate = serde_json::from_value(json).unwrap();
        let said = suggestion(&best).unwrap();
        assert!(said.starts_with("Most likely missing: drift."), "{said}");
        assert!(said.contains("gains +340 nats (p <= 0.001)"), "{said}");
        assert_eq!(suggestion(&Candidate { nats: None, ..best }), None);
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
    }

    #[test]
    fn what_a_search_found_before_it_was_cut_was_found_so_far() {
        let whole = discovery("effects_found", true);
        assert_eq!(verdict(&whole), "Missing effect found");
        for verdict in ["effects_found", "ambiguous"] {
            let untried = vec!["drift".to_owned()];
            let cut = Discovery { untried, ..discovery(verdict, true) };
            assert_eq!(super::verdict(&cut), "Found so far");
            let notes = vec!["Stopped before the end: ...".to_owned()];
            let noted = Discovery { notes, ..discovery(verdict, true) };
            assert_eq!(super::verdict(&noted), "Found so far");
        }
        assert_eq!(verdict(&discovery("stopped", false)), "Stopped before anything was found");
    }
}
