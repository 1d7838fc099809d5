//! Constants in C: their names, and numbers to the bit.

use crate::model::ModelEffect;

/// The constant of a parameter.
pub(crate) fn constant(effect: &str, parameter: &str) -> String {
    let name = format!("{effect}_{parameter}").to_uppercase();
    // Symbols such as F_c and F_C differ in their case only where they belong to one effect.
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// A law with the constants of a term in place of its parameters.
pub(crate) fn filled(term: &ModelEffect, law: &str) -> String {
    let parameters = term.effect().about().parameters;
    parameters.iter().fold(law.to_owned(), |law, parameter| {
        law.replace(&format!("{{{}}}", parameter.name), &constant(term.name(), parameter.name))
    })
}

/// A number that C reads back to the bit.
pub(crate) fn number(value: f64) -> String {
    if value < 0.0 { format!("({value:e})") } else { format!("{value:e}") }
}
