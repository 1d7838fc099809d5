//! What a verdict rests on.

use std::collections::BTreeMap;

use super::screen::Screened;
use crate::fit::Fit;
use crate::report::{NamedError, Where};

/// Another view contradicts an effect where its error grows by this factor on held-out data and on
/// fitted data as well: one of them alone is a matter of a few windows.
pub(crate) const CONTRADICTION: f64 = 1.05;

/// All that the verdict rests on.
pub struct Grounds<'a> {
    /// Where the base model fails.
    pub where_base: Vec<Where>,
    /// Where the last model fails.
    pub where_last: Vec<Where>,
    /// The base model.
    pub base: &'a Fit,
    /// The last model.
    pub last: &'a Fit,
    /// The last screening.
    pub screened: &'a [Screened],
    /// False-alarm rate of a screening.
    pub alpha: f64,
    /// True where time ran out or the user stopped it.
    pub interrupted: bool,
    /// Views in which the last model leaves no more than the noise of the measurement may.
    pub within_noise: BTreeMap<String, NamedError>,
}

/// Errors by their keys.
pub(super) fn by_key(errors: Vec<NamedError>) -> BTreeMap<String, NamedError> {
    errors.into_iter().map(|error| (error.key(), error)).collect()
}
