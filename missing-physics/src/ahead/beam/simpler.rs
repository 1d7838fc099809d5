//! Whether a simpler effect does what one of several does, beside the others.
//!
//! Of sets that are as good the one with the fewest parameters is told, but the search only keeps the best few of each size.
//! An effect that shows only beside another one stays behind the one that imitates both: a spring that is at rest elsewhere
//! than at zero behind the bend of a pendulum. So the simpler ones are asked in the place of each effect of the last set.

use super::grow::CATCHES_UP;
use super::{Climb, Costs, STEPS, Search};
use crate::ahead::node::Node;
use crate::ahead::refused::refused;
use crate::ahead::screen::screen;
use crate::family::ModelFamily;
use crate::report::{Outcome, Reason};

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The set with simpler effects in the place of others, where those do as much; nothing where none does. `costs` has the
    /// models without each.
    pub(super) fn simplified(&mut self, climb: &Climb, set: &Node, costs: &Costs) -> Option<Node> {
        let mut best = None;
        for (term, cost, without) in costs.iter().filter(|_| costs.len() > 1) {
            // Beside what took the place of another one the model without it is another.
            let again = best.as_ref().map(|best: &Node| {
                let form = best.model.terms.iter().find(|t| self.main(**t) == self.main(*term));
                let model = best.model.without(self.family, *form.unwrap_or(term));
                self.refit(&model, best.setting, STEPS.1)
            });
            let without = again.as_ref().unwrap_or(without);
            let from = best.as_ref().unwrap_or(set);
            if let Some(simpler) = self.in_the_place_of(climb, from, (*term, cost.nats), without) {
                best = Some(simpler);
            }
        }
        best
    }

    fn in_the_place_of(
        &mut self,
        climb: &Climb,
        best: &Node,
        (term, cost): (usize, f64),
        without: &Node,
    ) -> Option<Node> {
        if (self.stop)() {
            return None;
        }
        let parameters = |t: usize| self.family.terms()[t].parameters.len();
        let simpler = |t: &usize| parameters(*t) < parameters(term);
        let open = self.candidates.iter().copied().filter(simpler);
        let open: Vec<usize> = open.filter(|t| self.family.joins(&without.model, *t)).collect();
        if open.is_empty() {
            return None;
        }
        let screened = screen(self.family, self.ahead, without, &open, false);
        let clear = self.thresholds.clear(self.comparison.compare(&climb.base, best).nats);
        let least = self.promising().max(CATCHES_UP * (cost - clear));
        let size = Self::added(&climb.base, best).len();
        for start in self.chosen(&screened.promises, least, self.thresholds.beam) {
            let other = self.begun(start, without.setting)?;
            let other = self.fitter().settled(other, STEPS.1);
            let by = self.comparison.compare(best, &other);
            let is_one = refused(self.family, self.ahead, &climb.base, &other).is_none();
            let leaves_more = self.is_complete(best) && !self.is_complete(&other);
            let as_good = is_one && !leaves_more && by.nats > -clear;
            let outcome = if as_good { Outcome::Added } else { Outcome::Worse };
            self.note(size, &other, best, by, outcome, Some(Reason::Simpler));
            if as_good {
                return Some(other);
            }
        }
        None
    }
}
