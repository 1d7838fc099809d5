//! What every system of a kind has, in the place of what varies it.
//!
//! An effect that varies another one has parameters to stand for it: beside a base without a friction level a drift of
//! that level is the level, too, and gains more. So the other one is asked in its place, and stays where it does as much
//! (the principle of marginality: J. A. Nelder, 1977).
//!
//! And what every system has may hide another effect, or show only beside it: a spring that is at rest elsewhere than at
//! zero is a spring and a constant force, and neither alone foretells anything. So before it is said that no effect
//! explains what is missing, the search begins once more beside the usual effects.

use super::{Climb, STEPS, Search, negative};
use crate::ahead::fit;
use crate::ahead::node::Node;
use crate::ahead::screen::screen;
use crate::family::Fitted;
use crate::report::{Outcome, Reason};

impl Search<'_> {
    /// The model with the usual effects that the base lacks in the place of each other one, where those do as much.
    pub(super) fn usual_instead(&mut self, climb: &Climb, mut best: Node) -> Node {
        for term in Self::added(&climb.base, &best) {
            if self.family.is_usual(term) {
                continue;
            }
            let without = best.model.without(self.family, term);
            let Some(usual) = self.with_usual(without, best.setting) else { continue };
            // What stood in the place of a level may have made up for a flexible form beside it.
            let usual = self.plainest(usual, &[]);
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

    /// The best set of effects from the base with every usual one, where that is better; the climb is the one that led there.
    pub(super) fn beside_usual(&mut self, climb: &mut Climb, best: Node) -> Node {
        let base = &climb.base;
        let Some(usual) = self.with_usual(base.model.clone(), base.setting) else { return best };
        let size = Self::added(base, &usual).len();
        if climb.nodes.iter().flatten().any(|set| self.key(set) == self.key(&usual)) {
            return best;
        }
        let mut again = Climb {
            base: base.clone(),
            nodes: climb.nodes.iter().take(size).cloned().collect(),
            ranking: climb.ranking.iter().take(size).cloned().collect(),
            screened: climb.screened.clone(),
            refused: climb.refused.clone(),
            beam: vec![usual.clone()],
            elsewhere: climb.elsewhere.clone(),
            led: None,
            ended: false,
        };
        again.nodes.resize(size, Vec::new());
        again.nodes.push(vec![usual.clone()]);
        while !again.ended && again.nodes.len() <= self.thresholds.most {
            self.grow(&mut again);
        }
        let found = self.size(&again, usual, size);
        let (found, _) = self.prune(&again, found);
        let by = self.comparison.compare(&best, &found);
        if by.nats <= self.thresholds.clear(self.comparison.compare(&climb.base, &found).nats) {
            // What was refused beside them still shows how much can be foretold.
            climb.refused = again.refused;
            return best;
        }
        *climb = again;
        found
    }

    /// A model with every usual effect that it lacks; nothing where it lacks none.
    pub(super) fn with_usual(&self, model: Fitted, setting: usize) -> Option<Node> {
        let mut found = fit::evaluated(self.ahead, model, setting);
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
