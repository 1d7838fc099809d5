//! Terms by the names that a user gives.

use crate::family::{Fitted, ModelFamily};
use crate::report::Rung;

/// Why a discovery cannot begin.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DiscoverError {
    /// A term that the family does not have.
    #[error("there is no effect '{name}'; there are: {known}")]
    UnknownTerm {
        /// The name asked for.
        name: String,
        /// Every name there is.
        known: String,
    },
    /// Two forms of one effect, where a model has one.
    #[error(
        "'{first}' and '{second}' are two forms of one effect\na model has one of them: leave one out"
    )]
    TwoForms {
        /// The one that was named first.
        first: String,
        /// The other one.
        second: String,
    },
}

/// The indices of terms by name, those of every model first.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for a name that the family does not have, [`DiscoverError::TwoForms`] for two of one effect.
pub fn terms<F: ModelFamily + ?Sized>(
    family: &F,
    names: &[String],
) -> Result<Vec<usize>, DiscoverError> {
    let all = family.terms();
    let mut indices: Vec<usize> = (0..all.len()).filter(|&k| all[k].always).collect();
    for name in names {
        let index = all.iter().position(|term| &term.name == name).ok_or_else(|| {
            let known: Vec<&str> =
                all.iter().filter(|t| !t.always).map(|t| t.name.as_str()).collect();
            DiscoverError::UnknownTerm { name: name.clone(), known: known.join(", ") }
        })?;
        if indices.contains(&index) {
            continue;
        }
        let main = |term: usize| family.form_of(term).unwrap_or(term);
        if let Some(other) = indices.iter().find(|other| main(**other) == main(index)) {
            let (first, second) = (all[*other].name.clone(), name.clone());
            return Err(DiscoverError::TwoForms { first, second });
        }
        indices.push(index);
    }
    Ok(indices)
}

/// The model of a rung as it was found.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for an effect that the family does not have.
pub fn model_of<F: ModelFamily + ?Sized>(family: &F, rung: &Rung) -> Result<Fitted, DiscoverError> {
    let indices = terms(family, &rung.effects)?;
    let values = indices.iter().flat_map(|&index| {
        let term = &family.terms()[index];
        term.parameters.iter().map(|parameter| {
            let found = rung.parameters.get(&term.key(parameter));
            found.map_or(parameter.start, |estimate| estimate.value)
        })
    });
    let values = values.collect();
    Ok(Fitted { terms: indices, values })
}
