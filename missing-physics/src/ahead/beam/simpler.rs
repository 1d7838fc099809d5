//! Whether a simpler effect does what one of several does, beside the others.
//!
//! Of sets that are as good the one with the fewest parameters is told, but the search only keeps the best few of each size.
//! An effect that shows only beside another one stays behind the one that imitates both: a spring that is at rest elsewhere
//! than at zero behind the bend of a pendulum. So the simpler ones are asked in the place of each effect of the last set.

use super::{Climb, STEPS, Search};
use crate::ahead::node::Node;
use crate::ahead::refused::refused;
use crate::ahead::screen::screen;
use crate::family::ModelFamily;
use crate::report::{Outcome, Reason};

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The set with simpler effects in the place of others, where those do as much.
    pub(super) fn simplified(&mut self, climb: &Climb, mut best: Node) -> Node {
        let added = Self::added(&climb.base, &best);
        for term in added.iter().filter(|_| added.len() > 1) {
            if let Some(simpler) = self.in_the_place_of(climb, &best, *term) {
                best = simpler;
            }
        }
        best
    }

    fn in_the_place_of(&mut self, climb: &Climb, best: &Node, term: usize) -> Option<Node> {
        let parameters = |t: usize| self.family.terms()[t].parameters.len();
        let open: Vec<usize> =
            self.candidates.iter().copied().filter(|t| parameters(*t) < parameters(term)).collect();
        if open.is_empty() || (self.stop)() {
            return None;
        }
        let model = best.model.without(self.family, term);
        let without = self.refit(&model, best.setting, STEPS.1);
        let joins = |term: &usize| self.family.joins(&without.model, *term);
        let open: Vec<usize> = open.into_iter().filter(joins).collect();
        let screened = screen(self.family, self.ahead, &without, &open, false);
        let least = self.promising();
        let clear = self.thresholds.clear(self.comparison.compare(&climb.base, best).nats);
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
