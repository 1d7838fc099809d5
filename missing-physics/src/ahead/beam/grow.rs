//! From sets of effects to those with one more: screened, fitted, compared.

use std::cmp::Ordering;
use std::collections::BTreeSet;

use rayon::prelude::*;

use super::{Climb, FORM, INSIDE, STEPS, Search};
use crate::ahead::compare::Difference;
use crate::ahead::found::{Ranked, Row};
use crate::ahead::node::Node;
use crate::ahead::refused::refused;
use crate::ahead::screen::{Promise, Screened, screen};
use crate::family::Fitted;
use crate::report::{Outcome, Reason, Refusal, Remark};
use crate::task::Event;

/// Only models whose errors are within this factor of the best of their size are looked at so closely.
const NEAR: f64 = 1.25;
/// Share of what an effect must gain that a candidate must promise to be fitted beside the base, and the least and the
/// most that is asked, nats: more than chance promises. There the first order errs most.
const PROMISING: (f64, f64, f64) = (0.15, 2.0, 12.0);
/// A search ends where chance gains as much as the best candidate this often: two effects may hide each other, but not
/// so well.
const HOPELESS: f64 = 0.5;
/// Candidates that are fitted before it is asked whether others are needed, and the share of their promise from which
/// another one is.
const FIRST: usize = 2;
const COMPARABLE: f64 = 0.1;
/// Share of what would bring a set that lags to the front which a candidate beside it must promise.
pub(super) const CATCHES_UP: f64 = 0.05;
/// Effects that are looked at again beside sets that are not the best: those that promised most beside one that was.
const AGAIN: usize = 8;

impl Search<'_> {
    /// Sets with one effect more.
    pub(super) fn grow(&mut self, climb: &mut Climb) {
        let size = climb.nodes.len();
        let mut next: Vec<(Node, Difference)> = Vec::new();
        let mut least = None;
        // The best child of the best set.
        let mut front: Option<Node> = None;
        for (place, from) in climb.beam.iter().enumerate() {
            let lag = front.as_ref().map(|front| self.comparison.compare(from, front).nats);
            let (children, screened) = self.expand(&climb.base, from, size, lag);
            // The base model in another valley is another start and no model to be better than.
            let from = if size == 1 { &climb.base } else { from };
            // Chance is asked beside the best set, and once beside the base.
            let beside = match (place, size) {
                (0, _) => Some(&screened),
                (_, 1) => climb.screened.first().map(|(_, beside)| beside),
                _ => None,
            };
            if let Some(beside) = beside {
                let gains = children.iter().map(|child| self.comparison.compare(from, child));
                let each = gains.map(|gain| self.p_value(beside, gain));
                least = least.into_iter().chain(each).reduce(f64::min);
            }
            if place == 0 {
                let best = children.iter().min_by(|a, b| a.deviation.total_cmp(&b.deviation));
                front = Some(best.unwrap_or(from).clone());
                if !screened.promises.is_empty() {
                    climb.screened.push((from.clone(), screened.clone()));
                }
                climb.ranking.push(self.ranked(from, &children, screened));
            }
            for child in children {
                let (gain, refusal) = self.asked(&climb.base, from, &child, size);
                let gains = gain.nats > self.thresholds.better;
                if let Some(refusal) = refusal {
                    if gains {
                        if size == 1 {
                            self.tell_refused(&climb.base, &child, &refusal);
                        }
                        climb.refused.push((child, refusal));
                    }
                    continue;
                }
                let effects = self.names(&child);
                let nats = self.in_full(gain.nats);
                (self.tell)(&Event::Compared { rung: size, effects: &effects, nats });
                if !gains {
                    continue;
                }
                let same = |(other, _): &(Node, Difference)| self.key(other) == self.key(&child);
                match next.iter().position(same) {
                    Some(k) if self.is_better_form(&next[k].0, &child) => {
                        next[k] = (child, gain);
                    }
                    Some(_) => {}
                    None => next.push((child, gain)),
                }
            }
        }
        let ranked = self.sorted(next.into_iter().map(|(node, _)| node).collect());
        // A size that was cut short says nothing: the best of it may not have been fitted. Nor does one where chance
        // gains as much as the best.
        let by_chance = least.is_some_and(|p| p > HOPELESS);
        if ranked.is_empty() || by_chance || (self.stop)() || self.thresholds.most == 0 {
            if (self.stop)() && size == 1 {
                // Of none of them anything can be said.
                let open = self.candidates.iter();
                let open = open.filter(|term| self.family.joins(&climb.base.model, **term));
                self.untried.extend(open);
            }
            climb.ended = true;
            return;
        }
        // Inside the budget rivals need no extension.
        let width = if self.budget(&ranked[0]) < INSIDE { 1 } else { self.thresholds.beam };
        // A smaller set that predicts better was extended by every effect: none promised to do as much.
        let smaller = climb.nodes.iter().filter_map(|sets| sets.first()).cloned();
        let smaller = self.sorted(smaller.collect());
        let loses = |set: &Node| self.comparison.compare(set, &smaller[0]).nats;
        let goes_on = |set: &&Node| loses(set) <= self.thresholds.better.abs();
        climb.beam = ranked.iter().take(width).filter(goes_on).cloned().collect();
        climb.ended = climb.beam.is_empty();
        climb.nodes.push(ranked);
    }

    /// What a set of `size` effects that was fitted gains, and why it is refused, if so: noted as asked against another one.
    pub(super) fn asked(
        &mut self,
        base: &Node,
        from: &Node,
        child: &Node,
        size: usize,
    ) -> (Difference, Option<Refusal>) {
        let gain = self.comparison.compare(from, child);
        let refusal = refused(self.family, self.ahead, base, child).map(|(_, refusal)| refusal);
        let gains = gain.nats > self.thresholds.better;
        let because = refusal.clone().map(|refusal| Reason::Refused { refusal });
        let outcome = match because {
            Some(_) => Outcome::NotIdentifiable,
            None if gains => Outcome::AsGood,
            None => Outcome::TooLittle,
        };
        self.note(size, child, from, gain, outcome, because);
        (gain, refusal)
    }

    /// Tells that an effect is none: once, beside whichever base model.
    fn tell_refused(&mut self, base: &Node, child: &Node, refusal: &Refusal) {
        let mut added = child.effects(self.family);
        added.retain(|term| !base.model.terms.contains(term));
        let effects = self.named(&added);
        let is_it = |told: &Remark| matches!(told, Remark::NotNamed { effects: told, .. } if *told == effects);
        if !self.remarks.iter().any(is_it) {
            self.remarks.push(Remark::NotNamed { effects, refusal: refusal.clone() });
        }
    }

    /// A set with one effect more: the most promising ones, fitted, each in the form that is best. A set that is not the
    /// best has a `lag` behind the front, nats.
    pub(super) fn expand(
        &mut self,
        base: &Node,
        from: &Node,
        size: usize,
        lag: Option<f64>,
    ) -> (Vec<Node>, Screened) {
        let first = lag.is_none();
        let open: Vec<usize> = self
            .candidates
            .iter()
            .copied()
            .filter(|&term| self.family.joins(&from.model, term))
            .filter(|&term| first || self.promised.contains(&self.main(term)))
            .collect();
        if (self.stop)() {
            self.untried.extend(open);
            return (Vec::new(), Screened::default());
        }
        (self.tell)(&Event::Screening { rung: size, candidates: open.len() });
        let screened = screen(self.family, self.ahead, from, &open, first);
        if first {
            self.promised.append(&mut self.leading(&screened.promises));
        }
        // The first order seldom promises less than half of what a fit gains.
        let least = if size == 1 {
            self.promising()
        } else {
            0.5 * self.thresholds.clear(self.comparison.compare(base, from).nats)
        };
        let least = least.max(CATCHES_UP * lag.unwrap_or(0.0));
        let most = if size == 1 {
            self.thresholds.fitted
        } else {
            self.thresholds.fitted.min(self.thresholds.beam)
        };
        let starts = self.chosen(&screened.promises, least, most);
        let begin = |promises: &[&Promise]| -> Vec<(usize, Option<Node>)> {
            promises.par_iter().map(|p| (p.term, self.begun(p, from.setting))).collect()
        };
        // Where one of the first leaves no more than the sensors make, only those that promise as much are needed.
        let (first, others) = starts.split_at(FIRST.min(starts.len()));
        let mut fitted = begin(first);
        let inside =
            fitted.iter().flat_map(|(_, node)| node).any(|node| self.budget(node) < INSIDE);
        let top = starts.first().map_or(0.0, |promise| promise.gain);
        if inside {
            let needed = others.iter().copied().filter(|p| p.gain >= COMPARABLE * top);
            fitted.extend(begin(&needed.collect::<Vec<_>>()));
        } else {
            let raced = self.raced(first, &screened.promises, (from.setting, least), most);
            fitted.extend(begin(&raced.iter().collect::<Vec<_>>()));
        }
        self.untried
            .extend(fitted.iter().filter(|(_, node)| node.is_none()).map(|(term, _)| *term));
        let mut fitted: Vec<Node> = fitted.into_iter().filter_map(|(_, node)| node).collect();
        fitted.sort_by(|a, b| a.deviation.total_cmp(&b.deviation));
        let keep = if size == 1 { self.thresholds.fitted } else { self.thresholds.beam };
        fitted.truncate(keep);
        let settle = |node: Node| {
            let settled = self.fitter().settled(node, STEPS.1);
            if !from.is_held() {
                return settled;
            }
            // The mass is free again, and its valley as far away as that of a base model may be.
            let far = self.base_in_time(settled.model.clone());
            if far.deviation < settled.deviation { far } else { settled }
        };
        let mut settled: Vec<Node> = fitted.into_par_iter().map(settle).collect();
        let best = settled.iter().map(|node| node.deviation).fold(f64::INFINITY, f64::min);
        settled = settled
            .into_par_iter()
            .map(|node| if node.deviation <= NEAR * best { self.rescanned(&node) } else { node })
            .collect();
        let near = settled.iter().filter(|node| node.deviation <= NEAR * best);
        let related = self.related(&near.collect::<Vec<_>>());
        settled.extend(related);
        settled.sort_by(|a, b| a.deviation.total_cmp(&b.deviation));
        let beam = self.thresholds.beam;
        let shaped = settled.into_par_iter().enumerate();
        let shaped = shaped
            .map(|(place, node)| if size == 1 || place < beam { self.shaped(&node) } else { node });
        (shaped.collect(), screened)
    }

    /// Sets that differ from these by one effect and begin from their fits.
    pub(super) fn related(&self, sets: &[&Node]) -> Vec<Node> {
        let known =
            |model: &Fitted| model.terms.last().is_some_and(|term| self.candidates.contains(term));
        let related = |node: &&Node| -> Vec<(Fitted, usize)> {
            let related = self.ahead.relatives(&node.model).into_iter();
            related.filter(known).map(|model| (model, node.setting)).collect()
        };
        let starts: Vec<_> = sets.iter().flat_map(related).collect();
        starts.into_par_iter().map(|(start, setting)| self.gone_far(&start, setting)).collect()
    }

    /// Whether another form of the same effects predicts better, one of more parameters by more than a form must gain.
    fn is_better_form(&self, form: &Node, other: &Node) -> bool {
        let needed = match other.model.values.len().cmp(&form.model.values.len()) {
            Ordering::Less => -FORM,
            Ordering::Equal => 0.0,
            Ordering::Greater => FORM,
        };
        self.comparison.compare(form, other).nats > needed
    }

    /// What a candidate must promise to be fitted where the first order errs most, nats.
    pub(super) fn promising(&self) -> f64 {
        (PROMISING.0 * self.thresholds.better).clamp(PROMISING.1, PROMISING.2)
    }

    /// The effects that promise most: those that are looked at again.
    pub(super) fn leading(&self, promises: &[Promise]) -> BTreeSet<usize> {
        let mut best = BTreeSet::new();
        for promise in promises {
            if best.len() < AGAIN {
                best.insert(self.main(promise.term));
            }
        }
        best
    }

    /// What is fitted: promises above `least`, of `most` effects, and of each at most two forms, so that one effect does
    /// not take all places.
    pub(super) fn chosen<'p>(
        &self,
        promises: &'p [Promise],
        least: f64,
        most: usize,
    ) -> Vec<&'p Promise> {
        let mut mains: Vec<usize> = Vec::new();
        let mut starts: Vec<&Promise> = Vec::new();
        for promise in promises.iter().filter(|promise| promise.gain > least) {
            let main = self.main(promise.term);
            let forms = mains.iter().filter(|other| **other == main).count();
            let distinct = mains.iter().collect::<BTreeSet<_>>().len();
            if forms >= 2 || (forms == 0 && distinct >= most) {
                continue;
            }
            mains.push(main);
            starts.push(promise);
        }
        starts
    }

    /// Candidates of a rung with what they gain: fitted ones by comparison, the others as promised.
    pub(super) fn ranked(&self, from: &Node, children: &[Node], screened: Screened) -> Ranked {
        let mut rows: Vec<Row> = Vec::new();
        for promise in screened.promises {
            let main = self.main(promise.term);
            if rows.iter().any(|row| self.main(row.term) == main) {
                continue;
            }
            let by_chance = screened.chance.p_value(self.in_full(promise.gain));
            let has =
                |node: &&Node| node.effects(self.family).iter().any(|t| self.main(*t) == main);
            let fitted = children.iter().find(has);
            let row = fitted.map(|node| {
                let term = node.effects(self.family).into_iter().find(|t| self.main(*t) == main);
                let gain = self.comparison.compare(from, node).nats;
                (term.unwrap_or(promise.term), node.model.clone(), gain)
            });
            let start = promise.starts.into_iter().next().unwrap_or_default();
            let (term, model, gain) = row.unwrap_or((promise.term, start, promise.gain));
            let nats = self.in_full(gain);
            let p_value = by_chance.max(screened.chance.p_value(nats));
            rows.push(Row { term, model, nats, p_value });
        }
        rows.sort_by(|a, b| b.nats.total_cmp(&a.nats));
        Ranked {
            rows,
            chance: screened.chance,
            points: self.in_full(from.errors.len() as f64 / from.correlation()),
        }
    }
}
