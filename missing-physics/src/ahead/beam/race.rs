//! Which candidates are fitted: those that lead after a few steps, where more of them promise enough than can be.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::Search;
use crate::ahead::node::Node;
use crate::ahead::screen::Promise;

/// Effects that begin for each place.
const BEGIN: usize = 2;

impl Search<'_> {
    /// What is fitted beside the `first` ones, so that it is `most` effects: of more that promise enough those that are
    /// lowest after a few steps go on from there. A promise may err by more than what lies between two of them
    /// (successive halving: K. Jamieson and A. Talwalkar, 2016).
    pub(super) fn raced(
        &self,
        first: &[&Promise],
        promises: &[Promise],
        (setting, least): (usize, f64),
        most: usize,
    ) -> Vec<Promise> {
        let chosen = self.chosen(promises, least, BEGIN * most);
        let begin = &chosen[first.len()..];
        let effects = |of: &[&Promise]| -> BTreeSet<usize> {
            of.iter().map(|promise| self.main(promise.term)).collect()
        };
        if effects(&chosen).len() <= most || (self.stop)() {
            return begin.iter().copied().cloned().collect();
        }
        let tried = begin.par_iter();
        let tried = tried.filter_map(|promise| Some((*promise, self.tried(promise, setting)?)));
        let mut tried: Vec<(&Promise, Node)> = tried.collect();
        tried.sort_by(|(_, a), (_, b)| a.deviation.total_cmp(&b.deviation));
        let mut go_on = effects(first);
        tried.retain(|(promise, _)| {
            let main = self.main(promise.term);
            go_on.contains(&main) || go_on.len() < most && go_on.insert(main)
        });
        let from_there = |(promise, node): (&Promise, Node)| Promise {
            starts: vec![node.model],
            ..promise.clone()
        };
        tried.into_iter().map(from_there).collect()
    }
}
