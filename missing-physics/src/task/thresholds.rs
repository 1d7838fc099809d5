//! The numbers that steer a search.

/// Numbers that steer a search. Each stands in docs/decisions.md with what half and one and a half times of it do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Held-out log-likelihood that an effect must gain, nats.
    pub better: f64,
    /// Share of all that is explained that an effect must explain.
    pub share: f64,
    /// A model whose errors exceed what the sensors make by more than this factor is incomplete, and so is one that lacks a force
    /// of more than so many of its 95 % bands.
    pub complete: f64,
    /// A model that errs more than this many times what the sensors make at some place, at some time or in isolated
    /// samples is incomplete, whatever it does on the whole.
    pub local: f64,
    /// Largest p-value of an effect: how often any candidate gains as much as the last model would lose without it, where
    /// the errors that it leaves are shifted in time.
    pub chance: f64,
    /// Sets that are followed side by side.
    pub beam: usize,
    /// Candidates that are fitted beside each set.
    pub fitted: usize,
    /// Most effects of a set.
    pub most: usize,
}

impl Thresholds {
    /// The same where only this share of a recording is searched: there an effect gains as much less.
    #[must_use]
    pub fn in_part(self, share: f64) -> Self {
        Self { better: share * self.better, ..self }
    }

    /// By how many nats two models must differ where one of them gains `nats` over what came before.
    pub fn clear(&self, nats: f64) -> f64 {
        self.better.max(self.share * nats)
    }

    /// Largest chance that its gain recurs so often, of each effect in a model that is not complete: that
    /// of a search, of each candidate that is fitted beside a model (C. E. Bonferroni).
    pub fn recurs(&self) -> f64 {
        self.chance / self.fitted.max(1) as f64
    }
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            better: 80.0,
            share: 0.02,
            complete: 1.3,
            local: 2.0,
            chance: 0.05,
            beam: 3,
            fitted: 5,
            most: 4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_asks_for_its_share_and_nothing_else_changes() {
        let whole = Thresholds::default();
        let part = whole.in_part(0.25);
        assert_eq!(part, Thresholds { better: 20.0, ..whole });
    }

    #[test]
    fn what_is_clear_grows_with_what_is_explained() {
        let thresholds = Thresholds::default();
        assert_eq!((thresholds.clear(100.0), thresholds.clear(4000.0)), (80.0, 80.0));
        assert_eq!(thresholds.clear(10_000.0), 200.0);
    }
}
