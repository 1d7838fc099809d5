//! The search over sets of effects: the best few sets of each size side by side.
//!
//! From each set the candidates are screened to first order, the most promising are fitted, and each is given
//! another shape of its own before a further effect may be named. Of each size the set stands that predicts best,
//! and of those as good the one with the fewest parameters. At the end everything that is not needed goes.

use std::collections::BTreeSet;
use std::sync::Mutex;

use rayon::prelude::*;

use super::compare::{Comparison, Difference};
use super::decision::{Decision, Outcome};
use super::node::Node;
use super::screen::{Promise, Screened, screen};
use super::{Ahead, chance, fit, local, scales};
use crate::discover::{Event, Observer};
use crate::family::{Fitted, ModelFamily, Role};

/// Numbers that steer a search. Each stands in docs/decisions.md with what half and one and a half times of it do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thresholds {
    /// Held-out log-likelihood that an effect must gain, nats.
    pub better: f64,
    /// Share of all that is explained that an effect must explain.
    pub share: f64,
    /// Sets this near to the best of their size are as good: nats, or this share of the gain.
    pub as_good: (f64, f64),
    /// A model whose errors exceed what the sensors make by more than this factor is incomplete.
    pub complete: f64,
    /// A model that errs more than this many times what the sensors make at some place, at some time or in isolated
    /// samples is incomplete, whatever it does on the whole.
    pub local: f64,
    /// Effects are only named where they remove at least this share of what exceeds the sensors, or leave a complete
    /// model: else the nearest effects are not the cause.
    pub explained: f64,
    /// Sets that are followed side by side.
    pub beam: usize,
    /// Candidates that are fitted beside each set.
    pub fitted: usize,
    /// Most effects of a set.
    pub most: usize,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            better: 40.0,
            share: 0.02,
            as_good: (6.0, 0.02),
            complete: 1.3,
            local: 2.0,
            explained: 0.25,
            beam: 3,
            fitted: 5,
            most: 4,
        }
    }
}

/// Steps of a first fit, of a refit elsewhere, and of the last one.
const STEPS: (usize, usize, usize) = (6, 6, 12);
/// Steps of the base model at each process noise on the way down.
const BASE: usize = 8;
/// Most valleys that are left for a lower one, and by how much lower it must be.
const RESCANS: usize = 3;
const LOWER: f64 = 0.99;
/// Only models whose errors are within this factor of the best of their size are looked at so closely.
const NEAR: f64 = 1.25;
/// Steps of a refit on all of a recording that was searched in part.
const IN_FULL: usize = 8;
/// Promise below which a candidate is not fitted beside the base, nats.
const PROMISING: f64 = 2.0;
/// A model is well inside the budget below this multiple of it.
const INSIDE: f64 = 1.12;
/// Candidates that are fitted before it is asked whether others are needed, and the share of their promise from which
/// another one is a rival.
const FIRST: usize = 2;
const RIVAL: f64 = 0.1;
/// A form must be better than another one by this much to take its place, nats.
const FORM: f64 = 4.0;

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The base model.
    pub base: Node,
    /// The model of every rung above it, the last one with all that was found.
    pub rungs: Vec<Node>,
    /// Term that each rung adds.
    pub added: Vec<usize>,
    /// What each rung gains over the one before.
    pub gains: Vec<Difference>,
    /// What the last model loses without each of the terms added.
    pub costs: Vec<Difference>,
    /// Sets of added terms that predict as well as the ones found.
    pub as_good: Vec<Vec<usize>>,
    /// Candidates beside the best set of each size.
    pub ranking: Vec<Ranked>,
    /// Chance of as large a first-order gain, for each rung.
    pub p_values: Vec<f64>,
    /// The candidates beside the last model, to first order.
    pub last_screening: Vec<Promise>,
    /// Whether the last model leaves no more than the sensors make.
    pub complete: bool,
    /// Where what is left lies, in words, the largest first.
    pub places: Vec<String>,
    /// What a user should know besides.
    pub notes: Vec<String>,
    /// Every comparison.
    pub decisions: Vec<Decision>,
    /// Terms that were not tried because time ran out.
    pub untried: Vec<usize>,
    /// Whether the search was cut short.
    pub stopped: bool,
}

impl Found {
    /// Brings what was found on a part to all of the recording: every rung is refitted there and compared anew;
    /// rungs from the first one on that does not hold are taken back.
    pub fn confirm<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let whole = |node: &Node| {
            let setting = fit::best_setting(ahead, &node.model);
            fit::fit(family, ahead, node.model.clone(), setting, IN_FULL)
        };
        let comparison = Comparison::new(family, ahead);
        self.base = whole(&self.base);
        let mut held: Vec<Node> = Vec::new();
        let mut gains = Vec::new();
        for node in &self.rungs {
            let node = whole(node);
            let gain = comparison.compare(held.last().unwrap_or(&self.base), &node);
            if gain.nats <= thresholds.better {
                break;
            }
            gains.push(gain);
            held.push(node);
        }
        let count = held.len();
        if count < self.rungs.len() {
            let names = &family.terms()[self.added[count]].name;
            self.notes.push(format!(
                "A search on parts of the recording found {names} besides; on all of it that gains too little."
            ));
            self.costs.truncate(count);
            self.as_good.clear();
        }
        self.added.truncate(count);
        (self.rungs, self.gains) = (held, gains);
        let top = self.rungs.last().unwrap_or(&self.base);
        self.places = local::places(ahead, top, thresholds.local);
        self.complete = top.scale / ahead.budget() <= thresholds.complete && self.places.is_empty();
    }

    /// Takes all names back where much is left and what was found explains little of it: the nearest effects are not
    /// the cause then.
    pub fn judge<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let Some(top) = self.rungs.last().filter(|_| !self.complete) else { return };
        let excess = |node: &Node| ((node.scale / ahead.budget()).powi(2) - 1.0).max(0.0);
        // A search that was cut short has not said its last word. What a few wild samples leave is no business of any
        // effect.
        let ended = !self.stopped && self.added.len() < thresholds.most;
        let explains = !ended || excess(top) <= (1.0 - thresholds.explained) * excess(&self.base);
        if explains && local::faults(&top.errors).is_none() {
            return;
        }
        let names: Vec<&str> =
            self.added.iter().map(|term| family.terms()[*term].name.as_str()).collect();
        self.notes.push(format!(
            "nearest: {} would lower the prediction error only from {:.2} to {:.2} times what the sensors make: \
             that is not the cause",
            names.join(" + "),
            self.base.scale / ahead.budget(),
            top.scale / ahead.budget(),
        ));
        self.places = local::places(ahead, &self.base, thresholds.local);
        self.rungs.clear();
        self.added.clear();
        self.gains.clear();
        self.costs.clear();
        self.as_good.clear();
        self.p_values.clear();
    }

    /// Whether a term, in whatever form, is among `terms`.
    pub fn is_in<F: ModelFamily + ?Sized>(&self, terms: &[usize], term: usize, family: &F) -> bool {
        let main = |t: usize| family.form_of(t).unwrap_or(t);
        terms.iter().any(|other| main(*other) == main(term))
    }
}

/// Candidates beside one model.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// Term, the model with it, what it gains (nats), the best first.
    pub rows: Vec<(usize, Fitted, f64)>,
    /// What any candidate gains by chance, to first order.
    pub chance: Vec<f64>,
    /// Number of errors that say as much as independent ones.
    pub points: f64,
}

/// An observer that parts of a search on several threads may share.
struct Watch<'a>(Mutex<&'a mut (dyn Observer + Send)>);

impl Watch<'_> {
    fn tell(&self, event: &Event<'_>) {
        if let Ok(mut observer) = self.0.lock() {
            observer.event(event);
        }
    }
}

/// A running search.
pub struct Search<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    ahead: &'a dyn Ahead,
    comparison: Comparison<'a, F>,
    thresholds: Thresholds,
    /// Terms that may be added.
    candidates: Vec<usize>,
    decisions: Vec<Decision>,
    notes: Vec<String>,
    stop: &'a (dyn Fn() -> bool + Sync),
    observer: Watch<'a>,
    untried: BTreeSet<usize>,
}

impl<'a, F: ModelFamily + ?Sized> Search<'a, F> {
    /// A search among `candidates` that ends early where `stop` says so.
    pub fn new(
        family: &'a F,
        ahead: &'a dyn Ahead,
        thresholds: Thresholds,
        candidates: Vec<usize>,
        stop: &'a (dyn Fn() -> bool + Sync),
        observer: &'a mut (dyn Observer + Send),
    ) -> Self {
        Self {
            family,
            ahead,
            comparison: Comparison::new(family, ahead),
            thresholds,
            candidates,
            decisions: Vec::new(),
            notes: Vec::new(),
            stop,
            observer: Watch(Mutex::new(observer)),
            untried: BTreeSet::new(),
        }
    }

    /// The base model at its best, from a start that need not be near.
    pub fn base(&self, start: Fitted) -> Node {
        let half = self.ahead.settings() / 2;
        let fit = |start: Fitted, setting| fit::fit(self.family, self.ahead, start, setting, BASE);
        // From much process noise to little: the valley narrows.
        let mut node = fit(start, half - 1);
        for setting in [half.saturating_sub(3), half.saturating_sub(5)] {
            node = fit(node.model, setting);
        }
        fit::settled(self.family, self.ahead, node, STEPS.0)
    }

    /// Searches from a base model for at most so many effects.
    pub fn run(mut self, base: Node, most: usize) -> Found {
        self.thresholds.most = self.thresholds.most.min(most);
        let (nodes, ranking) = self.climb(&base);
        let best = self.size(&base, &nodes);
        let (last, costs) = self.prune(&base, best, &nodes);
        let last = self.plainest(last);
        self.conclude(base, &last, costs, &nodes, ranking)
    }

    /// Sets of effects by their number, the best first.
    fn climb(&mut self, base: &Node) -> (Vec<Vec<Node>>, Vec<Ranked>) {
        let mut nodes = vec![vec![base.clone()]];
        let mut ranking = Vec::new();
        let mut beam = vec![base.clone()];
        // Without any effect to add the candidates are still looked at.
        for size in 1..=self.thresholds.most.max(1) {
            let mut next: Vec<(Node, Difference)> = Vec::new();
            for (place, from) in beam.iter().enumerate() {
                let (children, screened) = self.expand(base, from, size, place == 0);
                if place == 0 {
                    ranking.push(self.ranked(from, &children, screened));
                }
                for child in children {
                    let gain = self.comparison.compare(from, &child);
                    if let Some(parameter) = self.at_limit(base, &child) {
                        let reason = format!("{parameter} ended at the limit of its search");
                        self.note(size, &child, from, gain, Outcome::NotIdentifiable, &reason);
                        if gain.nats > self.thresholds.better && size == 1 {
                            let effects = self.names(&child).join(" + ");
                            self.notes.push(format!("{effects} is not named: {reason}"));
                        }
                        continue;
                    }
                    let outcome = if gain.nats > self.thresholds.better {
                        Outcome::AsGood
                    } else {
                        Outcome::TooLittle
                    };
                    self.note(size, &child, from, gain, outcome, "");
                    let effects = self.names(&child);
                    self.observer.tell(&Event::Compared {
                        rung: size,
                        effects: &effects,
                        nats: gain.nats,
                    });
                    if gain.nats <= self.thresholds.better {
                        continue;
                    }
                    let same =
                        |(other, _): &(Node, Difference)| self.key(other) == self.key(&child);
                    match next.iter().position(same) {
                        Some(k) if self.comparison.compare(&next[k].0, &child).nats > 0.0 => {
                            next[k] = (child, gain);
                        }
                        Some(_) => {}
                        None => next.push((child, gain)),
                    }
                }
                if (self.stop)() {
                    break;
                }
            }
            if self.thresholds.most == 0 {
                break;
            }
            let ranked = self.sorted(next.into_iter().map(|(node, _)| node).collect());
            if ranked.is_empty() {
                break;
            }
            // Inside the budget rivals need no extension.
            let width = if self.budget(&ranked[0]) < INSIDE { 1 } else { self.thresholds.beam };
            beam = ranked.iter().take(width).cloned().collect();
            nodes.push(ranked);
            if (self.stop)() {
                break;
            }
        }
        (nodes, ranking)
    }

    /// A set with one effect more: the most promising ones, fitted, each in the form that is best.
    fn expand(
        &mut self,
        base: &Node,
        from: &Node,
        size: usize,
        first: bool,
    ) -> (Vec<Node>, Screened) {
        let open: Vec<usize> = self
            .candidates
            .iter()
            .copied()
            .filter(|&term| self.family.joins(&from.model, term))
            .collect();
        if (self.stop)() {
            self.untried.extend(open);
            return (Vec::new(), Screened::default());
        }
        self.observer.tell(&Event::Screening { rung: size, candidates: open.len() });
        let screened = screen(self.family, self.ahead, from, &open, first);
        // The first order seldom promises less than half of what a fit gains.
        let least = if size == 1 {
            PROMISING
        } else {
            0.5 * self
                .thresholds
                .better
                .max(self.thresholds.share * self.comparison.compare(base, from).nats)
        };
        let most = if size == 1 {
            self.thresholds.fitted
        } else {
            self.thresholds.fitted.min(self.thresholds.beam)
        };
        // Two forms of an effect at most, so that one effect does not take all places.
        let mut mains: Vec<usize> = Vec::new();
        let mut starts: Vec<&Promise> = Vec::new();
        for promise in screened.promises.iter().filter(|promise| promise.gain > least) {
            let main = self.main(promise.term);
            let forms = mains.iter().filter(|other| **other == main).count();
            let distinct = mains.iter().collect::<BTreeSet<_>>().len();
            if forms >= 2 || (forms == 0 && distinct >= most) {
                continue;
            }
            mains.push(main);
            starts.push(promise);
        }
        let begin = |promises: &[&Promise]| -> Vec<(usize, Option<Node>)> {
            promises.par_iter().map(|p| (p.term, self.begun(p, from.setting))).collect()
        };
        // Where one of the first leaves no more than the sensors make, only those that promise as much are rivals.
        let (first, others) = starts.split_at(FIRST.min(starts.len()));
        let mut fitted = begin(first);
        let inside =
            fitted.iter().flat_map(|(_, node)| node).any(|node| self.budget(node) < INSIDE);
        let top = starts.first().map_or(0.0, |promise| promise.gain);
        let rivals: Vec<&Promise> =
            others.iter().copied().filter(|p| !inside || p.gain >= RIVAL * top).collect();
        fitted.extend(begin(&rivals));
        self.untried
            .extend(fitted.iter().filter(|(_, node)| node.is_none()).map(|(term, _)| *term));
        let mut fitted: Vec<Node> = fitted.into_iter().filter_map(|(_, node)| node).collect();
        fitted.sort_by(|a, b| a.scale.total_cmp(&b.scale));
        let keep = if size == 1 { fitted.len() } else { self.thresholds.beam };
        fitted.truncate(keep);
        let mut settled: Vec<Node> = fitted
            .into_par_iter()
            .map(|node| fit::settled(self.family, self.ahead, node, STEPS.1))
            .collect();
        let best = settled.iter().map(|node| node.scale).fold(f64::INFINITY, f64::min);
        settled = settled
            .into_par_iter()
            .map(|node| if node.scale <= NEAR * best { self.rescanned(node) } else { node })
            .collect();
        settled.sort_by(|a, b| a.scale.total_cmp(&b.scale));
        let beam = self.thresholds.beam;
        let shaped = settled.into_par_iter().enumerate();
        let shaped = shaped
            .map(|(place, node)| if size == 1 || place < beam { self.shaped(&node) } else { node });
        (shaped.collect(), screened)
    }

    /// A candidate fitted from the best of its starts; nothing where time ran out.
    fn begun(&self, promise: &Promise, setting: usize) -> Option<Node> {
        if (self.stop)() {
            return None;
        }
        let fit =
            |start: &Fitted| fit::fit(self.family, self.ahead, start.clone(), setting, STEPS.0);
        let fitted: Vec<Node> = promise.starts.par_iter().map(fit).collect();
        fitted.into_iter().min_by(|a, b| a.scale.total_cmp(&b.scale))
    }

    /// The node, or one in a lower valley beside it.
    fn rescanned(&self, mut node: Node) -> Node {
        for _ in 0..RESCANS {
            let beside = self.ahead.variations(&node.model);
            if beside.is_empty() || (self.stop)() {
                break;
            }
            let trials: Vec<(Fitted, usize)> =
                beside.into_iter().map(|model| (model, node.setting)).collect();
            let errors = self.ahead.errors(&trials);
            let nodes = trials.into_iter().zip(errors).map(|((m, s), e)| Node::new(m, s, e));
            let Some(best) = nodes.min_by(|a, b| a.scale.total_cmp(&b.scale)) else { break };
            let fitted = fit::fit(self.family, self.ahead, best.model, node.setting, STEPS.1);
            let fitted = fit::settled(self.family, self.ahead, fitted, STEPS.1);
            if fitted.scale > LOWER * node.scale {
                break;
            }
            node = fitted;
        }
        node
    }

    /// The node, or the same with effects in their flexible forms where that is clearly better.
    fn shaped(&self, node: &Node) -> Node {
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
            let flexible = fit::fit(self.family, self.ahead, start, node.setting, STEPS.1);
            let flexible = fit::settled(self.family, self.ahead, flexible, STEPS.1);
            if self.comparison.compare(&best, &flexible).nats > FORM {
                best = flexible;
            }
        }
        best
    }

    /// The best set, of the smallest size that is needed.
    fn size(&mut self, base: &Node, nodes: &[Vec<Node>]) -> Node {
        let mut best = base.clone();
        for (size, sets) in nodes.iter().enumerate().skip(1) {
            let top = &sets[0];
            let gain = self.comparison.compare(&best, top).nats;
            let (nats, share) = self.thresholds.as_good;
            let near = nats.max(share * gain);
            let simplest = sets
                .iter()
                .take(6)
                .filter(|set| self.comparison.compare(set, top).nats <= near)
                .min_by_key(|set| self.parameters(set))
                .unwrap_or(top);
            let polished = fit::fit(
                self.family,
                self.ahead,
                simplest.model.clone(),
                simplest.setting,
                STEPS.2,
            );
            let polished = fit::settled(self.family, self.ahead, polished, STEPS.1);
            let set = if self.comparison.compare(simplest, &polished).nats > 0.0 {
                polished
            } else {
                simplest.clone()
            };
            let gain = self.comparison.compare(&best, &set);
            let all = self.comparison.compare(base, &set).nats.max(1e-9);
            let taken = gain.nats > self.thresholds.better
                && (size == 1 || gain.nats / all > self.thresholds.share);
            let outcome = if taken { Outcome::Added } else { Outcome::TooLittle };
            let reason = format!("the best set of {size}");
            let from = best.clone();
            self.note(size, &set, &from, gain, outcome, &reason);
            if !taken {
                break;
            }
            best = set;
        }
        best
    }

    /// Takes out what is not needed, and says what each of the rest is worth.
    fn prune(
        &mut self,
        base: &Node,
        mut best: Node,
        nodes: &[Vec<Node>],
    ) -> (Node, Vec<(usize, Difference, Node)>) {
        loop {
            let mut costs: Vec<(usize, Difference, Node)> = Vec::new();
            for term in Self::added(base, &best) {
                let without = self.without(base, &best, term, nodes);
                let cost = self.comparison.compare(&without, &best);
                costs.push((term, cost, without));
            }
            costs.sort_by(|a, b| b.1.nats.total_cmp(&a.1.nats));
            let idle = costs.len() > 1
                && costs.last().is_some_and(|cost| cost.1.nats < self.thresholds.better);
            if !idle {
                return (best, costs);
            }
            if let Some((_, cost, without)) = costs.pop() {
                let size = costs.len();
                let from = best.clone();
                self.note(
                    size,
                    &without,
                    &from,
                    negative(cost),
                    Outcome::Dropped,
                    "as good without",
                );
                best = without;
            }
        }
    }

    /// The model without a term, refitted.
    fn without(&self, base: &Node, node: &Node, term: usize, nodes: &[Vec<Node>]) -> Node {
        let model = node.model.without(self.family, term);
        if Self::added(base, node).len() == 1 {
            return base.clone();
        }
        let fitted = fit::fit(self.family, self.ahead, model, node.setting, STEPS.1);
        let mut best = fit::settled(self.family, self.ahead, fitted, STEPS.1);
        let key = self.key(&best);
        for other in nodes.iter().flatten().filter(|other| self.key(other) == key) {
            if self.comparison.compare(&best, other).nats > 0.0 {
                best = other.clone();
            }
        }
        best
    }

    /// The same effects in their main forms, one by one, where those are as good.
    fn plainest(&mut self, node: Node) -> Node {
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
            let plain = fit::fit(self.family, self.ahead, plain.model, best.setting, STEPS.2);
            let plain = fit::settled(self.family, self.ahead, plain, STEPS.1);
            let loss = self.comparison.compare(&plain, &best);
            let as_good = loss.nats < self.thresholds.better;
            let outcome = if as_good { Outcome::Added } else { Outcome::OtherShape };
            let from = best.clone();
            self.note(
                best.effects(self.family).len(),
                &plain,
                &from,
                negative(loss),
                outcome,
                "the plain form",
            );
            if as_good {
                best = plain;
            }
        }
        best
    }

    fn conclude(
        mut self,
        base: Node,
        last: &Node,
        costs: Vec<(usize, Difference, Node)>,
        nodes: &[Vec<Node>],
        ranking: Vec<Ranked>,
    ) -> Found {
        // Forms may have changed since the costs were taken.
        let order: Vec<usize> = costs.iter().map(|(term, ..)| self.main(*term)).collect();
        let mut added: Vec<usize> = Vec::new();
        for main in &order {
            added.extend(last.effects(self.family).iter().filter(|t| self.main(**t) == *main));
        }
        let mut rungs = vec![last.clone()];
        for term in added.iter().skip(1).rev() {
            let Some(above) = rungs.last() else { break };
            let below = self.without(&base, above, *term, nodes);
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
        let as_good = nodes
            .get(added.len())
            .into_iter()
            .flatten()
            .filter(|set| self.key(set) != self.key(last))
            .filter(|set| self.comparison.compare(set, last).nats < self.thresholds.better)
            .map(|set| Self::added(&base, set))
            .collect();
        let stopped = (self.stop)();
        let top = rungs.last().unwrap_or(&base).clone();
        let open = self.candidates.iter().copied().filter(|&t| self.family.joins(&top.model, t));
        let open: Vec<usize> = open.collect();
        let last_screening = if stopped {
            Vec::new()
        } else {
            screen(self.family, self.ahead, &top, &open, false).promises
        };
        let of = |gain: &Difference, k: usize| {
            ranking.get(k).map_or(1.0, |ranked| chance::p_value(gain.nats, &ranked.chance))
        };
        let p_values = gains.iter().enumerate().map(|(k, gain)| of(gain, k)).collect();
        let places = local::places(self.ahead, &top, self.thresholds.local);
        let complete = self.budget(&top) <= self.thresholds.complete && places.is_empty();
        let mut decisions = std::mem::take(&mut self.decisions);
        let names = self.names(last);
        for decision in &mut decisions {
            if decision.outcome == Outcome::AsGood {
                let stands = decision.candidate == names;
                decision.outcome = if stands { Outcome::Added } else { Outcome::Worse };
            }
        }
        Found {
            base,
            rungs,
            added,
            gains,
            costs: costs.into_iter().map(|(_, cost, _)| cost).collect(),
            as_good,
            ranking,
            p_values,
            last_screening,
            complete,
            places,
            notes: std::mem::take(&mut self.notes),
            decisions,
            untried: self.untried.into_iter().collect(),
            stopped,
        }
    }

    /// Candidates of a rung with what they gain: fitted ones by comparison, the others as promised.
    fn ranked(&self, from: &Node, children: &[Node], screened: Screened) -> Ranked {
        let mut rows: Vec<(usize, Fitted, f64)> = Vec::new();
        for promise in screened.promises {
            let main = self.main(promise.term);
            if rows.iter().any(|(term, ..)| self.main(*term) == main) {
                continue;
            }
            let has =
                |node: &&Node| node.effects(self.family).iter().any(|t| self.main(*t) == main);
            let fitted = children.iter().find(has);
            let row = fitted.map(|node| {
                let term = node.effects(self.family).into_iter().find(|t| self.main(*t) == main);
                let gain = self.comparison.compare(from, node).nats;
                (term.unwrap_or(promise.term), node.model.clone(), gain)
            });
            let start = promise.starts.into_iter().next().unwrap_or_default();
            rows.push(row.unwrap_or((promise.term, start, promise.gain)));
        }
        rows.sort_by(|a, b| b.2.total_cmp(&a.2));
        Ranked {
            rows,
            chance: screened.chance,
            points: from.errors.len() as f64 / from.correlation(),
        }
    }

    /// Prediction error over what the sensors alone make.
    pub fn budget(&self, node: &Node) -> f64 {
        node.scale / self.ahead.budget()
    }

    /// Terms of a node that the base does not have, in the order of the model.
    fn added(base: &Node, node: &Node) -> Vec<usize> {
        node.model.terms.iter().copied().filter(|t| !base.model.terms.contains(t)).collect()
    }

    /// The effect that a term is a form of.
    fn main(&self, term: usize) -> usize {
        self.family.form_of(term).unwrap_or(term)
    }

    /// What makes two sets the same: the effects, whatever their form.
    fn key(&self, node: &Node) -> BTreeSet<usize> {
        node.model.terms.iter().map(|term| self.main(*term)).collect()
    }

    /// Number of parameters of the plain forms of a set.
    fn parameters(&self, node: &Node) -> usize {
        node.model.terms.iter().map(|t| self.family.terms()[self.main(*t)].parameters.len()).sum()
    }

    fn sorted(&self, mut nodes: Vec<Node>) -> Vec<Node> {
        // Held out, in the units of the best: the comparison with one and the same node orders all.
        nodes.sort_by(|a, b| a.scale.total_cmp(&b.scale));
        let Some(first) = nodes.first().cloned() else { return nodes };
        let mut keyed: Vec<(f64, Node)> = nodes
            .into_iter()
            .map(|node| (self.comparison.compare(&node, &first).nats, node))
            .collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|(_, node)| node).collect()
    }

    fn names(&self, node: &Node) -> Vec<String> {
        node.effects(self.family).iter().map(|t| self.family.terms()[*t].name.clone()).collect()
    }

    fn note(
        &mut self,
        rung: usize,
        candidate: &Node,
        with: &Node,
        by: Difference,
        outcome: Outcome,
        reason: &str,
    ) {
        self.decisions.push(Decision {
            rung,
            candidate: self.names(candidate),
            compared_with: self.names(with),
            difference: by.nats,
            standard_error: by.error,
            budget: self.budget(candidate),
            outcome,
            reason: reason.to_owned(),
        });
    }

    /// An amplitude of an added effect that ended at the limit of its search, if any: what it would be is not known.
    fn at_limit(&self, base: &Node, node: &Node) -> Option<String> {
        let moved = scales::of(self.family, &node.model);
        let parameters = node.model.parameters(self.family).zip(&moved);
        let own = parameters.skip(base.model.values.len());
        let mut limited =
            own.filter(|((_, p), moved)| p.role == Role::Amplitude && moved.is_at_far_limit());
        limited.next().map(|((term, parameter), _)| term.key(parameter))
    }
}

fn negative(difference: Difference) -> Difference {
    Difference { nats: -difference.nats, ..difference }
}

#[cfg(test)]
mod tests;
