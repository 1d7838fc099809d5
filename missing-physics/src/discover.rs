//! The loop: fit, see where it fails, screen, add, refit, until nothing more is gained.

use std::sync::atomic::AtomicBool;
use std::time::Duration;

use crate::ahead::{self, Thresholds};
use crate::climb::Search;
use crate::family::{Fitted, ModelFamily};
use crate::fit::{self, Fit};
use crate::report::Discovery;

/// What is asked of a discovery.
#[derive(Clone, Debug)]
pub struct Settings<'a> {
    /// Names of the terms of the base model (those of every model need not be named).
    pub base: Vec<String>,
    /// The base model as it is known already, near which it is fitted; else it is searched for. Only where the family
    /// predicts one sample ahead.
    pub start: Option<Fitted>,
    /// Names of terms that are not to be tried.
    pub exclude: Vec<String>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Largest p-value at which an effect is added: the false-alarm rate of a screening.
    pub alpha: f64,
    /// Smallest share of the held-out squared error that an effect must remove.
    pub least_gain: f64,
    /// Most effects that are added.
    pub most: usize,
    /// Numbers that steer the search where the family predicts one sample ahead.
    pub thresholds: Thresholds,
    /// Set from outside to stop; what has been found is reported.
    pub stop: Option<&'a AtomicBool>,
    /// Time after which no new rung is begun.
    pub time_limit: Option<Duration>,
}

impl Default for Settings<'_> {
    fn default() -> Self {
        Self {
            base: Vec::new(),
            start: None,
            exclude: Vec::new(),
            seed: 1,
            alpha: 0.05,
            least_gain: 0.02,
            most: 8,
            thresholds: Thresholds::default(),
            stop: None,
            time_limit: None,
        }
    }
}

/// What happens, as it happens.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// The base model has been fitted.
    BaseFitted {
        /// Evaluations of the search.
        evaluations: usize,
    },
    /// Candidates are being screened for this rung, from 1.
    Screening {
        /// Number of the rung.
        rung: usize,
        /// Number of candidates.
        candidates: usize,
    },
    /// No single candidate helps: pairs of them are being screened.
    ScreeningPairs {
        /// Number of pairs.
        pairs: usize,
    },
    /// A candidate is being re-identified together with the whole model.
    Trying {
        /// Name of the effect.
        effect: &'a str,
        /// Share of the held-out squared error it is expected to remove.
        gain: f64,
        /// Its p-value.
        p_value: f64,
    },
    /// A set of effects has been fitted and compared.
    Compared {
        /// Number of effects beside the base.
        rung: usize,
        /// Their names.
        effects: &'a [String],
        /// Held-out log-likelihood gained, nats.
        nats: f64,
    },
    /// An effect was added.
    Added {
        /// Name of the effect.
        effect: &'a str,
        /// Relative error on held-out data before.
        before: f64,
        /// Relative error on held-out data after.
        after: f64,
    },
    /// Another form of an effect added before does as much as a new effect would.
    Replaced {
        /// Name of the form that it had.
        from: &'a str,
        /// Name of the form that it has now.
        to: &'a str,
    },
    /// An effect added before is no longer needed.
    Dropped {
        /// Name of the effect.
        effect: &'a str,
    },
    /// The loop has ended; the report is being made.
    Finishing,
}

/// Someone who watches.
pub trait Observer {
    /// Called for every event.
    fn event(&mut self, event: &Event<'_>);
}

/// Watches nothing.
impl Observer for () {
    fn event(&mut self, _: &Event<'_>) {}
}

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
}

/// The indices of terms by name, those of every model first.
///
/// # Errors
/// [`DiscoverError::UnknownTerm`] for a name that the family does not have.
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
        if !indices.contains(&index) {
            indices.push(index);
        }
    }
    Ok(indices)
}

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
    if let Some(one_ahead) = family.ahead() {
        let sets = (base.as_slice(), excluded.as_slice());
        return Ok(ahead::discover(family, &*one_ahead, settings, sets, observer));
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

/// A model at given values, evaluated on the whole grid.
pub fn evaluate<F: ModelFamily + ?Sized>(family: &F, model: Fitted) -> Fit {
    let weights = vec![1.0; family.target().len()];
    fit::evaluate(family, model, &weights)
}
