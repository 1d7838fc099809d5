//! Whether an effect is how a usual one of the base model is in this system.
//!
//! A friction level that sets in with the speed is a level and no lubricant that thins: simulators smooth it so, and some
//! guides do. Where an effect is another law of a usual one, and next to nothing of that one is left beside it, it is no
//! effect that is missing, and the search begins once more from the base model with that law.

use super::{Climb, STEPS, Search};
use crate::ahead::node::Node;
use crate::family::{ModelFamily, Role};
use crate::report::{Outcome, Reason, Remark};

/// Share of its amplitude in the base model that may be left of an effect beside another law of it.
const LEFT: f64 = 0.2;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The base model with an effect of the last one that leaves nothing of what it is another law of, if any does.
    pub(super) fn with_other_law(&mut self, climb: &Climb, last: &Node) -> Option<Node> {
        let base = &climb.base;
        let (law, of) = Self::added(base, last).into_iter().find_map(|law| {
            let of = self.family.law_of(law).filter(|_| !(self.stop)())?;
            let is = self.is_gone(base, last, of)? || self.does_without(base, last, of);
            is.then_some((law, of))
        })?;
        let with = self.only(base, last, &[law]);
        let by = self.comparison.compare(base, &with);
        self.note(1, &with, base, by, Outcome::Added, Some(Reason::OtherLaw));
        let name = |term: usize| self.family.terms()[term].name.clone();
        let nats = self.in_full(by.nats);
        self.remarks.push(Remark::OtherLaw { of: name(of), law: name(law), nats });
        Some(with)
    }

    /// Whether a model predicts as well without a term of the base model: it may stand on some of either law.
    fn does_without(&self, base: &Node, last: &Node, term: usize) -> bool {
        let model = last.model.without(self.family, term);
        let without = self.refit(&model, last.setting, STEPS.1);
        let gain = self.comparison.compare(base, last).nats;
        self.comparison.compare(&without, last).nats <= self.thresholds.clear(gain)
    }

    /// Whether next to nothing is left of a term of the base model; nothing where that does not have it.
    fn is_gone(&self, base: &Node, last: &Node, term: usize) -> Option<bool> {
        let place = base.model.terms.iter().position(|known| *known == term)?;
        let parameters = self.family.terms()[term].parameters.iter();
        let mut sizes = parameters.zip(base.model.range(self.family, place));
        Some(sizes.all(|(parameter, k)| {
            let (before, after) = (base.model.values[k], last.model.values[k]);
            parameter.role != Role::Amplitude || after.abs() <= LEFT * before.abs()
        }))
    }
}
