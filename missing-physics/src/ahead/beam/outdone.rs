//! Whether a model that was refused predicts better than the effects that were found.
//!
//! What ends at a limit, or lost what makes it that effect, is not named. It still shows how much of the error as few
//! effects can foretell. Where those that would be named in its place foretell less, they imitate a part of what is
//! missing and are not its cause, unless with them a base that is not complete errs no more than the sensors make: then
//! nothing is left that they do not foretell. So do those that leave something where a refused model of more effects leaves
//! nothing without them. Effects that the refused model has, too, stay, unless it goes on from all of them and what it does
//! beyond them is the greater part: then they are a smaller part of something else. And where nothing else was found, but a
//! refused model foretells what the base errs beyond the sensors, something is missing.
//! What one look refused, the next one asks, too.

use super::{Climb, STEPS, Search, negative};
use crate::ahead::compare::Difference;
use crate::ahead::found::leaves_most;
use crate::ahead::node::Node;
use crate::family::Fitted;
use crate::report::{Outcome, Reason, Refusal, Remains};

impl Search<'_> {
    /// The model without the effects that a refused one outdoes, and what is to be said of it: nothing of what every system
    /// has, which is nothing that is missing.
    pub(super) fn outdone(
        &mut self,
        climb: &Climb,
        last: &Node,
    ) -> Option<(Node, Option<Remains>)> {
        let base = &climb.base;
        let added = Self::added(base, last);
        let explains = self.explains(base, last);
        let is_rival = |refused: &Node| {
            if added.is_empty() {
                return !leaves_most(base, refused, self.ahead.budget());
            }
            let has_more = Self::added(base, refused).len() > added.len();
            let may = !has_more || (self.is_complete(refused) && !self.is_complete(last));
            may && !self.stands_for(base, last, refused) || self.is_lesser_part(base, last, refused)
        };
        // By how much it does more than it needs to, to take names.
        let asked = climb.refused.iter().filter(|(refused, _)| is_rival(refused));
        let asked = asked.filter_map(|(refused, refusal)| {
            let usual = self.is_usual_instead(base, last, refused);
            let by = self.comparison.compare(last, refused);
            let clear = self.thresholds.clear(self.comparison.compare(base, refused).nats);
            // What every system has need not do more, and gives way to what does more beyond doubt alone.
            let more = if !usual || added.is_empty() {
                by.nats - clear
            } else if self.is_needed_beside(base, last, (refused, negative(by))) {
                by.nats + clear
            } else {
                (by.nats + clear).max(self.thresholds.better)
            };
            (usual || !explains).then_some((refused, refusal, by, usual, more))
        });
        let (refused, refusal, by, usual, more) = asked.max_by(|a, b| a.4.total_cmp(&b.4))?;
        let lesser = self.is_lesser_part(base, last, refused);
        let outcome = if more > 0.0 { Outcome::Rival } else { Outcome::Worse };
        let because = Some(Reason::Refused { refusal: refusal.clone() });
        self.note(added.len(), refused, last, by, outcome, because);
        if outcome == Outcome::Worse || usual && added.is_empty() {
            return None;
        }
        let others = self.key(refused);
        let (kept, gone): (Vec<usize>, Vec<usize>) =
            added.iter().partition(|term| !lesser && others.contains(&self.main(**term)));
        let result = if kept.is_empty() { base.clone() } else { self.only(base, last, &kept) };
        let found = (!usual).then(|| Remains::Outdone {
            by: self.named(&Self::added(base, refused)),
            refusal: refusal.clone(),
            instead_of: self.named(&gone),
            nats: self.in_full(by.nats),
        });
        Some((result, found))
    }

    /// What is to be said where the data do not tell what makes an effect that effect, though they foretell more with it.
    pub(super) fn unknown(
        &self,
        climb: &Climb,
        node: &Node,
        refusal: &Refusal,
        gain: Difference,
    ) -> Option<Remains> {
        let is = matches!(refusal, Refusal::Unknown { .. });
        is.then(|| Remains::Outdone {
            by: self.named(&Self::added(&climb.base, node)),
            refusal: refusal.clone(),
            instead_of: Vec::new(),
            nats: self.in_full(gain.nats),
        })
    }

    /// The refused model that does most beyond the last one, where that is clear.
    pub(super) fn refused_most(&self, climb: &Climb, last: &Node) -> Option<Fitted> {
        let gains = climb.refused.iter().map(|(node, _)| {
            let clear = self.thresholds.clear(self.comparison.compare(&climb.base, node).nats);
            (node, self.comparison.compare(last, node).nats - clear)
        });
        let most = gains.filter(|(_, more)| *more > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(most.0.model.clone())
    }

    /// Asks a model that another look refused: that its own search may have ended beside it is no reason for a name.
    pub fn ask_again(&mut self, climb: &mut Climb, model: &Fitted) {
        if (self.stop)() {
            return;
        }
        let node = self.refit(model, climb.base.setting, STEPS.2);
        let size = Self::added(&climb.base, &node).len();
        let (gain, refusal) = self.asked(&climb.base.clone(), &climb.base.clone(), &node, size);
        if let Some(refusal) = refusal.filter(|_| gain.nats > self.thresholds.better) {
            climb.refused.push((node, refusal));
        }
    }

    /// Whether a refused model goes on from all effects of one that leaves something, and does the greater part of what
    /// both do to the squared error.
    fn is_lesser_part(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        let more = Self::added(base, refused).len() > Self::added(base, node).len();
        let goes_on = self.key(refused).is_superset(&self.key(node));
        more && !self.is_complete(node) && goes_on && self.does_most(base, node, refused)
    }

    /// Whether a model does the greater part of what it does to the squared error beyond what another one does.
    pub(super) fn does_most(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        let square = |node: &Node| self.budget(node).powi(2);
        square(node) - square(refused) > square(base) - square(node)
    }

    /// Whether a refused model is another way to write one: it has the same effects, or would have in the form that it
    /// is related to (a contact that gives more than its gap is wide is a spring), of which that one does the greater part.
    fn stands_for(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        let effects = self.key(node);
        let has = |terms: &[usize]| self.mains(terms).is_superset(&effects);
        let related = || self.ahead.relatives(&refused.model).iter().any(|model| has(&model.terms));
        has(&refused.model.terms) || related() && !self.does_most_of_it(base, node, refused)
    }

    /// The same beyond the effects that both have.
    fn does_most_of_it(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        self.does_most(&self.shared(base, node, refused), node, refused)
    }

    /// The base with the effects alone that two models have.
    pub(super) fn shared(&self, base: &Node, node: &Node, other: &Node) -> Node {
        let others = self.key(other);
        let mut both = Self::added(base, node);
        both.retain(|term| others.contains(&self.main(*term)));
        if both.is_empty() { base.clone() } else { self.only(base, node, &both) }
    }
}
