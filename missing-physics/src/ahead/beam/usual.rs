//! What every system of a kind has, in the place of what varies it.
//!
//! An effect that varies another one has parameters to stand for it: beside a base without a friction level a drift of
//! that level is the level, too, and gains more. So the other one is asked in its place, and stays where it does as much
//! (the principle of marginality: J. A. Nelder, 1977).

use super::{Climb, STEPS, Search, negative};
use crate::ahead::fit;
use crate::ahead::node::Node;
use crate::ahead::screen::screen;
use crate::family::ModelFamily;
use crate::report::{Outcome, Reason};

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// The model with the usual effects that the base lacks in the place of each other one, where those do as much.
    pub(super) fn usual_instead(&mut self, climb: &Climb, mut best: Node) -> Node {
        for term in Self::added(&climb.base, &best) {
            if self.family.is_usual(term) {
                continue;
            }
            let Some(usual) = self.with_usual(&best, term) else { continue };
            let loss = self.comparison.compare(&usual, &best);
            let as_good = loss.nats < self.thresholds.better;
            let outcome = if as_good { Outcome::Added } else { Outcome::Worse };
            let size = Self::added(&climb.base, &usual).len();
            let from = best.clone();
            self.note(size, &usual, &from, negative(loss), outcome, Some(Reason::Usual));
            if as_good {
                best = usual;
            }
        }
        best
    }

    /// The model without a term and with every usual effect that it lacks; nothing where it lacks none.
    fn with_usual(&self, node: &Node, term: usize) -> Option<Node> {
        let without = node.model.without(self.family, term);
        let mut found = fit::evaluated(self.ahead, without, node.setting);
        let mut any = false;
        loop {
            let usual = self.candidates.iter().copied().filter(|&t| self.family.is_usual(t));
            let open: Vec<usize> = usual.filter(|&t| self.family.joins(&found.model, t)).collect();
            let screened = screen(self.family, self.ahead, &found, &open, false);
            let start = screened.promises.first();
            let Some(more) = start.and_then(|start| self.begun(start, found.setting)) else {
                break;
            };
            found = more;
            any = true;
        }
        any.then(|| self.refit(&found.model, found.setting, STEPS.2))
    }
}
