//! Candidates beside a model, the best first.

use crate::ahead::chance::Chance;
use crate::family::Fitted;

/// A candidate beside a model.
#[derive(Clone, Debug)]
pub struct Row {
    /// The term.
    pub term: usize,
    /// The model with it.
    pub model: Fitted,
    /// What it gains, nats.
    pub nats: f64,
    /// Chance of as much.
    pub p_value: f64,
}

/// Candidates beside one model.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The candidates, the best first.
    pub rows: Vec<Row>,
    /// What any candidate gains by chance, to first order.
    pub chance: Chance,
    /// Number of errors that say as much as independent ones.
    pub points: f64,
}

/// Candidates of which it must be known what they gain.
const ASKED: usize = 3;

impl Ranked {
    /// Replaces what the first candidates promise, as far as that is more than `least`, by what `gain` makes of them,
    /// until it is known of those that are first then.
    pub(super) fn ask(&mut self, least: f64, gain: impl Fn(usize, &Fitted) -> (Fitted, f64)) {
        let mut asked = Vec::new();
        loop {
            let first = self.rows.iter_mut().take(ASKED);
            let mut open = first.filter(|row| row.nats > least && !asked.contains(&row.term));
            let Some(row) = open.next() else { break };
            asked.push(row.term);
            (row.model, row.nats) = gain(row.term, &row.model);
            row.p_value = row.p_value.max(self.chance.p_value(row.nats));
            self.rows.sort_by(|a, b| b.nats.total_cmp(&a.nats));
        }
    }
}
