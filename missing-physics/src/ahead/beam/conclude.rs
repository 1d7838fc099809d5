//! The size of the set, what is not needed, and the answer.

use rayon::prelude::*;

use super::{Climb, Costs, STEPS, Search, TRIED, negative};
use crate::ahead::compare::Difference;
use crate::ahead::fit::Fitter;
use crate::ahead::foretold::{is_colour, is_foretold};
use crate::ahead::found::Found;
use crate::ahead::node::Node;
use crate::ahead::refused::not_told;
use crate::ahead::screen::Screened;
use crate::report::{Outcome, Reason, Remains};

impl Search<'_> {
    /// The best set, of the smallest size that is needed, from one of `known` effects on: each effect more must be worth what an
    /// effect must gain. Two that hide each other gain much together and little alone.
    pub(super) fn size(&mut self, climb: &Climb, mut best: Node, mut known: usize) -> Node {
        let base = &climb.base;
        for (size, sets) in climb.nodes.iter().enumerate().skip(known + 1) {
            let top = &sets[0];
            let gain = self.comparison.compare(&best, top).nats;
            let near = self.thresholds.clear(gain);
            let as_good: Vec<&Node> = sets
                .iter()
                .take(6)
                .filter(|set| self.comparison.compare(set, top).nats <= near)
                .collect();
            let simplest = as_good
                .iter()
                .copied()
                .filter(|set| !as_good.iter().any(|other| self.is_bettered(set, other)))
                .min_by(|a, b| {
                    let fewer = self.parameters(a).cmp(&self.parameters(b));
                    fewer.then(a.deviation.total_cmp(&b.deviation))
                })
                .unwrap_or(top);
            let polished = self.refit(&simplest.model, simplest.setting, STEPS.2);
            let set = if self.comparison.compare(simplest, &polished).nats > 0.0 {
                polished
            } else {
                simplest.clone()
            };
            let gain = self.comparison.compare(&best, &set);
            let all = self.comparison.compare(base, &set).nats;
            let each = self.thresholds.clear(if size == 1 { 0.0 } else { all });
            let taken = gain.nats > (size - known) as f64 * each;
            let outcome = if taken { Outcome::Added } else { Outcome::TooLittle };
            let from = best.clone();
            self.note(size, &set, &from, gain, outcome, Some(Reason::BestOfSize));
            if taken {
                (best, known) = (set, size);
            }
        }
        best
    }

    /// Whether another set predicts as well with fewer parameters, as far as chance lets tell: a flexible form counts as its
    /// effect does, but there is no reason to tell it then.
    fn is_bettered(&self, set: &Node, other: &Node) -> bool {
        let fewer = other.model.values.len() < set.model.values.len();
        fewer && self.comparison.compare(other, set).recurs_by_chance() > self.thresholds.recurs()
    }

    /// Takes out what is not needed, and says what each of the rest is worth.
    pub(super) fn prune(&mut self, climb: &Climb, mut best: Node) -> (Node, Costs) {
        loop {
            let each = Self::added(&climb.base, &best).into_par_iter().map(|term| {
                let without = self.without(climb, &best, term);
                (term, self.comparison.compare(&without, &best), without)
            });
            let mut costs: Costs = each.collect();
            costs.sort_by(|a, b| b.1.nats.total_cmp(&a.1.nats));
            let whys = costs
                .iter()
                .map(|(term, cost, without)| self.why_goes(&best, *term, *cost, without));
            let mut idle: Vec<_> =
                whys.enumerate().filter_map(|(k, why)| Some((k, why?))).collect();
            if idle.iter().all(|(_, why)| *why == Reason::AsGoodWithout) {
                // Each set without one is as good: the one of the fewest parameters stands.
                idle.sort_by_key(|(k, _)| std::cmp::Reverse(self.parameters(&costs[*k].2)));
            }
            // What a single one gains has been asked, but not when it does so.
            let since =
                [Reason::WithinSensors, Reason::NotRecurring, Reason::AtRest, Reason::Colour];
            let asked = |(_, why): &(usize, Reason)| costs.len() > 1 || since.contains(why);
            let Some((goes, because)) = idle.pop().filter(asked) else {
                return (best, costs);
            };
            let (term, cost, without) = costs.swap_remove(goes);
            if because != Reason::AsGoodWithout {
                self.none.insert(self.main(term));
            }
            let from = best.clone();
            self.note(
                costs.len(),
                &without,
                &from,
                negative(cost),
                Outcome::Dropped,
                Some(because),
            );
            best = without;
        }
    }

    /// What is left of a set that an effect has gone from: nothing where a single one is, and gains too little. No size was
    /// asked of that.
    pub(super) fn what_is_left(&mut self, climb: &Climb, left: &Node) -> Node {
        if Self::added(&climb.base, left).len() != 1 {
            return left.clone();
        }
        let gain = self.comparison.compare(&climb.base, left);
        if gain.nats >= self.thresholds.better {
            return left.clone();
        }
        let because = Some(Reason::AsGoodWithout);
        self.note(0, &climb.base, left, negative(gain), Outcome::Dropped, because);
        climb.base.clone()
    }

    /// What is left of a set, or the one of as many effects that the search came by and that does clearly more: what was beside
    /// an effect need not be what does most without it. Whether that one can be told is asked next.
    pub(super) fn best_of_its_size(&self, climb: &Climb, left: Node) -> Node {
        let size = Self::added(&climb.base, &left).len();
        let sets = climb.nodes.get(size).into_iter().flatten();
        let gains = sets.map(|set| (self.comparison.compare(&left, set).nats, set));
        let clear = |(gain, set): &(f64, &Node)| {
            *gain > self.thresholds.clear(self.comparison.compare(&climb.base, set).nats)
        };
        let best = gains.filter(clear).max_by(|a, b| a.0.total_cmp(&b.0));
        best.map_or(left, |(_, set)| set.clone())
    }

    /// Why a term of a set is not needed, if so: what the set without it loses, and that one.
    pub(super) fn why_goes(
        &self,
        set: &Node,
        term: usize,
        cost: Difference,
        without: &Node,
    ) -> Option<Reason> {
        // Errors of an incomplete model are its own, and what lowers them counts only as far as it does so again and again
        // (Q. H. Vuong, 1989, and by ranks).
        let misfit = self.ahead.has_shares() && self.budget(set) > self.thresholds.complete;
        let too_little =
            |there: &[bool]| self.comparison.gained(without, set, there) < self.thresholds.better;
        if cost.nats < self.thresholds.better {
            Some(Reason::AsGoodWithout)
        } else if cost.nats * self.of_the_sensors(without) < self.thresholds.better {
            Some(Reason::WithinSensors)
        } else if !set.foretells_more(without) {
            Some(Reason::ErrorNoLower)
        } else if misfit && cost.recurs_by_chance() > self.thresholds.recurs() {
            Some(Reason::NotRecurring)
        } else {
            let (ahead, better) = (self.ahead, self.thresholds.better);
            match ahead.in_motion(term) {
                Some(there) if too_little(there) => Some(Reason::AtRest),
                Some(_) => is_colour(ahead, without, set, better).then_some(Reason::Colour),
                None => {
                    is_foretold(ahead, without, set, cost.nats, better).then_some(Reason::Foretold)
                }
            }
        }
    }

    /// What a nat that is gained over a model is in units of what the sensors make, where it errs clearly less than that: a
    /// smaller error is no better known than they are, and they are known to within what a model may err.
    fn of_the_sensors(&self, model: &Node) -> f64 {
        let square = self.thresholds.complete * self.budget(model).powi(2);
        if self.ahead.has_shares() { square.min(1.0) } else { 1.0 }
    }

    /// The model without a term, refitted; what stood in the place of a term of the base leaves it to that one.
    pub(super) fn without(&self, climb: &Climb, node: &Node, term: usize) -> Node {
        // A rung below may have it in another form.
        let is = |t: &usize| self.main(*t) == self.main(term);
        let form = node.model.terms.iter().copied().find(is);
        let left = Self::added(&climb.base, node).len().saturating_sub(1);
        if left == 0 {
            return climb.base.clone();
        }
        let mut model = node.model.without(self.family, form.unwrap_or(term));
        let base = &climb.base.model;
        if let Some(place) = base.terms.iter().position(is) {
            model = model.with(base.terms[place], &base.values[base.range(self.family, place)]);
        }
        // An effect beside a model that is not fitted seems to be needed: for that there is always time.
        let steps = if (self.stop)() { TRIED } else { STEPS.1 };
        let mut best = Fitter::new(self.family, self.ahead).refit(model, node.setting, steps);
        let key = self.key(&best);
        // The effects alone do not tell: another form of what the base has is added, too.
        let is_same =
            |other: &&Node| Self::added(&climb.base, other).len() == left && self.key(other) == key;
        for other in climb.nodes.iter().flatten().filter(is_same) {
            if self.comparison.compare(&best, other).nats > 0.0 {
                best = other.clone();
            }
        }
        best
    }

    pub(super) fn conclude(
        mut self,
        climb: Climb,
        last: &Node,
        (costs, least): (Costs, f64),
        mut beside: Screened,
        rival: Option<Remains>,
    ) -> Found {
        let base = climb.base.clone();
        let by_chance = |cost: &(_, Difference, _)| self.p_value(&beside, cost.1);
        let mut p_values: Vec<f64> = costs.iter().map(by_chance).collect();
        if let Some(last) = p_values.last_mut() {
            *last = last.max(least);
        }
        // What every system has comes after what is needed as much.
        let clear = self.thresholds.clear(self.comparison.compare(&base, last).nats);
        let needed = |(term, cost, _): &(usize, Difference, Node)| {
            cost.nats - if self.family.is_usual(*term) { clear } else { 0.0 }
        };
        // Forms may have changed since the costs were taken, one into that of the base.
        let new = last.added_to(&base);
        let now = |term: usize| new.iter().copied().find(|t| self.main(*t) == self.main(term));
        let mut told: Vec<_> = costs.into_iter().zip(p_values).collect();
        told.retain(|((term, ..), _)| now(*term).is_some());
        told.sort_by(|a, b| needed(&b.0).total_cmp(&needed(&a.0)));
        let (costs, p_values): (Costs, Vec<f64>) = told.into_iter().unzip();
        let added: Vec<usize> = costs.iter().filter_map(|(term, ..)| now(*term)).collect();
        let mut rungs = vec![last.clone()];
        for term in added.iter().skip(1).rev() {
            let Some(above) = rungs.last() else { break };
            let below = self.without(&climb, above, *term);
            rungs.push(below);
        }
        if added.is_empty() {
            rungs.clear();
        }
        rungs.reverse();
        let mut gains = Vec::new();
        for (k, rung) in rungs.iter().enumerate() {
            let before = if k == 0 { &base } else { &rungs[k - 1] };
            gains.push(self.comparison.compare(before, rung));
        }
        let alike = self.in_full(self.thresholds.better.max(self.unnamed(&climb, last)));
        let sets = self.behind(&climb, last, alike);
        let refused = self.refused_most(&climb, last);
        let stopped = (self.stop)();
        for promise in &mut beside.promises {
            promise.leverage = promise.leverage.map(|leverage| self.in_full(leverage));
        }
        let mut decisions = std::mem::take(&mut self.decisions);
        let names = self.names(last);
        for decision in &mut decisions {
            if decision.outcome == Outcome::AsGood {
                let stands = decision.candidate == names;
                decision.outcome = if stands { Outcome::Added } else { Outcome::Worse };
            }
        }
        let mut found = Found {
            base,
            rungs,
            added,
            gains,
            costs: costs.into_iter().map(|(_, cost, _)| cost).collect(),
            sets,
            alike,
            ranking: climb.ranking,
            p_values,
            chance: beside.chance,
            last_screening: beside.promises,
            rival,
            complete: false,
            input_noise: None,
            places: Vec::new(),
            remarks: std::mem::take(&mut self.remarks),
            refused: refused.map(|model| vec![model]).unwrap_or_default(),
            decisions,
            untried: self.untried.into_iter().collect(),
            stopped,
        };
        found.place(self.family, self.ahead, &self.thresholds);
        found
    }

    /// The sets of every size, and how far each lies behind the best of them; the last model among those of its own, and
    /// what differs from it by effects that every system has besides.
    fn behind(&self, climb: &Climb, last: &Node, alike: f64) -> Vec<Vec<(Vec<usize>, f64)>> {
        let base = &climb.base;
        let known = self.key(last);
        let special = |set: &Node| {
            let added = Self::added(base, set).into_iter();
            added.filter(|term| !self.family.is_usual(*term)).count()
        };
        let last_size = Self::added(base, last).len();
        let mut all = Vec::new();
        for size in 0..climb.nodes.len().max(last_size + 1) {
            let is_last = size == last_size;
            // A spring that is at rest elsewhere than at zero has an offset more than a pendulum, and counts as one effect as that
            // does: of other sizes those count that predict no worse.
            let other_sizes = climb.nodes.iter().enumerate().filter(|(other, _)| *other != size);
            let no_worse = other_sizes.flat_map(|(_, sets)| sets).filter(|set| {
                special(set) == special(last) && self.comparison.compare(last, set).nats >= 0.0
            });
            let twins = self.twins.iter().filter(|set| special(set) == special(last));
            let beside = is_last.then(|| twins.chain(no_worse)).into_iter().flatten();
            let sets = climb.nodes.get(size).into_iter().flatten().chain(beside);
            let others = sets.filter(|set| !is_last || self.key(set) != known);
            let sets: Vec<&Node> = is_last.then_some(last).into_iter().chain(others).collect();
            let Some(first) = sets.iter().min_by(|a, b| a.deviation.total_cmp(&b.deviation)) else {
                all.push(Vec::new());
                continue;
            };
            let lag = |set: &Node| self.in_full(self.comparison.compare(set, first).nats);
            let mut lags: Vec<_> = sets.iter().map(|set| (*set, lag(set))).collect();
            if is_last {
                // What would not be told if it were the best is no alternative to what is told.
                let found = lags[0].1;
                let told = |set: &Node| {
                    let refused = not_told(self.family, self.ahead, base, set);
                    // A usual effect that came along with an alternative need not be there.
                    refused.is_none_or(|(term, _)| {
                        self.family.is_usual(term) && !Self::added(base, last).contains(&term)
                    })
                };
                lags.retain(|(set, lag)| {
                    std::ptr::eq(*set, last) || lag - found >= alike || told(set)
                });
            }
            all.push(lags.iter().map(|(set, lag)| (Self::added(base, set), *lag)).collect());
        }
        all
    }

    /// The most that anything gains beside the last model without being named.
    fn unnamed(&self, climb: &Climb, last: &Node) -> f64 {
        let known = self.key(last);
        let sets = climb.nodes.iter().flatten().chain(climb.refused.iter().map(|(set, _)| set));
        let beside = sets.filter(|set| {
            let key = self.key(set);
            key.len() == known.len() + 1 && key.is_superset(&known)
        });
        beside.map(|set| self.comparison.compare(last, set).nats).fold(0.0, f64::max)
    }
}
