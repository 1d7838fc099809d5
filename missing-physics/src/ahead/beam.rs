//! The search over sets of effects: the best few sets of each size side by side.
//!
//! From each set the candidates are screened to first order, the most promising are fitted, and each is given
//! another shape of its own before a further effect may be named. Of each size the set stands that predicts best,
//! and of those as good the one with the fewest parameters. At the end everything that is not needed goes.

mod by_hand;
mod conclude;
mod grow;
mod identified;
mod led;
mod other_law;
mod outdone;
mod race;
mod rivals;
mod shape;
mod simpler;
mod unseen;
mod usual;

use std::collections::BTreeSet;

pub use by_hand::ByHand;

use super::Ahead;
use super::compare::{Comparison, Difference};
use super::fit::{self, Fitter};
use super::found::{Found, MOST_WITHIN, Ranked};
use super::node::Node;
use super::refused::not_told;
use super::screen::{Screened, screen};
use crate::family::{Fitted, ModelFamily};
use crate::report::{Decision, Outcome, Reason, Refusal, Remains, Remark};
use crate::task::{Event, Thresholds};

/// Steps of a first fit, of a refit elsewhere, and of the last one.
const STEPS: (usize, usize, usize) = (6, 6, 12);
/// Steps of a first fit after which the best of several starts is known.
const TRIED: usize = 3;
/// Steps of the base model at each process noise on the way down.
const BASE: usize = 8;
/// Most valleys that are left for a lower one, and by how much lower it must be.
const RESCANS: usize = 3;
const LOWER: f64 = 0.99;
/// Times that simpler effects are asked in the place of those of the last set.
const ROUNDS: usize = 4;
/// A model is well inside the budget below this multiple of it.
const INSIDE: f64 = 1.12;
/// A form must be better than another one by this much to take its place, nats.
const FORM: f64 = 4.0;

/// What searches that share an observer tell it by.
pub type Tell<'a> = &'a (dyn Fn(&Event<'_>) + Sync);

/// The effects of a model, what it would lose without each, and the model then; the least needed last.
type Costs = Vec<(usize, Difference, Node)>;

/// How far a search has come.
pub struct Climb {
    pub(super) base: Node,
    /// Sets of effects by their number, the best first.
    nodes: Vec<Vec<Node>>,
    ranking: Vec<Ranked>,
    /// What the candidates promise beside the best set of each size.
    screened: Vec<(Node, Screened)>,
    /// Sets that predict better than what they were grown from, or were asked in the place of an effect, but are not what they are
    /// called, and why.
    refused: Vec<(Node, Refusal)>,
    /// Those of the last size that are extended.
    beam: Vec<Node>,
    /// Other places that the sets of one effect are fitted from.
    elsewhere: Vec<Node>,
    /// A set that another reading led to.
    led: Option<Node>,
    ended: bool,
}

impl Climb {
    /// The best set of the largest size, and its size.
    pub fn top(&self) -> (&Node, usize) {
        let size = self.nodes.len() - 1;
        (self.nodes.last().and_then(|sets| sets.first()).unwrap_or(&self.base), size)
    }

    /// Terms of a model that the base does not have.
    pub fn added(&self, node: &Node) -> Vec<usize> {
        node.added_to(&self.base)
    }
}

/// A running search.
pub struct Search<'a> {
    family: &'a dyn ModelFamily,
    ahead: &'a dyn Ahead,
    comparison: Comparison<'a>,
    thresholds: Thresholds,
    /// Terms that may be added.
    candidates: Vec<usize>,
    /// Every comparison so far.
    pub decisions: Vec<Decision>,
    remarks: Vec<Remark>,
    stop: &'a (dyn Fn() -> bool + Sync),
    tell: Tell<'a>,
    untried: BTreeSet<usize>,
    /// Effects that promised most beside the best set of some size.
    promised: BTreeSet<usize>,
    /// Sets that were compared with the last one as simpler or less simple, with effects that every system has besides: as
    /// many effects or not.
    twins: Vec<Node>,
    /// Effects that lower no error, or none that others would not: they are none.
    none: BTreeSet<usize>,
    /// Whether what leaves more than the sensors make counts for nothing: what is left beside it is not asked.
    pub all_or_nothing: bool,
}

impl<'a> Search<'a> {
    /// A search among `candidates` that ends early where `stop` says so.
    pub fn new(
        family: &'a dyn ModelFamily,
        ahead: &'a dyn Ahead,
        thresholds: Thresholds,
        candidates: Vec<usize>,
        stop: &'a (dyn Fn() -> bool + Sync),
        tell: Tell<'a>,
    ) -> Self {
        Self {
            family,
            ahead,
            comparison: Comparison::new(family, ahead),
            thresholds,
            candidates,
            decisions: Vec::new(),
            remarks: Vec::new(),
            stop,
            tell,
            untried: BTreeSet::new(),
            promised: BTreeSet::new(),
            twins: Vec::new(),
            none: BTreeSet::new(),
            all_or_nothing: false,
        }
    }

    fn fitter(&self) -> Fitter<'a> {
        Fitter::new(self.family, self.ahead).stopped_by(self.stop)
    }

    fn refit(&self, model: &Fitted, setting: usize, steps: usize) -> Node {
        self.fitter().refit(model.clone(), setting, steps)
    }

    /// The base model at its best, from a start that need not be near.
    pub fn base(&self, start: Fitted) -> Node {
        // Without a base model nothing can be said, however little time there is.
        self.base_by(Fitter::new(self.family, self.ahead), start)
    }

    /// The same as far as time allows, where something can be said without.
    pub fn base_in_time(&self, start: Fitted) -> Node {
        self.base_by(self.fitter(), start)
    }

    fn base_by(&self, fitter: Fitter<'_>, start: Fitted) -> Node {
        let half = self.ahead.settings() / 2;
        // From much process noise to little: the valley narrows.
        let mut node = fitter.fit(start, half - 1, BASE);
        for setting in [half.saturating_sub(3), half.saturating_sub(5)] {
            node = fitter.fit(node.model, setting, BASE);
        }
        fitter.settled(node, STEPS.0)
    }

    /// The base model at its best, from a start that is near.
    pub fn base_near(&self, start: Fitted) -> Node {
        self.near_by(Fitter::new(self.family, self.ahead), start)
    }

    /// The same as far as time allows.
    pub fn base_near_in_time(&self, start: Fitted) -> Node {
        self.near_by(self.fitter(), start)
    }

    fn near_by(&self, fitter: Fitter<'_>, start: Fitted) -> Node {
        let setting = fit::best_setting(self.ahead, &start);
        fitter.refit(start, setting, STEPS.0)
    }

    /// The base model at its best with what every model has as it is.
    pub fn base_holding(&self, start: Fitted) -> Node {
        self.base_by(self.fitter().holding(), start)
    }

    /// Sets of one effect beside a base model, fitted from there and from where it stands `elsewhere`.
    pub fn begin(&mut self, base: Node, elsewhere: Vec<Node>) -> Climb {
        let mut climb = Climb {
            nodes: vec![vec![base.clone()]],
            ranking: Vec::new(),
            screened: Vec::new(),
            refused: Vec::new(),
            beam: std::iter::once(&base).chain(&elsewhere).cloned().collect(),
            base,
            elsewhere,
            led: None,
            ended: false,
        };
        self.grow(&mut climb);
        climb
    }

    /// Goes on to the best set of effects, one that another reading led to among them.
    pub fn finish_led(self, climb: Climb, led: Node) -> Found {
        self.finish(Climb { led: Some(led), ..climb })
    }

    /// Goes on to the best set of effects.
    pub fn finish(mut self, mut climb: Climb) -> Found {
        let grown = self.grown(&mut climb);
        self.finish_grown(climb, grown)
    }

    /// The same from the best set of those that were grown.
    pub fn finish_grown(mut self, mut climb: Climb, mut best: Node) -> Found {
        (self.tell)(&Event::Concluding);
        if !self.is_complete(&best) {
            best = self.beside_usual(&mut climb, best);
        }
        let mut best = self.usual_instead(&climb, best);
        let (mut simplified, mut unseen) = (BTreeSet::new(), BTreeSet::new());
        let (mut rival, mut unknown) = (None, None);
        loop {
            let (needed, costs) = self.prune(&climb, best);
            // What took the place of one effect, or is left of a set that another one has gone from, may leave an effect to a
            // simpler one, too; what leads back does not.
            if rival.is_none()
                && (!self.all_or_nothing || self.is_complete(&needed))
                && simplified.len() < ROUNDS
                && simplified.insert(needed.model.terms.clone())
                && let Some(simpler) = self.simplified(&mut climb, &needed, &costs)
            {
                best = simpler;
                continue;
            }
            let last = self.plainest(needed, &costs);
            let other = self.with_other_law(&climb, &last);
            if let Some(base) = other.or_else(|| self.with_reading(&climb, &last)) {
                let climb = self.begin(base, Vec::new());
                return self.finish(climb);
            }
            if self.all_or_nothing && !self.is_complete(&last) {
                return self.conclude(climb, &last, (costs, 1.0), Screened::default(), None);
            }
            let told = not_told(self.family, self.ahead, &climb.base, &last);
            if let Some((term, refusal)) = told {
                // Its last fit took it there, or the data do not tell.
                climb.refused.push((last.clone(), refusal.clone()));
                let is = |cost: &&(usize, Difference, Node)| self.main(cost.0) == self.main(term);
                if let Some((_, cost, without)) = costs.iter().find(is).or(costs.last()) {
                    let found = || Some((self.unknown(&climb, &last, &refusal, *cost)?, *cost));
                    unknown = unknown.or_else(found);
                    let (size, cost) = (costs.len() - 1, negative(*cost));
                    let because = Some(Reason::Refused { refusal });
                    self.note(size, without, &last, cost, Outcome::NotIdentifiable, because);
                    let left = self.what_is_left(&climb, without);
                    best = self.best_of_its_size(&climb, left);
                    continue;
                }
            }
            if unseen.insert(last.model.terms.clone()) {
                self.ask_unseen(&mut climb, &last, &costs);
            }
            if rival.is_none() {
                if let Some((without, found)) = self.instead(&climb, &last) {
                    rival = found;
                    best = without;
                    continue;
                }
            } else if !costs.is_empty()
                && let Some((without, found)) = self.outdone(&climb, &last)
            {
                // What a rival leaves of the names may be what a refused model does better.
                rival = rival.into_iter().chain(found).max_by(|a, b| gain(a).total_cmp(&gain(b)));
                best = without;
                continue;
            }
            let mut beside = self.beside(&climb, &last);
            if beside.promises.is_empty() {
                // Nothing else is open: what was gained by chance where the last one was added.
                let before = costs.len().checked_sub(1).and_then(|k| climb.ranking.get(k));
                beside.chance = before.map(|ranked| ranked.chance.clone()).unwrap_or_default();
            }
            let (p_value, by_chance) = self.chance_of(&climb, &costs, &beside);
            let Some((_, cost, without)) = costs.last().filter(|_| by_chance) else {
                // Where nothing is named something is missing all the same.
                let enough = |(_, gain): &(Remains, Difference)| {
                    costs.is_empty()
                        && gain.nats > self.thresholds.better / self.ahead.asked()
                        && self.p_value(&beside, *gain) <= self.thresholds.chance
                };
                let unknown = unknown.filter(enough).map(|(remains, _)| remains);
                // What foretells most is told, but not what a refused model alone says of what nobody can see.
                rival = rival.into_iter().chain(unknown).max_by(|a, b| gain(a).total_cmp(&gain(b)));
                let unseen = costs.is_empty() && self.leaves_nothing(&climb.base);
                let unnamed = |rival: &Remains| matches!(rival, Remains::Outdone { instead_of, .. } if instead_of.is_empty());
                rival = rival.filter(|rival| !(unseen && unnamed(rival)));
                return self.conclude(climb, &last, (costs, p_value), beside, rival);
            };
            let (size, cost) = (costs.len() - 1, negative(*cost));
            self.note(size, without, &last, cost, Outcome::Dropped, Some(Reason::Chance));
            best = without.clone();
        }
    }

    /// The best set of effects. Where pruning comes to a smaller set that no size had, the search goes on from there
    /// (floating search: P. Pudil, J. Novovicova and J. Kittler, 1994).
    pub fn grown(&mut self, climb: &mut Climb) -> Node {
        loop {
            while !climb.ended && climb.nodes.len() <= self.thresholds.most {
                self.grow(climb);
            }
            if let Some(led) = climb.led.take().filter(|_| !(self.stop)())
                && self.follows(climb, &led)
            {
                continue;
            }
            let best = self.size(climb, climb.base.clone(), 0);
            self.none.clear();
            let (needed, costs) = self.prune(climb, best);
            let size = costs.len();
            if self.goes_without(climb, &needed, size) {
                continue;
            }
            let known = |set: &Node| self.key(set) == self.key(&needed);
            let sets = climb.nodes.get(size).map_or(&[][..], Vec::as_slice);
            let whole = climb.nodes.len() <= size;
            if whole || sets.iter().any(known) || self.budget(&needed) < INSIDE || (self.stop)() {
                return needed;
            }
            climb.nodes.truncate(size + 1);
            climb.ranking.truncate(size);
            let mut sets = self.related(&[&needed]);
            sets.retain(|set| {
                let (gain, refusal) = self.asked(&climb.base, &climb.base, set, size);
                gain.nats > self.thresholds.better && refusal.is_none()
            });
            sets.insert(0, needed);
            climb.nodes[size].splice(0..0, sets.iter().cloned());
            climb.beam = sets;
            climb.ended = false;
        }
    }

    /// Whether the search begins once more, to sets that are no larger, without what is no effect: where such sets stood before
    /// the one that is needed, they took the places of others.
    fn goes_without(&mut self, climb: &mut Climb, needed: &Node, size: usize) -> bool {
        let has_none = |set: &Node| !self.key(set).is_disjoint(&self.none);
        let sets = climb.nodes.get(size).map_or(&[][..], Vec::as_slice);
        let first = sets.iter().find(|set| self.key(set) == self.key(needed) || has_none(set));
        if !first.is_some_and(has_none) || (self.stop)() {
            return false;
        }
        let open = self.candidates.iter().copied();
        self.candidates = open.filter(|term| !self.none.contains(&self.main(*term))).collect();
        self.thresholds.most = size;
        let again = self.begin(climb.base.clone(), climb.elsewhere.clone());
        let before = std::mem::replace(climb, again);
        climb.refused.extend(before.refused);
        true
    }

    /// Chance of as large a difference on all of the recording.
    fn p_value(&self, screened: &Screened, difference: Difference) -> f64 {
        screened.chance.p_value(self.in_full(difference.nats))
    }

    /// Chance of what a model would lose without its least effect, and whether that effect goes for it.
    ///
    /// Placebos are asked to first order at trial shapes, where a fit is free to choose the shape that suits the noise best.
    /// What gains as much as is asked of many errors is beyond that. Of few errors an effect is asked as the placebos are,
    /// beside the model without it; and one of all must be more than chance beside the base: of several that follow the
    /// noise each gains beside the others.
    fn chance_of(&self, climb: &Climb, costs: &Costs, beside: &Screened) -> (f64, bool) {
        let Some((term, cost, without)) = costs.last() else { return (0.0, false) };
        let by_chance = |p_value: f64| p_value > self.thresholds.chance;
        let p_value = self.p_value(beside, *cost);
        if cost.nats > self.thresholds.better / self.ahead.asked() {
            return (p_value, by_chance(p_value));
        }
        let as_promised = |from: &Node, term: usize| {
            let screened = self.beside(climb, from);
            let promise = screened.promises.iter().find(|p| self.main(p.term) == self.main(term));
            promise
                .map_or(1.0, |promise| screened.chance.p_value_of_few(self.in_full(promise.gain)))
        };
        let p_value = p_value.max(as_promised(without, *term));
        let alone = |cost: &(usize, Difference, Node)| as_promised(&climb.base, cost.0);
        (p_value, by_chance(p_value) || costs.iter().map(alone).all(by_chance))
    }

    /// What a gain on the part that is searched stands for on all of the recording: what is told is told of that.
    fn in_full(&self, nats: f64) -> f64 {
        nats / self.ahead.share()
    }

    /// The candidates beside a model, with what they would gain by chance; as they were screened where the search went
    /// on from one that is as good.
    fn beside(&self, climb: &Climb, node: &Node) -> Screened {
        let as_good = |other: &Node| {
            let same = (&other.model.terms, other.setting) == (&node.model.terms, node.setting);
            same && self.comparison.compare(other, node).nats.abs() < FORM
        };
        if let Some((_, known)) = climb.screened.iter().find(|(other, _)| as_good(other)) {
            return known.clone();
        }
        let open = self.candidates.iter().copied();
        let open: Vec<usize> = open.filter(|&t| self.family.joins(&node.model, t)).collect();
        screen(self.family, self.ahead, node, &open, true)
    }

    /// Prediction error over what the sensors alone make.
    pub fn budget(&self, node: &Node) -> f64 {
        node.scale / self.ahead.budget()
    }

    /// Whether a model leaves no more than the sensors make, as far as one number tells.
    pub fn is_complete(&self, node: &Node) -> bool {
        self.budget(node) <= self.thresholds.complete
    }

    /// Whether a model explains all that a base errs which is not complete; where that errs little, all of the force that
    /// it lacks beyond doubt.
    fn explains(&self, base: &Node, node: &Node) -> bool {
        let all = || {
            let (force, band) = base.lacks(self.ahead)?;
            let (left, _) = node.lacks(self.ahead)?;
            Some(force > self.thresholds.local * band && left * left <= MOST_WITHIN * force * force)
        };
        self.budget(node) <= 1.0 && (!self.is_complete(base) || all().unwrap_or(false))
    }

    /// Whether a model errs no more than the sensors make, and lacks no force beyond doubt.
    fn leaves_nothing(&self, node: &Node) -> bool {
        let in_doubt = |(force, band)| force <= self.thresholds.complete * band;
        self.budget(node) <= 1.0 && node.lacks(self.ahead).is_some_and(in_doubt)
    }

    /// Terms of a node that the base does not have, in the order of the model.
    fn added(base: &Node, node: &Node) -> Vec<usize> {
        node.added_to(base)
    }

    /// The effect that a term is a form of.
    fn main(&self, term: usize) -> usize {
        self.family.form_of(term).unwrap_or(term)
    }

    /// What makes two sets the same: the effects, whatever their form.
    fn key(&self, node: &Node) -> BTreeSet<usize> {
        self.mains(&node.model.terms)
    }

    /// The effects that terms are forms of.
    fn mains(&self, terms: &[usize]) -> BTreeSet<usize> {
        terms.iter().map(|term| self.main(*term)).collect()
    }

    /// Number of parameters of a set; a flexible form counts as the plain one that it stands for.
    fn parameters(&self, node: &Node) -> usize {
        let counted = |t: &usize| if self.ahead.is_candidate(*t) { *t } else { self.main(*t) };
        node.model.terms.iter().map(|t| self.family.terms()[counted(t)].parameters.len()).sum()
    }

    fn sorted(&self, mut nodes: Vec<Node>) -> Vec<Node> {
        // Held out, in the units of the best: the comparison with one and the same node orders all.
        nodes.sort_by(|a, b| a.deviation.total_cmp(&b.deviation));
        let Some(first) = nodes.first().cloned() else { return nodes };
        let mut keyed: Vec<(f64, Node)> = nodes
            .into_iter()
            .map(|node| (self.comparison.compare(&node, &first).nats, node))
            .collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|(_, node)| node).collect()
    }

    fn names(&self, node: &Node) -> Vec<String> {
        node.names(self.family)
    }

    fn named(&self, terms: &[usize]) -> Vec<String> {
        terms.iter().map(|t| self.family.terms()[*t].name.clone()).collect()
    }

    fn note(
        &mut self,
        rung: usize,
        candidate: &Node,
        with: &Node,
        by: Difference,
        outcome: Outcome,
        because: Option<Reason>,
    ) {
        self.decisions.push(Decision {
            rung,
            candidate: self.names(candidate),
            compared_with: self.names(with),
            difference: self.in_full(by.nats),
            standard_error: self.in_full(by.error),
            budget: self.budget(candidate),
            outcome,
            because,
        });
    }
}

/// What something that is no effect, or was refused, foretells beyond a model, nats.
fn gain(remains: &Remains) -> f64 {
    match remains {
        Remains::Rival { nats, .. } | Remains::Outdone { nats, .. } => *nats,
        _ => 0.0,
    }
}

fn negative(difference: Difference) -> Difference {
    Difference { nats: -difference.nats, ranks: -difference.ranks, ..difference }
}

#[cfg(test)]
mod tests;
