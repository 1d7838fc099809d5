//! What happens, as it happens.

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
    /// A set of effects has been fitted and compared.
    Compared {
        /// Number of effects beside the base.
        rung: usize,
        /// Their names.
        effects: &'a [String],
        /// Held-out log-likelihood gained, nats.
        nats: f64,
    },
    /// Sets of effects are known; now each effect is asked whether it is needed, and whether a simpler one or what is no
    /// effect does as well.
    Concluding,
    /// A model that a person builds has come this far ([`crate::ahead::ByHand`]).
    Fitted {
        /// Its effects.
        effects: &'a [String],
        /// Its prediction error over what the sensors alone make.
        times: f64,
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
