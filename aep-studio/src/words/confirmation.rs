//! What other recordings say of what was found, and surrogates of false alarms.

use missing_physics::Discovery;
use missing_physics::measurement::quantity::{number, percent, quantity};
use missing_physics::report::{Confirmation, Confirmed, Rung, Surrogates};

use super::{errors, p_value};

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
        std::iter::once(super::rung(rung)).chain(errors).chain([holds, gain, p]).collect()
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
}
