//! What effects do in C, as statements of one plant.

use super::constants::{constant, filled};
use crate::effects::{CDynamics, Slot};
use crate::model::ModelEffect;

/// What a term does beside its law; none where it is not written in C.
pub(super) fn dynamics(term: &ModelEffect) -> Option<CDynamics> {
    term.effect().c_dynamics().or_else(|| {
        // What acts by its law alone.
        let slots = term.effect().about().slots;
        let by_law =
            slots.iter().all(|slot| matches!(slot, Slot::SmoothForce | Slot::FrictionLevel));
        (by_law && term.effect().c_law().is_some()).then_some(CDynamics::NONE)
    })
}

/// Statements of a term whose states begin at `first`.
pub(super) fn with_states(
    term: &ModelEffect,
    statements: &str,
    first: usize,
    states: usize,
) -> String {
    let text = filled(term, statements);
    (0..states)
        .fold(text, |text, k| text.replace(&format!("{{s{k}}}"), &format!("m->s[{}]", first + k)))
}

/// Constants of a term, whose first parameter is number `first` of the plant.
pub(super) fn constants(
    term: &ModelEffect,
    first: usize,
    unit: impl Fn(usize) -> &'static str,
) -> String {
    use std::fmt::Write as _;
    let mut text = String::new();
    for (k, parameter) in term.effect().about().parameters.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "#define {} (m->p[{}]) /* {}: {} */",
            constant(term.name(), parameter.name),
            first + k,
            unit(k),
            parameter.meaning
        );
    }
    text
}
