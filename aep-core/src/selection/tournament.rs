//! Fogel's tournament over parents and children.

use serde::{Deserialize, Serialize};

use crate::random::{Streams, index};
use crate::{Individual, Population, Scalar, Selection};

/// Which of two candidates with equally many wins is preferred. Not settled by the literature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ties {
    /// The one with the smaller cost.
    #[default]
    Cost,
    /// Parents before children, lower slots first.
    Order,
}

/// Stochastic q-tournament of evolutionary programming (Fogel 1991).
///
/// Each of the 2 N parents and children meets `opponents` candidates drawn uniformly with
/// replacement and wins where its cost is not larger; the N with most wins survive. The best
/// candidate wins all its encounters. With [`Ties::Cost`] it always survives; with [`Ties::Order`]
/// it can lose its place to equally successful ones when more than N of them win everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tournament {
    /// Encounters of each candidate, q; 10 in the literature.
    pub opponents: usize,
    /// Order of candidates with equally many wins.
    pub ties: Ties,
}

impl Default for Tournament {
    fn default() -> Self {
        Self { opponents: 10, ties: Ties::Cost }
    }
}

impl Tournament {
    fn wins<T: Scalar>(&self, candidate: usize, costs: &[T], streams: Streams) -> usize {
        let mut rng = streams.stream(candidate);
        (0..self.opponents)
            .filter(|_| costs[candidate] <= costs[index(&mut rng, costs.len())])
            .count()
    }

    /// All candidates, those who survive first.
    fn order<T: Scalar>(&self, costs: &[T], streams: Streams) -> Vec<usize> {
        let wins: Vec<usize> = (0..costs.len()).map(|i| self.wins(i, costs, streams)).collect();
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|&a, &b| {
            let by_cost = || costs[a].partial_cmp(&costs[b]).unwrap_or(std::cmp::Ordering::Equal);
            let tie = if self.ties == Ties::Cost { by_cost() } else { std::cmp::Ordering::Equal };
            wins[b].cmp(&wins[a]).then(tie)
        });
        order
    }
}

impl<T: Scalar, I: Individual<T>> Selection<T, I> for Tournament {
    fn select(
        &self,
        parents: &mut Population<T, I>,
        children: &mut Population<T, I>,
        streams: Streams,
    ) {
        let count = parents.len();
        for i in 0..count {
            if children.costs[i] < parents.costs[i] {
                let (from, to) = (parents.positions.row(i), children.positions.row(i));
                children.individuals[i].won(from, to);
            } else {
                children.individuals[i].survived();
            }
            parents.individuals[i].survived();
        }
        let costs: Vec<T> = parents.costs.iter().chain(&children.costs).copied().collect();
        let order = self.order(&costs, streams);
        // As many parents go as children come: the n-th loser makes room for the n-th newcomer.
        let (survivors, losers) = order.split_at(count);
        let newcomers = survivors.iter().filter(|&&candidate| candidate >= count);
        let vacant = losers.iter().filter(|&&candidate| candidate < count);
        for (&slot, &candidate) in vacant.zip(newcomers) {
            parents.take(slot, children, candidate - count);
        }
    }
}
