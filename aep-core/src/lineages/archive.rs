//! What a lineage has evaluated.

use serde::{Deserialize, Serialize};

/// Positions and their finite costs, the latest ones.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Archive {
    positions: Vec<f64>,
    costs: Vec<f64>,
    /// All that were noted, forgotten ones included.
    noted: u64,
}

impl Archive {
    /// Notes a cost, and forgets the oldest entries beyond `most`.
    pub fn note(&mut self, position: &[f64], cost: f64, most: usize) {
        self.positions.extend_from_slice(position);
        self.costs.push(cost);
        self.noted += 1;
        // Seldom, because everything moves.
        if self.costs.len() > 2 * most {
            let over = self.costs.len() - most;
            self.costs.drain(..over);
            self.positions.drain(..over * position.len());
        }
    }

    pub fn noted(&self) -> u64 {
        self.noted
    }

    /// The latest entries, at most `most`, the oldest first.
    pub fn latest(&self, most: usize) -> impl Iterator<Item = (&[f64], f64)> {
        let n = self.positions.len() / self.costs.len().max(1);
        let from = self.costs.len().saturating_sub(most);
        (from..self.costs.len()).map(move |i| (&self.positions[i * n..(i + 1) * n], self.costs[i]))
    }
}
