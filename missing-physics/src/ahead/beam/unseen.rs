//! What every system has, too little of it to be seen, in the place of an effect.
//!
//! Friction gives before it slides. Where it gives less than a count nobody sees that it does, but the last count shows it, and
//! what has as many parameters (a coupling, a lag) predicts that, too. Such a contact is refused, as nobody can tell it from
//! none, and stands in the place of one effect all the same where that does no more: it is nothing that is missing.

use super::rivals::PROMISED;
use super::{Climb, Costs, STEPS, Search};
use crate::ahead::compare::Difference;
use crate::ahead::found::Found;
use crate::ahead::node::Node;
use crate::ahead::screen::screen;

impl Search<'_> {
    /// Asks what every system has, too little of it to be seen, in the place of each effect that would be told, or of all
    /// that was refused: it may do as much, and the search need not have come by it.
    pub(super) fn ask_unseen(&mut self, climb: &mut Climb, last: &Node, costs: &Costs) {
        let Some(term) = self.ahead.may_be_unseen() else { return };
        let base = climb.base.clone();
        let clear = self.thresholds.clear(self.comparison.compare(&base, last).nats);
        let each = costs.iter().map(|(_, cost, without)| (without.clone(), cost.nats - clear));
        let mut places: Vec<(Node, f64)> = each.collect();
        if costs.is_empty() && !climb.refused.is_empty() {
            places.push((base.clone(), self.thresholds.better));
        }
        for (from, least) in places {
            if (self.stop)() || Found::is_in(&from.model.terms, term, self.family) {
                continue;
            }
            let screened = screen(self.family, self.ahead, &from, &[term], false);
            let promise = screened.promises.into_iter().next();
            let promise = promise.filter(|promise| promise.gain >= PROMISED * least);
            let Some(begun) = promise.and_then(|promise| self.begun(&promise, from.setting)) else {
                continue;
            };
            let node = self.refit(&begun.model, begun.setting, STEPS.2);
            if !self.ahead.is_unseen(&node.model, &base.model) {
                continue;
            }
            let size = Self::added(&base, &node).len();
            let (gain, refusal) = self.asked(&base, &from, &node, size);
            if let Some(refusal) = refusal.filter(|_| gain.nats > self.thresholds.better) {
                climb.refused.push((node, refusal));
            }
        }
    }

    /// Whether a model does more than one with what every system has in the place of an effect, over which it has a `gain`:
    /// again and again, or the greater part of what it does (a limit of the force is reached now and then).
    pub(super) fn is_needed_beside(
        &self,
        base: &Node,
        node: &Node,
        (usual, gain): (&Node, Difference),
    ) -> bool {
        let again = gain.recurs_by_chance() <= self.thresholds.recurs();
        again || self.does_most(&self.shared(base, node, usual), usual, node)
    }

    /// Whether a refused model has what every system has, too little to be seen, beside effects of one or none of them,
    /// and leaves no more: where it does as much, what few systems have need not be there. Of a base that leaves something
    /// it says nothing: something is missing there.
    pub(super) fn is_usual_instead(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        let beyond = self.key(refused).difference(&self.key(node)).count();
        let leaves_more = self.is_complete(node) && !self.is_complete(refused);
        let beside = self.is_complete(base) && beyond == 1 && !leaves_more;
        beside && self.ahead.is_unseen(&refused.model, &base.model)
    }
}
