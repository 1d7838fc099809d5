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
        "'{first}' and '{second}' are two forms of one effect, of which a model has one: leave one out"
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
/// [`DiscoverError::UnknownTerm`] for a name that the family does not have.
pub fn terms(family: &dyn ModelFamily, names: &[String]) -> Result<Vec<usize>, DiscoverError> {
    let all = family.terms();
    let mut indices: Vec<usize> = (0..all.len()).filter(|&k| all[k].always).collect();
    for name in names {
        let index = all.iter().position(|term| &term.name == name).ok_or_else(|| {
            let known: Vec<&str> =
                all.iter().filter(|t| !t.always).map(|t| t.name.as_str()).collect();
            DiscoverError::UnknownTerm { name: name.clone(), known: known.join(", ") }
        })?;
        if !indices.contains(&index) {
            indices.push(index);
        }
    }
    Ok(indices)
}

/// The same for one model.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for a name that the family does not have, [`DiscoverError::TwoForms`] for two forms of an effect.
pub fn terms_of_model(
    family: &dyn ModelFamily,
    names: &[String],
) -> Result<Vec<usize>, DiscoverError> {
    let terms = terms(family, names)?;
    let main = |term: usize| family.form_of(term).unwrap_or(term);
    for (k, term) in terms.iter().enumerate() {
        if let Some(other) = terms[..k].iter().find(|other| main(**other) == main(*term)) {
            let name = |term: usize| family.terms()[term].name.clone();
            return Err(DiscoverError::TwoForms { first: name(*other), second: name(*term) });
        }
    }
    Ok(terms)
}

/// The model of a rung as it was found.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for an effect that the family does not have.
pub fn model_of(family: &dyn ModelFamily, rung: &Rung) -> Result<Fitted, DiscoverError> {
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
