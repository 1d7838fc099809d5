//! The loop: fit, see where it fails, screen, add, refit, until nothing more is gained.

use crate::ahead;
use crate::climb::Search;
use crate::family::ModelFamily;
use crate::report::Discovery;
use crate::task::{DiscoverError, Observer, Settings, terms};

/// Fits the base model, then adds what is missing until nothing is gained on held-out data.
///
/// # Errors
/// When a name in the settings is unknown.
pub fn discover<F: ModelFamily + ?Sized>(
    family: &F,
    settings: &Settings<'_>,
    observer: &mut (dyn Observer + Send),
) -> Result<Discovery, DiscoverError> {
    let base = terms(family, &settings.base)?;
    let excluded = terms(family, &settings.exclude)?;
    if let Some(reading) = ahead::Reading::of(family) {
        let sets = (base.as_slice(), excluded.as_slice());
        return Ok(ahead::discover(&reading, settings, sets, observer));
    }
    Ok(Search::new(family, settings, &base, excluded, observer).run())
}

/// Fits `names` on the fitted blocks, screens everything else once and stops: what a model lacks,
/// without adding it.
///
/// # Errors
/// When a name is unknown.
pub fn suggest<F: ModelFamily + ?Sized>(
    family: &F,
    settings: &Settings<'_>,
    observer: &mut (dyn Observer + Send),
) -> Result<Discovery, DiscoverError> {
    let once = Settings { most: 0, ..settings.clone() };
    discover(family, &once, observer)
}
