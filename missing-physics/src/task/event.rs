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
    /// An effect was added, or several that only help together.
    Added {
        /// Names of the effects.
        effects: &'a [String],
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
