//! The ways in: what is asked becomes a search, whatever a family can say of a recording.

use std::time::Instant;

use crate::ahead;
use crate::family::ModelFamily;
use crate::fit;
use crate::report::{Candidate, Discovery};
use crate::task::{DiscoverError, Event, Observer, Settings, terms, terms_of_model};

/// Fits the base model, then searches the set of effects that it lacks, by errors one sample ahead.
///
/// # Errors
/// When a name in the settings is unknown.
pub fn discover(
    family: &dyn ModelFamily,
    settings: &Settings<'_>,
    observer: &mut (dyn Observer + Send),
) -> Result<Discovery, DiscoverError> {
    let base = terms_of_model(family, &settings.base)?;
    let excluded = terms(family, &settings.exclude)?;
    if let Some(reading) = ahead::Reading::of(family) {
        let sets = (base.as_slice(), excluded.as_slice());
        return Ok(ahead::discover(&reading, settings, sets, observer));
    }
    Ok(by_residuals(family, settings, (&base, &excluded), observer))
}

/// The same for a family that only gives residuals: those of the base model, fitted to all of the recording, show how
/// large the noise is.
fn by_residuals(
    family: &dyn ModelFamily,
    settings: &Settings<'_>,
    sets: (&[usize], &[usize]),
    observer: &mut (dyn Observer + Send),
) -> Discovery {
    let started = Instant::now();
    let everywhere = vec![1.0; family.target().len()];
    let start = settings.start.clone().unwrap_or_else(|| {
        let found = fit::identify(family, sets.0, &everywhere, settings.seed);
        observer.event(&Event::BaseFitted { evaluations: found.evaluations });
        found.fit.model
    });
    let reading = ahead::Reading::of_residuals(family, &start);
    let left = settings.time_limit.map(|limit| limit.saturating_sub(started.elapsed()));
    let settings = Settings { start: Some(start), time_limit: left, ..settings.clone() };
    let mut discovery = ahead::discover(&reading, &settings, sets, observer);
    discovery.wall_s = started.elapsed().as_secs_f64();
    discovery
}

/// Fits `names` on the fitted blocks, screens everything else once and stops: what a model lacks,
/// without adding it.
///
/// # Errors
/// When a name is unknown.
pub fn suggest(
    family: &dyn ModelFamily,
    settings: &Settings<'_>,
    observer: &mut (dyn Observer + Send),
) -> Result<Discovery, DiscoverError> {
    let once = Settings { most: 0, ..settings.clone() };
    let mut discovery = discover(family, &once, observer)?;
    let best = likely(&discovery, settings).next().map(|best| best.effect.clone());
    discovery.most_likely = best;
    Ok(discovery)
}

/// Candidates that may be what the base model lacks, the best first: each is rarer than
/// [`alpha`](Settings::alpha) and gains what an effect must gain.
pub fn likely<'a>(
    discovery: &'a Discovery,
    settings: &Settings<'_>,
) -> impl Iterator<Item = &'a Candidate> {
    let (alpha, better) = (settings.alpha, settings.thresholds.better);
    let candidates = discovery.ranking.first().into_iter().flatten();
    candidates.filter(move |c| {
        c.p_value <= alpha && c.gain > 0.0 && c.nats.is_none_or(|nats| nats > better)
    })
}
