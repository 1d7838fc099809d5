//! Whether an effect is how a usual one of the base model is in this system, or how its recording is read.
//!
//! A friction level that sets in with the speed is a level and no lubricant that thins: simulators smooth it so, and some
//! guides do. Where an effect is another law of a usual one, and next to nothing of that one is left beside it, it is no
//! effect that is missing, and the search begins once more from the base model with that law. So it does with what stands for
//! the reading of the recording: how late a force acts belongs to the data, as its hold does.

use super::{Climb, Search};
use crate::ahead::node::Node;
use crate::ahead::refused::as_read;
use crate::family::Role;
use crate::report::{Outcome, Reason, Remark};

/// Share of its amplitude in the base model that may be left of an effect beside another law of it.
const LEFT: f64 = 0.2;
/// The same beside what else was found, where the law alone leaves so little: most of it is the law's.
const MOST: f64 = 0.5;

impl Search<'_> {
    /// The base model with an effect of the last one that leaves nothing of what it is another law of, beside the others or
    /// alone, if any does.
    pub(super) fn with_other_law(&mut self, climb: &Climb, last: &Node) -> Option<Node> {
        let base = &climb.base;
        let (law, of, with) = Self::added(base, last).into_iter().find_map(|law| {
            let of = self.family.law_of(law).filter(|_| !(self.stop)())?;
            let with = self.only(base, last, &[law]);
            // What is found beside it may stand on some of either.
            let left = |node: &Node| self.left(base, node, of);
            let is = left(last)? <= LEFT || left(last)? <= MOST && left(&with)? <= LEFT;
            is.then_some((law, of, with))
        })?;
        let by = self.comparison.compare(base, &with);
        self.note(1, &with, base, by, Outcome::Added, Some(Reason::OtherLaw));
        let name = |term: usize| self.family.terms()[term].name.clone();
        let nats = self.in_full(by.nats);
        self.remarks.push(Remark::OtherLaw { of: name(of), law: name(law), nats });
        Some(with)
    }

    /// The base model with an effect of the last one that stands for how the recording is read: without it what else was
    /// found, or what is left where nothing was, would be judged by what the reading leaves.
    pub(super) fn with_reading(&mut self, climb: &Climb, last: &Node) -> Option<Node> {
        let base = &climb.base;
        if Self::added(base, last).is_empty() || (self.stop)() {
            return None;
        }
        let (term, refusal) = as_read(self.family, self.ahead, base, last)?;
        let with = self.only(base, last, &[term]);
        let by = self.comparison.compare(base, &with);
        let because = Some(Reason::Refused { refusal: refusal.clone() });
        self.note(1, &with, base, by, Outcome::Added, because);
        let effect = self.family.terms()[term].name.clone();
        self.remarks.push(Remark::OfReading { effect, refusal, nats: self.in_full(by.nats) });
        Some(with)
    }

    /// The largest share that is left of an amplitude of a term of the base model; nothing where that does not have it.
    fn left(&self, base: &Node, node: &Node, term: usize) -> Option<f64> {
        let place = base.model.terms.iter().position(|known| *known == term)?;
        let parameters = self.family.terms()[term].parameters.iter();
        let sizes = parameters.zip(base.model.range(self.family, place));
        let sizes = sizes.filter(|(parameter, _)| parameter.role == Role::Amplitude);
        let left = |k: usize| (node.model.values[k] / base.model.values[k]).abs();
        // Of a level of 0 nothing is left: 0/0 is no number, and `max` passes over it.
        Some(sizes.map(|(_, k)| left(k)).fold(0.0, f64::max))
    }
}
