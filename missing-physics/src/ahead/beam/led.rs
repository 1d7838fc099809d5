//! A set that another reading of the recording led to.
//!
//! A wrong reading takes an effect of its own to make up for it; without that effect its set belongs to the other one,
//! whose own search may have ended beside it, in another valley.

use super::{Climb, Search};
use crate::ahead::node::Node;

impl Search<'_> {
    /// Whether a search goes on from such a set: where it predicts better than all others of its size.
    pub(super) fn follows(&self, climb: &mut Climb, led: &Node) -> bool {
        let size = Self::added(&climb.base, led).len();
        let best = climb.nodes.get(size).and_then(|sets| sets.first());
        let known = best.is_some_and(|best| self.comparison.compare(best, led).nats <= 0.0);
        if size == 0 || known {
            return false;
        }
        climb.nodes.truncate(size + 1);
        climb.ranking.truncate(size);
        // The sizes below that the search did not come to.
        let mut below = Vec::new();
        for _ in climb.nodes.len()..size {
            let last = below.last().unwrap_or(led);
            let added = Self::added(&climb.base, last).into_iter();
            let each = added.map(|term| self.without(climb, last, term));
            let least = each.min_by(|a, b| a.deviation.total_cmp(&b.deviation));
            below.extend(least);
        }
        climb.nodes.extend(below.into_iter().rev().map(|set| vec![set]));
        climb.nodes.resize(size + 1, Vec::new());
        climb.nodes[size].retain(|set| self.key(set) != self.key(led));
        climb.nodes[size].insert(0, led.clone());
        for k in climb.ranking.len()..size {
            let (from, to) = (climb.nodes[k][0].clone(), climb.nodes[k + 1][0].clone());
            let beside = self.beside(climb, &from);
            climb.ranking.push(self.ranked(&from, &[to], beside));
        }
        climb.beam = vec![led.clone()];
        climb.ended = false;
        true
    }
}
