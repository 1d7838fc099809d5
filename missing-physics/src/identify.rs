//! A model of given effects: identified, and with one effect more. Nothing is looked for.

use aep_core::{Aep, Method};

use crate::diagnosis::{comparison, fitted_blocks, rung};
use crate::family::ModelFamily;
use crate::fit::{Fit, Found, Until, identify_by};
use crate::report::Discovery;
use crate::task::{DiscoverError, terms_of_model};

/// Identifies a model of the terms called `names` and those of every model, on the fitted blocks; once `until` is over the
/// best of the search so far is refined.
///
/// # Errors
/// When a name is unknown.
pub fn identify(
    family: &dyn ModelFamily,
    names: &[String],
    method: (&dyn Method<f64>, u64),
    until: Until<'_>,
) -> Result<Found, DiscoverError> {
    let terms = terms_of_model(family, names)?;
    Ok(identify_by(family, &terms, &fitted_blocks(family), method, until))
}

/// A model before and after an effect was added.
pub struct Extended {
    /// The model with the effect, refitted.
    pub fit: Fit,
    /// Both as rungs, and where the second one fails.
    pub comparison: Discovery,
}

/// Adds the term called `added` to the model of `before` and refits it; once `until` is over with what there is.
///
/// # Errors
/// When the name is unknown.
pub fn extend(
    family: &dyn ModelFamily,
    before: &Fit,
    added: &str,
    seed: u64,
    until: Until<'_>,
) -> Result<Extended, DiscoverError> {
    let first = rung(family, before, &[]);
    let added = added.to_owned();
    let names: Vec<String> = first.effects.iter().chain([&added]).cloned().collect();
    let fit = identify(family, &names, (&Aep::practical(), seed), until)?.fit;
    let rungs = vec![first, rung(family, &fit, &[added])];
    let comparison = comparison(family, (before, &fit), rungs, seed, &|| until.is_over());
    Ok(Extended { fit, comparison })
}
