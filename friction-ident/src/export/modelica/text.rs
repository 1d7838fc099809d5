//! Text of Modelica: identifiers, numbers, units, strings.

use std::fmt::Write as _;

use crate::model::ModelEffect;

/// Words that name nothing (Modelica 3.6, section 2.3.3), and the types and variables of every model.
const TAKEN: &str = "algorithm and annotation block break class connect connector constant constrainedby der \
    discrete each else elseif elsewhen encapsulated end enumeration equation expandable \
    extends external false final flow for function if import impure in initial inner input \
    loop model not operator or outer output package parameter partial protected public pure \
    record redeclare replaceable return stream then true type when while within Real Integer \
    Boolean String time";

/// Whether a model cannot be called so.
pub(super) fn is_taken(name: &str) -> bool {
    TAKEN.split(' ').any(|word| word == name)
}

/// What stands for an effect in the names of its parameters and variables.
pub(super) fn identifier(effect: &str) -> String {
    effect.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// The name of a parameter.
pub(super) fn parameter(effect: &str, parameter: &str) -> String {
    format!("{}_{}", identifier(effect), identifier(parameter))
}

/// A law with the names of a term in place of its own: `{F_C}` is a parameter, `{}` begins the name of a variable.
pub(super) fn filled(term: &ModelEffect, law: &str) -> String {
    let parameters = term.effect().about().parameters;
    let law = law.replace("{}", &identifier(term.name()));
    parameters.iter().fold(law, |law, known| {
        law.replace(&format!("{{{}}}", known.name), &parameter(term.name(), known.name))
    })
}

/// A number that Modelica reads back to the bit.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// `N s^2/m^2` as `N.s2/m2` (section 19.1).
pub(super) fn unit(unit: &str) -> String {
    unit.replace(' ', ".").replace('^', "")
}

/// Text within quotes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Lines, each behind two spaces and ended.
pub(super) fn indented(lines: &[String]) -> String {
    let mut text = String::new();
    for line in lines.iter().flat_map(|text| text.lines()) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {line}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::{Axis, Effort, Quantity};

    #[test]
    fn units_are_written_as_modelica_has_them() {
        let of = |axis, quantity| unit(Effort::Si.unit(axis, quantity));
        assert_eq!(of(Axis::Linear, Quantity::Drag), "N.s2/m2");
        assert_eq!(of(Axis::Rotary, Quantity::Damping), "N.m.s/rad");
        assert_eq!(of(Axis::Rotary, Quantity::Mass), "kg.m2");
        assert_eq!(unit(Effort::Volt.unit(Axis::Linear, Quantity::Mass)), "V.s2/m");
    }

    #[test]
    fn numbers_come_back_to_the_bit_and_strings_end_where_they_should() {
        for value in [0.1 + 0.2, -1e-300, 2.0, 5e22, f64::MIN_POSITIVE] {
            assert_eq!(number(value).parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
        assert_eq!(quoted("a \"b\" \\"), "\"a \\\"b\\\" \\\\\"");
    }
}
