//! Whether what stands for no effect predicts as well as the effects that were found.
//!
//! A friction level that is free at every moment explains nothing, but where it does what two effects do together those
//! two are not what the recording shows. One comparison decides, in both directions: the effects stay that are needed
//! beside it, and so does an effect that is one shape of it (a drift) where it predicts as well.

use rayon::prelude::*;

use super::{Climb, Costs, STEPS, Search, negative};
use crate::ahead::compare::Difference;
use crate::ahead::node::Node;
use crate::ahead::scales;
use crate::ahead::screen::screen;
use crate::family::{Fitted, Rival};
use crate::report::{Course, Outcome, Reason, Remains};

/// Share of what is needed that the first order promises at least: from a poor model it sees little of the gain.
pub(super) const PROMISED: f64 = 0.5;

/// What a rival does.
struct Does {
    /// Whether a model with it leaves no more than the sensors make.
    all: bool,
    /// The model without the effects that it makes up for.
    without: Node,
    /// The number of these.
    instead_of: usize,
    /// What it gains over the model with all of them, nats.
    nats: f64,
    /// What is told of it; nothing where other effects that are shapes of it do as much.
    found: Option<Remains>,
}

impl Search<'_> {
    /// The model without effects that something else makes up for, and what that is (nothing where these are other effects);
    /// with all of them where a rival does something beside them. Nothing is worse than a name that is not there: what is told beside all effects comes last.
    pub(super) fn instead(
        &mut self,
        climb: &Climb,
        last: &Node,
    ) -> Option<(Node, Option<Remains>)> {
        let rival = self.rivalled(climb, last);
        // Beside the base a rival says more: what its course is.
        let nothing = Self::added(&climb.base, last).is_empty();
        let takes_back = rival.as_ref().is_some_and(|does| nothing || does.instead_of > 0);
        let outdone = if takes_back { None } else { self.outdone(climb, last) };
        outdone.or_else(|| rival.map(|does| (does.without, does.found)))
    }

    /// The rival that does most: takes effects back, then gains.
    fn rivalled(&mut self, climb: &Climb, last: &Node) -> Option<Does> {
        // Beside a base that leaves nothing a step by a thousandth of its friction is no finding.
        if Self::added(&climb.base, last).is_empty() && self.leaves_nothing(&climb.base) {
            return None;
        }
        let rivals = self.ahead.rivals();
        let free = rivals.into_par_iter().filter_map(|rival| {
            let free = self.free(climb, last, &rival)?;
            Some((rival, free))
        });
        let free: Vec<(Rival, Node)> = free.collect();
        let each = free.into_iter().filter_map(|(rival, free)| {
            if (self.stop)() { None } else { self.rival(climb, last, (&rival, free)) }
        });
        each.max_by(|a, b| {
            // What leaves nothing is what there is, however many nats it takes to say so.
            let order = (a.instead_of > 0).cmp(&(b.instead_of > 0)).then(a.all.cmp(&b.all));
            order.then(a.nats.total_cmp(&b.nats))
        })
    }

    /// The base model with a rival, where that promises something.
    fn free(&self, climb: &Climb, last: &Node, rival: &Rival) -> Option<Node> {
        let base = &climb.base;
        let added = Self::added(base, last);
        let least = PROMISED * self.thresholds.better;
        let promised = |node: &Node| -> Option<Fitted> {
            let promised = screen(self.family, self.ahead, node, &[rival.term], false);
            let first =
                promised.promises.into_iter().next().filter(|promise| promise.gain >= least);
            first?.starts.into_iter().next()
        };
        // What was found may hide it.
        let beside = || {
            let without = |model: Fitted, term: &usize| model.without(self.family, *term);
            let found = Some(last).filter(|_| !added.is_empty())?;
            Some(added.iter().fold(promised(found)?, without))
        };
        let start = promised(base).or_else(beside)?;
        if (self.stop)() {
            return None;
        }
        Some(self.leapt(self.ahead, self.refit(&start, base.setting, STEPS.2)))
    }

    /// What a rival does, with which the base model is `free`.
    fn rival(&mut self, climb: &Climb, last: &Node, (rival, free): (&Rival, Node)) -> Option<Does> {
        let base = &climb.base;
        let added = Self::added(base, last);
        let kin: Vec<usize> = added.iter().copied().filter(|t| self.is_kin(*t, rival)).collect();
        // Beside a base that leaves no more than the sensors make, what is none as it was fitted is nothing that is missing.
        if added.is_empty()
            && self.is_complete(base)
            && let Some((_, refusal)) = self.ahead.vanishes(&free.model, &base.model)
        {
            let gains = self.comparison.compare(base, &free);
            let because = Some(Reason::Refused { refusal });
            self.note(0, &free, base, gains, Outcome::NotIdentifiable, because);
            return None;
        }
        let alone = self.does_as_much(base, last, &free, added.len(), rival);
        // Of more effects, and beside some that leave something, some may be needed beside it; beside what leaves nothing
        // no other than shapes of it are asked to give way.
        let few = added.len() <= 2 && self.is_complete(last);
        let in_part =
            added.len() > kin.len() && (!kin.is_empty() || !few && !self.is_complete(&free));
        if !alone && !in_part {
            return None;
        }
        // Beside what does as much and leaves nothing nothing is needed.
        let (mut kept, beside) = if added.is_empty() || (alone && self.is_complete(&free)) {
            (Vec::new(), free)
        } else {
            let (kept, beside) = self.needed_beside(base, last, &free, rival);
            if !self.does_as_much(base, last, &beside, added.len() - kept.len(), rival) {
                return None;
            }
            (kept, beside)
        };
        if !kin.is_empty() {
            let shapes = [kept.as_slice(), &kin].concat();
            let alone = self.only(base, last, &shapes);
            let clear = self.thresholds.clear(self.comparison.compare(base, &beside).nats);
            // One that is more flexible may gain by what it is free to do.
            let freer = self.parameters(&beside) > self.parameters(&alone);
            let as_good = |set: &Node| self.comparison.compare(set, &beside).nats <= clear;
            // A course need not begin at zero, and a shape of it lies beside what every system has.
            let usual = || self.with_usual(alone.model.clone(), alone.setting);
            let stands = as_good(&alone) || freer && self.explains(base, &alone);
            if stands || usual().is_some_and(|usual| as_good(&usual)) {
                kept = shapes;
            } else if let Some(other) = self.other_shapes(climb, (&shapes, &kept), rival, |set| {
                as_good(set) && self.comparison.compare(last, set).nats > 0.0
            }) {
                let (all, instead_of) = (self.is_complete(other), shapes.len() - kept.len());
                let nats = self.in_full(self.comparison.compare(last, other).nats);
                return Some(Does { all, without: other.clone(), instead_of, nats, found: None });
            }
        }
        let gone: Vec<usize> = added.iter().copied().filter(|t| !kept.contains(t)).collect();
        // What leaves nothing lacks nothing, and a shape of the rival that does as much stands for it.
        if gone.is_empty() && !added.is_empty() && (!kin.is_empty() || self.is_complete(last)) {
            return None;
        }
        let without = match (kept.is_empty(), gone.is_empty()) {
            (true, _) => base.clone(),
            (false, true) => last.clone(),
            (false, false) => self.only(base, last, &kept),
        };
        let nats = self.in_full(self.comparison.compare(last, &beside).nats);
        let course = self.course(&beside, rival);
        let instead_of = self.named(&gone);
        let rival = rival.title.to_owned();
        let found = Some(Remains::Rival { rival, instead_of, nats, course });
        Some(Does { all: self.is_complete(&beside), without, instead_of: gone.len(), nats, found })
    }

    /// The set that is `as_good` as a rival with as many `shapes` of it in other effects, beside those that are `kept`: of
    /// sets that are alike the search took that with the fewest parameters, and a rival may be better than that one alone.
    fn other_shapes<'c>(
        &self,
        climb: &'c Climb,
        (shapes, kept): (&[usize], &[usize]),
        rival: &Rival,
        as_good: impl Fn(&Node) -> bool,
    ) -> Option<&'c Node> {
        let is_it = |set: &&Node| {
            let added = Self::added(&climb.base, set);
            let stays = |term: &usize| added.iter().any(|t| self.main(*t) == self.main(*term));
            let others = added.iter().filter(|t| !self.is_kin(**t, rival)).count();
            kept.iter().all(stays) && others == kept.len() && as_good(set)
        };
        climb.nodes.get(shapes.len())?.iter().find(is_it)
    }

    /// Whether a model with the rival predicts as well as the last one, or better where it makes up for one effect or
    /// none.
    pub(super) fn does_as_much(
        &mut self,
        base: &Node,
        last: &Node,
        with: &Node,
        instead_of: usize,
        rival: &Rival,
    ) -> bool {
        let by = self.comparison.compare(last, with);
        let clear = self.thresholds.clear(self.comparison.compare(base, with).nats);
        let needed = if instead_of > 1 { -clear } else { clear };
        let leaves_more = self.is_complete(last) && !self.is_complete(with);
        let does = by.nats > needed && !leaves_more;
        let outcome = if does { Outcome::Rival } else { Outcome::Worse };
        self.note(instead_of, with, last, by, outcome, Some(because(rival)));
        outcome == Outcome::Rival
    }

    /// The effects that are needed beside a rival, as much as any that is added, and the model with them and with it.
    pub(super) fn needed_beside(
        &mut self,
        base: &Node,
        last: &Node,
        free: &Node,
        rival: &Rival,
    ) -> (Vec<usize>, Node) {
        let added = Self::added(base, last);
        let needed = self.thresholds.clear(self.comparison.compare(base, free).nats);
        let mut kept: Vec<usize> =
            added.iter().copied().filter(|t| !self.is_kin(*t, rival)).collect();
        let values = self.values(free, rival);
        let with = |search: &Self, kept: &[usize]| {
            let model = search.keeping(last, &added, kept).with(rival.term, &values);
            search.refit(&model, last.setting, STEPS.1)
        };
        let mut beside = if kept.is_empty() { free.clone() } else { with(self, &kept) };
        // One by one several may all be needed where the fit of all stays behind the rival alone.
        if kept.len() > 1 {
            let all = self.comparison.compare(free, &beside);
            if all.nats < needed {
                self.note(0, free, &beside, negative(all), Outcome::Dropped, Some(because(rival)));
                return (Vec::new(), free.clone());
            }
        }
        loop {
            let each = kept.par_iter().map(|term| {
                let others: Vec<usize> = kept.iter().copied().filter(|t| t != term).collect();
                let without = if others.is_empty() { free.clone() } else { with(self, &others) };
                (*term, self.comparison.compare(&without, &beside), without)
            });
            let costs: Costs = each.collect();
            let least = costs.into_iter().min_by(|a, b| a.1.nats.total_cmp(&b.1.nats));
            let idle = |least: &(usize, Difference, Node)| least.1.nats < needed;
            let Some((term, cost, without)) = least.filter(idle) else { return (kept, beside) };
            let from = beside.clone();
            self.note(
                kept.len(),
                &without,
                &from,
                negative(cost),
                Outcome::Dropped,
                Some(because(rival)),
            );
            kept.retain(|t| *t != term);
            beside = without;
        }
    }

    /// Whether an effect is a shape of a rival.
    fn is_kin(&self, term: usize, rival: &Rival) -> bool {
        rival.kin.contains(&self.main(term))
    }

    /// The model with only these of its added effects, refitted.
    pub(super) fn only(&self, base: &Node, last: &Node, kept: &[usize]) -> Node {
        let model = self.keeping(last, &Self::added(base, last), kept);
        self.refit(&model, last.setting, STEPS.1)
    }

    /// A model without those of its added effects that are not kept.
    fn keeping(&self, last: &Node, added: &[usize], kept: &[usize]) -> Fitted {
        let gone = added.iter().filter(|term| !kept.contains(term));
        gone.fold(last.model.clone(), |model, term| model.without(self.family, *term))
    }

    /// What the rival was found to be; nothing where what every model has ended at the limit of its search, which what is
    /// found beside it is measured in.
    pub(super) fn course(&self, with: &Node, rival: &Rival) -> Option<Course> {
        let moved = scales::of(self.family, &with.model);
        let unit = moved.iter().all(|moved| !moved.is_known() || !moved.is_at_far_limit());
        unit.then(|| self.family.course(rival.term, &self.values(with, rival)))
    }

    fn values(&self, free: &Node, rival: &Rival) -> Vec<f64> {
        let position = free.model.terms.iter().position(|term| *term == rival.term);
        position
            .map_or_else(Vec::new, |k| free.model.values[free.model.range(self.family, k)].to_vec())
    }
}

fn because(rival: &Rival) -> Reason {
    Reason::Rival { rival: rival.title.to_owned() }
}
