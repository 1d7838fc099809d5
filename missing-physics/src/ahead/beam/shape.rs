//! From a promise to the best that a set of effects can do: other valleys, other forms.

use rayon::prelude::*;

use super::{FORM, LOWER, RESCANS, STEPS, Search, TRIED, negative};
use crate::ahead::Ahead;
use crate::ahead::compare::Difference;
use crate::ahead::fit::{self, Fitter};
use crate::ahead::node::Node;
use crate::ahead::screen::{Promise, screen};
use crate::family::Fitted;
use crate::report::{Outcome, Reason};

impl Search<'_> {
    /// A candidate fitted from the best of its starts; nothing where time ran out.
    pub(super) fn begun(&self, promise: &Promise, setting: usize) -> Option<Node> {
        if (self.stop)() {
            return None;
        }
        let fit = |start: Fitted, steps| self.fitter().fit(start, setting, steps);
        if let [start] = &promise.starts[..] {
            return Some(fit(start.clone(), STEPS.0));
        }
        let best = self.tried(promise, setting)?;
        Some(fit(best.model, STEPS.0 - TRIED))
    }

    /// The best of a candidate's starts after a few steps: which leads deepest shows on a part.
    pub(super) fn tried(&self, promise: &Promise, setting: usize) -> Option<Node> {
        let part = self.ahead.part();
        let fitter = Fitter::new(self.family, part.as_deref().unwrap_or(self.ahead));
        let fitter = fitter.stopped_by(self.stop);
        let starts = promise.starts.par_iter();
        let tried: Vec<Node> =
            starts.map(|start| fitter.fit(start.clone(), setting, TRIED)).collect();
        tried.into_iter().min_by(|a, b| a.deviation.total_cmp(&b.deviation))
    }

    /// The node at the bottom of its valley, or of a lower one beside it.
    pub(super) fn rescanned(&self, node: &Node) -> Node {
        if self.ahead.variations(&node.model).is_empty() {
            return self.refit(&node.model, node.setting, STEPS.2);
        }
        let found = self.gone_far(&node.model, node.setting);
        if found.deviation < node.deviation { found } else { node.clone() }
    }

    /// A fit that has far to go: most of the way on a part, where there is one.
    pub(super) fn gone_far(&self, start: &Fitted, setting: usize) -> Node {
        let on = |ahead: &dyn Ahead| {
            let fitter = Fitter::new(self.family, ahead).stopped_by(self.stop);
            self.leapt(ahead, fitter.refit(start.clone(), setting, STEPS.2))
        };
        let Some(part) = self.ahead.part() else { return on(self.ahead) };
        let there = on(&*part);
        self.refit(&there.model, there.setting, STEPS.1)
    }

    /// A node that was fitted to some errors, or the lowest valley that is reached by leaps from it.
    pub(super) fn leapt(&self, ahead: &dyn Ahead, mut node: Node) -> Node {
        let fitter = Fitter::new(self.family, ahead).stopped_by(self.stop);
        for _ in 0..RESCANS {
            let beside = ahead.variations(&node.model);
            if beside.is_empty() || (self.stop)() {
                break;
            }
            let trials: Vec<(Fitted, usize)> =
                beside.into_iter().map(|model| (model, node.setting)).collect();
            let errors = ahead.errors(&trials);
            let nodes = trials.into_iter().zip(errors).map(|((m, s), e)| Node::new(ahead, m, s, e));
            let Some(best) = nodes.min_by(|a, b| a.deviation.total_cmp(&b.deviation)) else {
                break;
            };
            let fitted = fitter.refit(best.model, node.setting, STEPS.1);
            if fitted.deviation > LOWER * node.deviation {
                break;
            }
            node = fitted;
        }
        node
    }

    /// The node, or the same with effects in their flexible forms where that is clearly better.
    pub(super) fn shaped(&self, node: &Node) -> Node {
        let mut best = node.clone();
        let mut start = node.model.clone();
        let mut changed = false;
        for term in node.effects(self.family) {
            if let Some(flexible) = self.ahead.flexible(&start, term) {
                start = flexible;
                changed = true;
            }
        }
        if changed && !(self.stop)() {
            let flexible = self.leapt(self.ahead, self.refit(&start, node.setting, STEPS.1));
            if self.comparison.compare(&best, &flexible).nats > FORM {
                best = flexible;
            }
        }
        best
    }

    /// The same effects in their main forms, one by one, where those are as good and still needed: `costs` has the
    /// models without each.
    pub(super) fn plainest(&mut self, node: Node, costs: &[(usize, Difference, Node)]) -> Node {
        let mut best = node;
        for term in best.effects(self.family) {
            let Some(main) = self.family.form_of(term) else { continue };
            let without = best.model.without(self.family, term);
            let start = screen(
                self.family,
                self.ahead,
                &fit::evaluated(self.ahead, without, best.setting),
                &[main],
                false,
            );
            let Some(start) = start.promises.into_iter().next() else { continue };
            let Some(plain) = self.begun(&start, best.setting) else { continue };
            let plain = self.refit(&plain.model, best.setting, STEPS.2);
            let loss = self.comparison.compare(&plain, &best);
            let without = costs.iter().find(|cost| self.main(cost.0) == main);
            let needed = without.is_none_or(|(.., without)| {
                self.comparison.compare(without, &plain).nats > self.thresholds.better
            });
            let as_good = loss.nats < self.thresholds.better && needed;
            let outcome = if as_good { Outcome::Added } else { Outcome::OtherShape };
            let from = best.clone();
            self.note(
                best.effects(self.family).len(),
                &plain,
                &from,
                negative(loss),
                outcome,
                Some(Reason::PlainForm),
            );
            if as_good {
                best = plain;
            }
        }
        best
    }
}
