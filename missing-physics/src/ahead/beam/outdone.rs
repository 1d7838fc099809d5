//! Whether a model that was refused predicts better than the effects that were found.
//!
//! What ends at a limit, or lost what makes it that effect, is not named. It still shows how much of the error as few
//! effects can foretell. Where those that would be named in its place foretell less, they imitate a part of what is
//! missing and are not its cause, unless with them a base that is not complete errs no more than the sensors make: then
//! nothing is left that they do not foretell. So do those that leave something where a refused model of more effects leaves
//! nothing without them. Effects that the refused model has, too, stay, unless it goes on from all of them and what it does
//! beyond them is the greater part: then they are a smaller part of something else. And where nothing else was found, but a
//! refused model foretells what the base errs beyond the sensors, something is missing.

use super::{Climb, Search};
use crate::ahead::compare::Difference;
use crate::ahead::found::leaves_most;
use crate::ahead::node::Node;
use crate::report::{Outcome, Reason, Refusal, Remains};

impl Search<'_> {
    /// The model without the effects that a refused one outdoes, and what is to be said of it.
    pub(super) fn outdone(&mut self, climb: &Climb, last: &Node) -> Option<(Node, Remains)> {
        let base = &climb.base;
        let added = Self::added(base, last);
        if self.explains(base, last) {
            return None;
        }
        let is_rival = |refused: &Node| {
            if added.is_empty() {
                return !leaves_most(base, refused, self.ahead.budget());
            }
            let has_more = Self::added(base, refused).len() > added.len();
            let may = !has_more || (self.is_complete(refused) && !self.is_complete(last));
            may && !self.stands_for(refused, last) || self.is_lesser_part(base, last, refused)
        };
        let (refused, refusal, by) = climb
            .refused
            .iter()
            .filter(|(refused, _)| is_rival(refused))
            .map(|(node, refusal)| (node, refusal, self.comparison.compare(last, node)))
            .max_by(|a, b| a.2.nats.total_cmp(&b.2.nats))?;
        let clear = self.thresholds.clear(self.comparison.compare(base, refused).nats);
        let lesser = self.is_lesser_part(base, last, refused);
        let outcome = if by.nats > clear { Outcome::Rival } else { Outcome::Worse };
        let because = Some(Reason::Refused { refusal: refusal.clone() });
        self.note(added.len(), refused, last, by, outcome, because);
        if outcome == Outcome::Worse {
            return None;
        }
        let others = self.key(refused);
        let (kept, gone): (Vec<usize>, Vec<usize>) =
            added.iter().partition(|term| !lesser && others.contains(&self.main(**term)));
        let result = if kept.is_empty() { base.clone() } else { self.only(base, last, &kept) };
        let found = Remains::Outdone {
            by: self.named(&Self::added(base, refused)),
            refusal: refusal.clone(),
            instead_of: self.named(&gone),
            nats: self.in_full(by.nats),
        };
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

    /// Whether a refused model goes on from all effects of one that leaves something, and does the greater part of what
    /// both do to the squared error.
    fn is_lesser_part(&self, base: &Node, node: &Node, refused: &Node) -> bool {
        let more = Self::added(base, refused).len() > Self::added(base, node).len();
        let square = |node: &Node| self.budget(node).powi(2);
        let goes_on = self.key(refused).is_superset(&self.key(node));
        let greater = square(node) - square(refused) > square(base) - square(node);
        more && !self.is_complete(node) && goes_on && greater
    }

    /// Whether a refused model is another way to write one: it has the same effects, or would have in the form that it
    /// is related to (a contact that gives more than its gap is wide is a spring).
    fn stands_for(&self, refused: &Node, node: &Node) -> bool {
        let effects = self.key(node);
        let has = |terms: &[usize]| self.mains(terms).is_superset(&effects);
        let related = self.ahead.relatives(&refused.model);
        has(&refused.model.terms) || related.iter().any(|model| has(&model.terms))
    }
}
