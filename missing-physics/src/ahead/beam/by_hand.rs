//! Models that a person builds, effect by effect: fitted as a search fits them and told by the same numbers. Nothing is
//! decided: what was asked for is added, whether it is needed or not.

use super::{Search, Tell};
use crate::ahead::compare::Comparison;
use crate::ahead::fit::{self, Fitter};
use crate::ahead::found::IN_FULL;
use crate::ahead::node::Node;
use crate::ahead::screen::screen;
use crate::ahead::{Ahead, report};
use crate::family::{Fitted, ModelFamily, on_view};
use crate::report::Rung;
use crate::statistics::split::Split;
use crate::task::{Event, Thresholds};

/// The models of one recording. As in a search, parameters of a long recording are looked for on a part of it and refitted
/// on all.
pub struct ByHand<'a> {
    family: &'a dyn ModelFamily,
    whole: Box<dyn Ahead + 'a>,
    part: Option<Box<dyn Ahead + 'a>>,
    stop: &'a (dyn Fn() -> bool + Sync),
    tell: Tell<'a>,
}

impl<'a> ByHand<'a> {
    /// Models of `family`; nothing where it does not predict one sample ahead. Fits end early where `stop` says so, and
    /// `tell` hears of every step ([`Event::Fitted`]).
    pub fn new(
        family: &'a dyn ModelFamily,
        stop: &'a (dyn Fn() -> bool + Sync),
        tell: Tell<'a>,
    ) -> Option<Self> {
        let (whole, part) = (family.ahead()?, family.ahead_in_part());
        Some(Self { family, whole, part, stop, tell })
    }

    /// A model of these terms, from nothing but their usual sizes.
    pub fn identified(&self, terms: &[usize], seed: u64) -> Node {
        let everywhere = vec![1.0; self.family.target().len()];
        let search = self.search(Vec::new());
        let (searched, more) = search.parted(terms);
        let start = crate::fit::identify(self.family, &searched, &everywhere, seed);
        (self.tell)(&Event::BaseFitted { evaluations: start.evaluations });
        self.in_full(search.joined(search.base(start.fit.model), &more, terms))
    }

    /// A model near values that are known already.
    pub fn refitted(&self, near: Fitted) -> Node {
        let searched = self.search(Vec::new()).base_near(near);
        self.in_full(searched)
    }

    /// A model with one term more; nothing where the term has no place beside it, or where the fit was stopped.
    pub fn with(&self, from: &Fitted, term: usize) -> Option<Node> {
        if !self.family.joins(from, term) {
            return None;
        }
        let search = self.search(vec![term]);
        let below = search.base_near(from.clone());
        self.told(&below);
        let screened = screen(self.family, self.searched(), &below, &[term], false);
        let begun = search.begun(screened.promises.first()?, below.setting)?;
        self.told(&begun);
        let searched = search.rescanned(&begun);
        Some(self.in_full(searched))
    }

    /// A model at the bottom of its valley as a search sees it, to begin one with: from higher up a candidate would be told to
    /// gain what the model itself had left to gain.
    pub fn at_its_best(&self, near: Fitted) -> Fitted {
        let search = self.search(Vec::new());
        search.rescanned(&search.base_near(near)).model
    }

    /// A model with its values as they are.
    pub fn as_it_is(&self, model: Fitted) -> Node {
        let setting = fit::best_setting(&*self.whole, &model);
        fit::evaluated(&*self.whole, model, setting)
    }

    /// What is told of a model that has `added` beyond the one `below`.
    pub fn rung(&self, below: Option<&Node>, node: &Node, added: &[String]) -> Rung {
        let shown = on_view(self.family);
        let points = shown.target().len();
        let split = Split::new(points, shown.blocks());
        let fit = crate::fit::evaluate(shown, node.model.clone(), &vec![1.0; points]);
        let comparison = Comparison::new(self.family, &*self.whole);
        let gain = below.map(|below| comparison.compare(below, node).nats);
        let gain = gain.filter(|nats| nats.is_finite());
        Rung {
            added: added.to_vec(),
            likelihood_gain: gain,
            ..report::rung((self.family, &*self.whole), node, &fit, &split)
        }
    }

    /// What parameters are looked for on.
    fn searched(&self) -> &dyn Ahead {
        self.part.as_deref().unwrap_or(&*self.whole)
    }

    fn search(&self, candidates: Vec<usize>) -> Search<'_> {
        let (ahead, thresholds) = (self.searched(), Thresholds::default());
        Search::new(self.family, ahead, thresholds, candidates, self.stop, self.tell)
    }

    fn in_full(&self, node: Node) -> Node {
        self.told(&node);
        if self.part.is_none() {
            return node;
        }
        let setting = fit::best_setting(&*self.whole, &node.model);
        let fitter = Fitter::new(self.family, &*self.whole).stopped_by(self.stop);
        let node = fitter.fit(node.model, setting, IN_FULL);
        self.told(&node);
        node
    }

    fn told(&self, node: &Node) {
        let effects = node.names(self.family);
        let times = node.scale / self.whole.budget();
        (self.tell)(&Event::Fitted { effects: &effects, times });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::ahead::testing::{BEAT, Plant, WAVE};

    #[test]
    fn the_error_falls_with_the_effect_that_is_there_and_every_step_is_told() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let told = Mutex::new(Vec::new());
        let tell = |event: &Event<'_>| {
            if let Event::Fitted { effects, times } = event {
                told.lock().unwrap().push((effects.to_vec(), *times));
            }
        };
        let hand = ByHand::new(&plant, &|| false, &tell).unwrap();
        let base = hand.refitted(Plant::model(&[]));
        let with = hand.with(&base.model, WAVE).unwrap();
        let rung = hand.rung(Some(&base), &with, &["wave".to_owned()]);
        assert!(rung.budget.unwrap() < 0.9 * hand.rung(None, &base, &[]).budget.unwrap());
        assert!(rung.likelihood_gain.unwrap() > 80.0 && rung.p_value.is_none());
        let told = told.lock().unwrap();
        let (effects, times) = told.last().unwrap();
        assert_eq!((effects.as_slice(), Some(*times)), (&["wave".to_owned()][..], rung.budget));
        assert!(told.len() >= 3, "{told:?}");
    }

    #[test]
    fn what_is_asked_for_is_added_though_nothing_shows_it_and_gains_nothing() {
        let plant = Plant::new(2, &[(WAVE, &[0.05])]);
        let hand = ByHand::new(&plant, &|| false, &|_| {}).unwrap();
        let base = hand.as_it_is(Plant::model(&[(WAVE, &[0.05])]));
        let with = hand.with(&base.model, BEAT).unwrap();
        let rung = hand.rung(Some(&base), &with, &["beat".to_owned()]);
        assert_eq!(with.model.terms.last(), Some(&BEAT));
        assert!(rung.likelihood_gain.unwrap() < 15.0, "{:?}", rung.likelihood_gain);
    }

    #[test]
    fn a_search_that_begins_at_its_best_leaves_the_model_nothing_to_gain() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let hand = ByHand::new(&plant, &|| false, &|_| {}).unwrap();
        let far = Plant::model(&[(WAVE, &[0.2])]);
        let best = hand.as_it_is(hand.at_its_best(far.clone()));
        let again = hand.as_it_is(hand.at_its_best(best.model.clone()));
        let gain = |a: &Node, b: &Node| hand.rung(Some(a), b, &[]).likelihood_gain.unwrap();
        assert!(gain(&hand.as_it_is(far), &best) > 80.0);
        assert!(gain(&best, &again).abs() < 1.0);
    }

    #[test]
    fn a_fit_that_is_stopped_adds_nothing() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let hand = ByHand::new(&plant, &|| true, &|_| {}).unwrap();
        assert!(hand.with(&Plant::model(&[]), WAVE).is_none());
    }
}
