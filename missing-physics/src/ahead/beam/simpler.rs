//! Whether simpler effects do what one does, beside the others.
//!
//! Of sets that are as good the one with the fewest parameters is told, but the search only keeps the best few of each size.
//! An effect that shows only beside another one stays behind the one that imitates both: a spring that is at rest elsewhere
//! than at zero behind the bend of a pendulum. So the simpler ones are asked in the place of each effect of the last set, and
//! where none does, one beside what every system has: with no more parameters in all, where they predict better.

use rayon::prelude::*;

use super::grow::CATCHES_UP;
use super::{Climb, Costs, STEPS, Search};
use crate::ahead::astray::elsewhere;
use crate::ahead::node::Node;
use crate::ahead::refused::refused;
use crate::ahead::screen::{Promise, screen};
use crate::report::{Outcome, Reason};

impl Search<'_> {
    /// The set with simpler effects in the place of others, where those do as much; nothing where none does. `costs` has the
    /// models without each.
    pub(super) fn simplified(
        &mut self,
        climb: &mut Climb,
        set: &Node,
        costs: &Costs,
    ) -> Option<Node> {
        let mut best = None;
        for (term, cost, without) in costs {
            // Beside what took the place of another one the model without it is another.
            let again = best.as_ref().map(|best: &Node| {
                let form = best.model.terms.iter().find(|t| self.main(**t) == self.main(*term));
                let model = best.model.without(self.family, *form.unwrap_or(term));
                self.refit(&model, best.setting, STEPS.1)
            });
            let without = again.as_ref().unwrap_or(without);
            let from = best.as_ref().unwrap_or(set);
            let cost = cost.nats;
            let count = self.family.terms()[*term].parameters.len();
            // Of single effects the search has asked all.
            let mut simpler = None;
            if costs.len() > 1 {
                simpler = self.in_the_place_of(climb, from, cost, without, count);
            }
            let simpler = simpler.or_else(|| {
                let usual = self.with_usual(without.model.clone(), without.setting)?;
                let taken = self.parameters(&usual) - self.parameters(without);
                self.in_the_place_of(climb, from, cost, &usual, (count + 1).checked_sub(taken)?)
            });
            best = simpler.or(best);
        }
        best
    }

    /// The set `best` with an effect of fewer than `below` parameters beside a model without one of its effects, which it
    /// loses `cost` nats without. What is refused there still shows how much as few effects can foretell.
    pub(super) fn in_the_place_of(
        &mut self,
        climb: &mut Climb,
        best: &Node,
        cost: f64,
        without: &Node,
        below: usize,
    ) -> Option<Node> {
        if (self.stop)() {
            return None;
        }
        let simple = |t: &usize| self.family.terms()[*t].parameters.len() < below;
        let open = self.candidates.iter().copied().filter(simple);
        let open: Vec<usize> = open.filter(|t| self.family.joins(&without.model, *t)).collect();
        if open.is_empty() {
            return None;
        }
        let near = self.near(best, without);
        let without = near.as_ref().unwrap_or(without);
        let screened = screen(self.family, self.ahead, without, &open, false);
        let clear = self.thresholds.clear(self.comparison.compare(&climb.base, best).nats);
        let starts = self.chosen(&screened.promises, self.promising(), self.thresholds.beam);
        // Beside a model that lacks much the first order errs: the first one is fitted in any case.
        let catches_up = |promise: &Promise| promise.gain > CATCHES_UP * (cost - clear);
        let starts: Vec<&Promise> = starts
            .into_iter()
            .enumerate()
            .filter(|(place, promise)| *place == 0 || catches_up(promise))
            .map(|(_, promise)| promise)
            .collect();
        let others = starts.into_par_iter().map(|start| {
            let other = self.begun(start, without.setting)?;
            let other = self.fitter().settled(other, STEPS.1);
            let lost = -self.comparison.compare(best, &other).nats;
            // What does most of it may do all of it at its best.
            let polish = lost > 0.0 && lost < CATCHES_UP * cost;
            Some(if polish { self.refit(&other.model, other.setting, STEPS.2) } else { other })
        });
        for other in others.collect::<Option<Vec<Node>>>()? {
            let by = self.comparison.compare(best, &other);
            let refusal = refused(self.family, self.ahead, &climb.base, &other);
            let is_one = refusal.is_none();
            let leaves_more = self.is_complete(best) && !self.is_complete(&other);
            let fewer = self.parameters(&other) < self.parameters(best);
            let needed = if fewer { -clear } else { 0.0 };
            let as_good = is_one && !leaves_more && by.nats > needed;
            let outcome = if as_good { Outcome::Added } else { Outcome::Worse };
            let size = Self::added(&climb.base, &other).len();
            self.note(size, &other, best, by, outcome, Some(Reason::Simpler));
            if as_good {
                if self.is_complete(best) == self.is_complete(&other) {
                    self.twins.push(best.clone());
                }
                return Some(other);
            }
            if let Some((_, refusal)) = refusal {
                climb.refused.push((other, refusal));
            } else if !leaves_more {
                self.twins.push(other);
            }
        }
        None
    }

    /// A model without one of the effects of the `best` set with what every model has as it is there, where its fit went astray.
    pub(super) fn near(&self, best: &Node, without: &Node) -> Option<Node> {
        let mut near = without.model.clone();
        for (place, term) in without.model.terms.iter().enumerate() {
            if let Some(there) = best.model.terms.iter().position(|t| t == term) {
                let values = &best.model.values[best.model.range(self.family, there)];
                near.values[without.model.range(self.family, place)].copy_from_slice(values);
            }
        }
        let astray = !elsewhere(self.family, &near, &without.model).is_empty();
        astray.then(|| self.base_holding(near))
    }
}
