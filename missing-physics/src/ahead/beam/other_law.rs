//! Whether an effect is how a usual one of the base model is in this system.
//!
//! A friction level that sets in with the speed is a level and no lubricant that thins: simulators smooth it so, and some
//! guides do. Where an effect is another law of a usual one, and that one does next to nothing beside it, it is no effect
//! that is missing, and the search begins once more from the base model with that law.

use super::{Climb, Costs, STEPS, Search};
use crate::ahead::node::Node;
use crate::family::ModelFamily;
use crate::report::{Outcome, Reason, Remark};

/// What a usual effect may do to the squared error beside its other law, as a share of what that one does: where both are
/// there neither is idle.
const IDLE: f64 = 0.1;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The base model with an effect of the last one that leaves nothing of what it is another law of, if any does;
    /// `costs` says what each effect does.
    pub(super) fn with_other_law(
        &mut self,
        climb: &Climb,
        last: &Node,
        costs: &Costs,
    ) -> Option<Node> {
        let base = &climb.base;
        for (term, _, other) in costs {
            let term = *term;
            let of = self.family.law_of(term).filter(|of| base.model.terms.contains(of));
            let Some(of) = of.filter(|_| !(self.stop)()) else { continue };
            let without = last.model.without(self.family, of);
            let without = self.refit(&without, last.setting, STEPS.1);
            let by = self.comparison.compare(last, &without);
            let does = |without: &Node| self.budget(without).powi(2) - self.budget(last).powi(2);
            let idle = does(&without) < IDLE * does(other);
            let outcome = if idle { Outcome::Added } else { Outcome::Worse };
            let size = Self::added(base, last).len();
            self.note(size, &without, last, by, outcome, Some(Reason::OtherLaw));
            if !idle {
                continue;
            }
            let with = self.only(base, last, &[term]);
            let name = |term: usize| self.family.terms()[term].name.clone();
            let nats = self.in_full(self.comparison.compare(base, &with).nats);
            self.remarks.push(Remark::OtherLaw { of: name(of), law: name(term), nats });
            return Some(with);
        }
        None
    }
}
