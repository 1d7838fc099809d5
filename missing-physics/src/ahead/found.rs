//! What a search found, brought to all of the recording and judged.

use rayon::prelude::*;

use super::astray::astray;
use super::chance::Chance;
use super::compare::{Comparison, Difference};
use super::fit::{self, Fitter};
use super::node::Node;
use super::refused::{refused, unknown};
use super::screen::Promise;
use super::{Ahead, local};
use crate::family::{Fitted, ModelFamily};
use crate::report::{Decision, Lacking, NoCause, Refusal, Remains, Remark};
use crate::statistics::basis::dot;
use crate::task::Thresholds;

/// Steps of a refit on all of a recording that was searched in part.
pub const IN_FULL: usize = 8;
/// Share of the squared force that a model lacks which effects may leave and still be its cause: the smaller part.
const MOST: f64 = 0.5;
/// The same where the base model hardly errs more than the sensors: there the force is all that tells.
pub const MOST_WITHIN: f64 = 0.05;
/// Share of what the base model errs beyond the sensors, squared, and of the force that it lacks, that a model leaves at most:
/// what leaves more is not what is missing.
const LEFT: f64 = 0.88;

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
    /// Sets of added terms by their number, and how far each lies behind the best of it, nats.
    pub sets: Vec<Vec<(Vec<usize>, f64)>>,
    /// Sets that differ by less than this are alike, nats: what an effect must gain, or the most that anything gains
    /// beside what is named without being named, where that is more. What is wrong with one model may gain that, too.
    pub alike: f64,
    /// Candidates beside the best set of each size.
    pub ranking: Vec<Ranked>,
    /// Chance of a gain as large as what the last model would lose without it, for each effect.
    pub p_values: Vec<f64>,
    /// What any candidate gains beside the last model where the errors are shifted in time.
    pub chance: Chance,
    /// The candidates beside the last model, to first order.
    pub last_screening: Vec<Promise>,
    /// What stands for no effect, but does what effects would do.
    pub rival: Option<Remains>,
    /// Whether the last model leaves no more than the sensors make.
    pub complete: bool,
    /// Where what is left lies, the largest first.
    pub places: Vec<Remains>,
    /// What a user should know besides.
    pub remarks: Vec<Remark>,
    /// Every comparison.
    pub decisions: Vec<Decision>,
    /// Terms that were not tried because time ran out.
    pub untried: Vec<usize>,
    /// Whether the search was cut short.
    pub stopped: bool,
}

impl Found {
    /// Nothing beside the base model, nothing compared.
    #[cfg(test)]
    pub fn of(base: Node) -> Self {
        Self {
            base,
            rungs: Vec::new(),
            added: Vec::new(),
            gains: Vec::new(),
            costs: Vec::new(),
            sets: Vec::new(),
            alike: 0.0,
            ranking: Vec::new(),
            p_values: Vec::new(),
            chance: Chance::default(),
            last_screening: Vec::new(),
            rival: None,
            complete: false,
            places: Vec::new(),
            remarks: Vec::new(),
            decisions: Vec::new(),
            untried: Vec::new(),
            stopped: false,
        }
    }

    /// The last model and its number of effects.
    pub fn top(&self) -> (&Node, usize) {
        (self.rungs.last().unwrap_or(&self.base), self.added.len())
    }

    /// Brings what was found on a part to all of the recording: every rung is refitted there, and what gains too little
    /// or no more than chance, or lowers no error beside others, goes. Nothing where it is told to stop before that is done.
    pub fn confirmed<F: ModelFamily + ?Sized>(
        mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Option<Self> {
        if stop() {
            return None;
        }
        let comparison = Comparison::new(family, ahead);
        let fitter = Fitter::new(family, ahead).stopped_by(stop);
        let whole = |model: &Fitted| {
            let setting = fit::best_setting(ahead, model);
            fitter.fit(model.clone(), setting, IN_FULL)
        };
        let main = |t: usize| family.form_of(t).unwrap_or(t);
        let without = |node: &Node, term: usize| {
            let form = node.model.terms.iter().find(|t| main(**t) == main(term));
            form.map(|form| whole(&node.model.without(family, *form)))
        };
        self.base = whole(&self.base.model);
        self.rungs = self.rungs.par_iter().map(|rung| whole(&rung.model)).collect();
        // With a term more a model can do no worse: a part leads astray where it does not reach.
        for k in 0..self.rungs.len() {
            let below = k.checked_sub(1).map_or(&self.base, |k| &self.rungs[k]);
            let rung = &self.rungs[k];
            if rung.foretells_more(below) {
                continue;
            }
            let form = rung.model.terms.iter().position(|t| main(*t) == main(self.added[k]));
            let Some(form) = form else { continue };
            let values = &rung.model.values[rung.model.range(family, form)];
            // Each at the setting that suits it: else the one that was looked for longer gains by that.
            let below = fitter.settled(below.clone(), IN_FULL);
            let start = below.model.with(rung.model.terms[form], values);
            let again = fitter.refit(start, below.setting, IN_FULL);
            if again.foretells_more(rung) {
                *k.checked_sub(1).map_or(&mut self.base, |k| &mut self.rungs[k]) = below;
                self.rungs[k] = again;
            }
        }
        while let Some(top) = self.rungs.last() {
            if stop() {
                return None;
            }
            // All of the recording may take an effect to where it is none.
            let place = |term: usize| self.added.iter().position(|t| main(*t) == main(term));
            let refused = refused(family, ahead, &self.base, top);
            let mut goes = refused.and_then(|(term, refusal)| Some((place(term)?, Some(refusal))));
            if goes.is_none() {
                let last = self.added.len() - 1;
                let below = last.checked_sub(1).map_or(&self.base, |k| &self.rungs[k]);
                let costs = self.added.par_iter().enumerate().map(|(k, term)| {
                    let without = if k == last { None } else { without(top, *term) };
                    let without = without.as_ref().unwrap_or(below);
                    // A single effect with which no error falls has a remark of its own.
                    (comparison.compare(without, top), last == 0 || top.foretells_more(without))
                });
                let (costs, lowers): (Vec<_>, Vec<_>) = costs.unzip();
                self.p_values = costs.iter().map(|c| self.chance.p_value(c.nats)).collect();
                self.costs = costs;
                let each = self.costs.iter().zip(&self.p_values).enumerate();
                let idle = each.filter(|(k, (cost, p))| {
                    cost.nats < thresholds.better || **p > thresholds.chance || !lowers[*k]
                });
                let least = idle.min_by(|a, b| a.1.0.nats.total_cmp(&b.1.0.nats));
                goes = least.map(|(place, _)| (place, None));
                goes = goes.or_else(|| {
                    let (term, refusal) = unknown(family, ahead, &self.base, top)?;
                    Some((place(term)?, Some(refusal)))
                });
            }
            let Some((idle, refusal)) = goes else { break };
            let term = self.added.remove(idle);
            self.alike = self.alike.max(self.costs.get(idle).map_or(0.0, |cost| cost.nats));
            let effect = family.terms()[term].name.clone();
            if self.added.is_empty()
                && let Some(refusal @ Refusal::Unknown { .. }) = &refusal
            {
                // Something is missing all the same.
                let nats = comparison.compare(&self.base, top).nats;
                let by = vec![effect.clone()];
                let refusal = refusal.clone();
                let outdone = Remains::Outdone { by, refusal, instead_of: Vec::new(), nats };
                self.rival.get_or_insert(outdone);
            }
            self.remarks.push(match refusal {
                Some(refusal) => Remark::NotNamed { effects: vec![effect], refusal },
                None => Remark::FoundInPartOnly { effect },
            });
            let mut rungs = std::mem::take(&mut self.rungs);
            let above = rungs.split_off(idle + 1);
            rungs.pop();
            rungs.extend(
                above.par_iter().filter_map(|rung| without(rung, term)).collect::<Vec<_>>(),
            );
            self.rungs = rungs;
        }
        if self.rungs.is_empty() {
            self.costs.clear();
            self.p_values.clear();
        }
        let before = std::iter::once(&self.base).chain(&self.rungs);
        self.gains = before.zip(&self.rungs).map(|(a, b)| comparison.compare(a, b)).collect();
        if thresholds.most == 0 {
            // Nothing is to be added: what candidates gain is all that is told.
            let fitted = |start: &Fitted| {
                let node = whole(start);
                let nats = comparison.compare(&self.base, &node).nats;
                (node.model, nats)
            };
            let gain = |term: usize, model: &Fitted| {
                let found = fitted(model);
                let place = model.terms.iter().position(|other| *other == term);
                let Some(place) = place.filter(|_| found.1 < 0.0) else { return found };
                // A part led to another valley: with a term more a model can do no worse.
                let values = &model.values[model.range(family, place)];
                let again = fitted(&self.base.model.with(term, values));
                if again.1 > found.1 { again } else { found }
            };
            if let Some(ranked) = self.ranking.first_mut() {
                ranked.ask(thresholds.better, gain);
            }
        }
        // What was cut short is no fit.
        if stop() {
            return None;
        }
        self.place(family, ahead, thresholds);
        Some(self)
    }

    /// What was found on a `share` of the recording, where time ran out before all of it was asked: gains are those that
    /// they stand for on all of it.
    #[must_use]
    pub fn unconfirmed(mut self, share: f64) -> Self {
        for difference in self.gains.iter_mut().chain(&mut self.costs) {
            difference.nats /= share;
            difference.error /= share;
        }
        self.stopped = true;
        self.remarks.push(Remark::Unconfirmed { share });
        self
    }

    /// Where the last model fails, and whether it does at all.
    pub fn place<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let top = self.rungs.last().unwrap_or(&self.base);
        self.places = left_by(top, family, ahead, thresholds);
        self.places.splice(0..0, self.rival.clone());
        self.complete = top.scale / ahead.budget() <= thresholds.complete && self.places.is_empty();
    }

    /// Takes all names back where they are not the cause: the error does not fall with them, what is left is in a few wild
    /// samples, samples are known to be faulty, the greater part of the force that the base model lacks is still lacking
    /// beyond doubt, or what is no effect does more.
    pub fn judge<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let Some(top) = self.rungs.last() else { return };
        let astray = self.places.iter().find_map(|place| match place {
            Remains::Astray { astray } => Some(NoCause::Astray { astray: astray.clone() }),
            _ => None,
        });
        let no_cause = ahead.is_no_cause(&self.base.model, &top.model).or(astray);
        // Below what the sensors make there are no shares.
        let beyond = ahead.has_shares() && top.scale > ahead.budget();
        let within = top.scale <= thresholds.complete * ahead.budget();
        let idle = beyond && leaves_most(&self.base, top, ahead.budget())
            || self.leaves_force(ahead, if within { thresholds.local } else { 0.0 });
        let falls = top.foretells_more(&self.base) && !idle;
        if self.complete && falls && no_cause.is_none() {
            return;
        }
        let still = self.still_lacking(family, ahead, (thresholds.local, MOST));
        // A few wild samples that are left speak against what explains less than they are.
        let square = |node: &Node| dot(&node.errors, &node.errors);
        let explained = square(&self.base) - square(top);
        let wild = local::faults(&top.errors).map(|share| share * square(top));
        let faulty = wild.is_some_and(|wild| wild > explained) || ahead.faults().is_some();
        if falls && still.is_none() && !faulty && no_cause.is_none() {
            return;
        }
        let lacking = still.map(|(lacking, _)| lacking);
        self.taken_back(family, ahead, thresholds, (lacking, no_cause));
    }

    /// Takes all names back where the last model hardly errs more than the sensors, and some of the force that the base lacks
    /// is still lacking beyond doubt: where errors tell so little, what is there explains that force, and what only imitates
    /// it does so in part. What every system has is asked nothing.
    pub fn judge_force<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let within = self.top().0.scale / ahead.budget() <= thresholds.complete;
        if !within || self.added.iter().all(|term| family.is_usual(*term)) {
            return;
        }
        let still = self.still_lacking(family, ahead, (thresholds.complete, MOST_WITHIN));
        if let Some((lacking, band)) = still {
            let because = Some(NoCause::LeavesForce { band });
            self.taken_back(family, ahead, thresholds, (Some(lacking), because));
        }
    }

    /// Whether nearly all of the force that the base model lacks, of more than so many bands, is still lacking, however well
    /// that is known of the last model. Where errors are not those of the sensors an effect lowers them by following what no
    /// force stands behind: a command that changes between two samples.
    fn leaves_force(&self, ahead: &dyn Ahead, bands: f64) -> bool {
        let both = self.top().0.lacks(ahead).zip(self.base.lacks(ahead));
        both.is_some_and(|((last, _), (base, band))| {
            base > bands * band && last * last > LEFT * base * base
        })
    }

    /// The force that is lacking before and after, and its 95 % band, where the last model leaves more than so many bands and
    /// more than a share of the square.
    fn still_lacking<F: ModelFamily + ?Sized>(
        &self,
        family: &F,
        ahead: &dyn Ahead,
        (bands, share): (f64, f64),
    ) -> Option<(Lacking, f64)> {
        let ((last, band), (base, _)) = self.top().0.lacks(ahead).zip(self.base.lacks(ahead))?;
        let still = last > bands * band && last * last > share * base * base;
        still.then(|| (Lacking { base, last, unit: family.quantity().unit }, band))
    }

    fn taken_back<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
        (lacking, because): (Option<Lacking>, Option<NoCause>),
    ) {
        let names = self.added.iter().map(|term| family.terms()[*term].name.clone());
        self.remarks.push(Remark::NotTheCause {
            effects: names.collect(),
            base: self.base.scale / ahead.budget(),
            last: self.top().0.scale / ahead.budget(),
            lacking,
            because,
        });
        self.places = left_by(&self.base, family, ahead, thresholds);
        self.complete = false;
        self.rungs.clear();
        self.added.clear();
        self.gains.clear();
        self.costs.clear();
        self.p_values.clear();
    }

    /// Sets of added terms that cannot be told from the one that was found.
    pub fn as_good<F: ModelFamily + ?Sized>(&self, family: &F) -> Vec<&[usize]> {
        let sets = self.sets.get(self.added.len()).map_or(&[][..], Vec::as_slice);
        let is_it = |set: &[usize]| self.added.iter().all(|t| Self::is_in(set, *t, family));
        let Some((_, found)) = sets.iter().find(|(set, _)| is_it(set)) else { return Vec::new() };
        let others = sets.iter().filter(|(set, lag)| !is_it(set) && lag - found < self.alike);
        others.map(|(set, _)| set.as_slice()).collect()
    }

    /// Whether a term, in whatever form, is among `terms`.
    pub fn is_in<F: ModelFamily + ?Sized>(terms: &[usize], term: usize, family: &F) -> bool {
        let main = |t: usize| family.form_of(t).unwrap_or(t);
        terms.iter().any(|other| main(*other) == main(term))
    }
}

/// Whether a model leaves nearly all of what the base errs beyond the sensors.
pub fn leaves_most(base: &Node, node: &Node, budget: f64) -> bool {
    let beyond = |node: &Node| (node.scale / budget).powi(2) - 1.0;
    beyond(base) <= 0.0 || beyond(node) > LEFT * beyond(base)
}

/// What a model leaves, whether its errors show it or not.
fn left_by<F: ModelFamily + ?Sized>(
    node: &Node,
    family: &F,
    ahead: &dyn Ahead,
    thresholds: &Thresholds,
) -> Vec<Remains> {
    let shows = local::places(ahead, node, thresholds.local, &family.quantity().unit);
    let astray =
        astray(family, &node.model, ahead.has_shares()).map(|astray| Remains::Astray { astray });
    let hidden = ahead.remains(&node.model, thresholds.complete);
    astray.into_iter().chain(hidden).chain(shows).collect()
}

/// A candidate beside a model.
#[derive(Clone, Debug)]
pub struct Row {
    /// The term.
    pub term: usize,
    /// The model with it.
    pub model: Fitted,
    /// What it gains, nats.
    pub nats: f64,
    /// Chance of as much.
    pub p_value: f64,
}

/// Candidates beside one model.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The candidates, the best first.
    pub rows: Vec<Row>,
    /// What any candidate gains by chance, to first order.
    pub chance: Chance,
    /// Number of errors that say as much as independent ones.
    pub points: f64,
}

/// Candidates of which it must be known what they gain.
const ASKED: usize = 3;

impl Ranked {
    /// Replaces what the first candidates promise, as far as that is more than `least`, by what `gain` makes of them,
    /// until it is known of those that are first then.
    fn ask(&mut self, least: f64, gain: impl Fn(usize, &Fitted) -> (Fitted, f64)) {
        let mut asked = Vec::new();
        loop {
            let first = self.rows.iter_mut().take(ASKED);
            let mut open = first.filter(|row| row.nats > least && !asked.contains(&row.term));
            let Some(row) = open.next() else { break };
            asked.push(row.term);
            (row.model, row.nats) = gain(row.term, &row.model);
            row.p_value = row.p_value.max(self.chance.p_value(row.nats));
            self.rows.sort_by(|a, b| b.nats.total_cmp(&a.nats));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::ahead::testing::{BEAT, Plant, TONE, TWIN, WAVE};
    use crate::family::Series;
    use crate::report::Fault;

    /// A wave that was found where it is, every model lacking a force of 2 V known to `band`.
    fn found(lacks: Option<f64>) -> (Plant, Found) {
        let mut plant = Plant::new(1, &[(WAVE, &[0.05])]);
        plant.lacks = lacks.map(|band| Series {
            time: vec![0.0, 0.1],
            force: vec![2.0, -2.0],
            deviation: vec![band / 1.96; 2],
            recorded: vec![9.0; 2],
            known: vec![true; 2],
        });
        let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
        let (base, rung) = (node(&[]), node(&[(WAVE, &[0.05])]));
        let mut found = Found { added: vec![WAVE], rungs: vec![rung], ..Found::of(base) };
        found.place(&plant, &plant, &Thresholds::default());
        (plant, found)
    }

    #[test]
    fn names_go_where_the_force_that_is_lacking_is_still_lacking() {
        let (plant, mut found) = found(Some(0.5));
        assert!(!found.complete);
        assert_eq!(
            found.places[0],
            Remains::MissingForce { rms: 2.0, band: 0.5, unit: "V".into() }
        );
        found.judge(&plant, &plant, &Thresholds::default());
        assert!(found.added.is_empty() && found.rungs.is_empty() && !found.complete);
        let [Remark::NotTheCause { effects, base, last, lacking, because }] = &found.remarks[..]
        else {
            panic!("{:?}", found.remarks)
        };
        assert_eq!((effects.as_slice(), because), (&["wave".to_owned()][..], &None));
        assert!(base > last, "{base} {last}");
        assert_eq!(lacking, &Some(Lacking { base: 2.0, last: 2.0, unit: "V".into() }));
    }

    #[test]
    fn names_stand_where_that_force_is_not_known_or_nothing_is_left() {
        for lacks in [Some(1.5), None] {
            let (plant, mut found) = found(lacks);
            found.judge(&plant, &plant, &Thresholds::default());
            assert!(found.complete, "{:?}", found.places);
            assert_eq!((found.added.as_slice(), found.remarks.len()), (&[WAVE][..], 0));
        }
    }

    #[test]
    fn names_go_where_the_error_does_not_fall_with_them() {
        let (plant, mut found) = found(None);
        let smaller = found.rungs[0].errors.iter().map(|e| 0.99 * e).collect();
        let model = found.base.model.clone();
        found.base = Node::new(&plant, model, found.base.setting, smaller);
        assert!(found.complete);
        found.judge(&plant, &plant, &Thresholds::default());
        assert!(found.added.is_empty() && !found.complete);
        assert!(matches!(&found.remarks[..], [Remark::NotTheCause { lacking: None, .. }]));
    }

    #[test]
    fn names_go_where_an_incomplete_model_leaves_nearly_all_of_a_force_that_is_in_doubt() {
        // Of a model that errs no more than the sensors where the base lacks it beyond doubt.
        let cases = [
            (1.9, 0.5, 3.0, false),
            (1.85, 0.5, 3.0, true),
            (1.9, 1.3, 3.0, true),
            (1.9, 1.3, 0.9, false),
            (1.85, 1.3, 0.9, true),
        ];
        for (left, complete, band, stays) in cases {
            let (plant, mut found) = found(Some(3.0));
            let lacks = |rms: f64, band: f64| Series {
                force: vec![rms, -rms],
                deviation: vec![band / 1.96; 2],
                ..plant.lacks.clone().unwrap()
            };
            found.base = found.base.lacking(lacks(2.0, band));
            found.rungs[0] = found.rungs[0].clone().lacking(lacks(left, 3.0));
            found.complete = complete >= 1.0;
            found.judge(&plant, &plant, &Thresholds { complete, ..Thresholds::default() });
            assert_eq!(!found.added.is_empty(), stays, "{left} {complete} {band}");
        }
    }

    #[test]
    fn names_go_where_an_incomplete_model_leaves_nearly_all_that_the_base_errs() {
        for (last, stays) in [(1.25, true), (1.28, false)] {
            let (plant, mut found) = found(None);
            let scaled = |node: &Node, times: f64| {
                let factor = times * plant.budget() / node.scale;
                let errors = node.errors.iter().map(|e| factor * e).collect();
                Node::new(&plant, node.model.clone(), node.setting, errors)
            };
            found.base = scaled(&found.base, 1.29);
            found.rungs = vec![scaled(&found.rungs[0], last)];
            found.complete = false;
            found.judge(&plant, &plant, &Thresholds::default());
            assert_eq!(!found.added.is_empty(), stays, "{last}: {:?}", found.remarks);
        }
    }

    #[test]
    fn names_go_and_nothing_is_complete_where_what_every_model_has_is_astray() {
        let (plant, mut found) = found(None);
        for node in std::iter::once(&mut found.base).chain(&mut found.rungs) {
            node.model.values[0] = 5.0;
        }
        found.place(&plant, &plant, &Thresholds::default());
        assert!(matches!(&found.places[..], [Remains::Astray { .. }]) && !found.complete);
        found.judge(&plant, &plant, &Thresholds::default());
        let because = |remark: &Remark| match remark {
            Remark::NotTheCause { because: Some(NoCause::Astray { astray }), .. } => astray.value,
            _ => 0.0,
        };
        assert_eq!((found.added.len(), because(&found.remarks[0])), (0, 5.0));
        assert!(matches!(&found.places[..], [Remains::Astray { .. }, ..]));
    }

    #[test]
    fn names_go_where_nearly_all_of_what_is_missing_is_left() {
        // The tone is not found.
        let stands = |tone: f64, wave: f64| {
            let plant = Plant::new(3, &[(TONE, &[tone, 5.0]), (WAVE, &[wave])]);
            let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
            let (base, rung) = (node(&[]), node(&[(WAVE, &[wave])]));
            let mut found = Found { added: vec![WAVE], rungs: vec![rung], ..Found::of(base) };
            found.judge(&plant, &plant, &Thresholds::default());
            !found.added.is_empty()
        };
        assert!(!stands(0.1, 0.02));
        // More than a tenth of it, and all of it.
        assert!(stands(0.1, 0.1) && stands(0.0, 0.02));
    }

    #[test]
    fn names_go_where_what_is_left_is_in_a_few_wild_samples() {
        let (plant, found) = found(None);
        let square = |node: &Node| dot(&node.errors, &node.errors);
        let explained = square(&found.base) - square(found.top().0);
        // A third of what the wave explains is left in one sample, or all of it.
        for (wild, stands) in [(explained / 3.0, true), (explained, false)] {
            let mut found = found.clone();
            let top = found.rungs.pop().unwrap();
            let mut errors = top.errors.clone();
            errors[700] = wild.sqrt();
            found.rungs.push(Node::new(&plant, top.model.clone(), top.setting, errors));
            found.place(&plant, &plant, &Thresholds::default());
            let isolated = |remains: &Remains| matches!(remains, Remains::Faulty { fault: Fault::Isolated { share } } if *share > 0.5);
            assert!(found.places.iter().any(isolated), "{:?}", found.places);
            found.judge(&plant, &plant, &Thresholds::default());
            assert_eq!(!found.added.is_empty(), stands);
            let taken_back =
                matches!(&found.remarks[..], [Remark::NotTheCause { lacking: None, .. }]);
            assert_eq!(taken_back, !stands);
        }
    }

    #[test]
    fn what_gains_too_little_on_all_of_the_recording_is_taken_back_from_wherever_it_stood() {
        // The part had a beat that the whole does not have; it stands below the wave.
        let whole = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let rungs = vec![node(&[(BEAT, &[0.03])]), node(&[(BEAT, &[0.03]), (WAVE, &[0.05])])];
        let found = Found { added: vec![BEAT, WAVE], rungs, ..Found::of(node(&[])) };
        // Nothing is known of chance here.
        let thresholds = Thresholds { better: 20.0, chance: 1.0, ..Thresholds::default() };
        let found = found.confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        assert_eq!(found.added, [WAVE]);
        assert_eq!(found.rungs.len(), 1);
        assert!(!found.rungs[0].model.terms.contains(&BEAT));
        assert_eq!(found.remarks, [Remark::FoundInPartOnly { effect: "beat".into() }]);
        assert!(found.gains[0].nats > 20.0 && found.complete);
    }

    #[test]
    fn where_nothing_is_to_be_added_candidates_are_told_by_what_they_gain_on_all_of_the_recording()
    {
        let whole = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let row = |terms: &[(usize, &[f64])], nats| {
            let (term, model) = (terms[0].0, Plant::model(terms));
            Row { term, model, nats, p_value: 0.01 }
        };
        // What a part promised.
        let rows = vec![row(&[(BEAT, &[0.03])], 700.0), row(&[(WAVE, &[0.05])], 600.0)];
        let ranking = vec![Ranked { rows, chance: Chance::default(), points: 1000.0 }];
        let found = Found { ranking, ..Found::of(node(&[])) };
        let thresholds = Thresholds { most: 0, better: 20.0, ..Thresholds::default() };
        let told = found.clone().confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        let [first, second] = &told.ranking[0].rows[..] else { panic!() };
        assert_eq!((first.term, second.term), (WAVE, BEAT));
        assert!(first.nats > 1000.0 && second.nats < 20.0, "{first:?} {second:?}");
        // A search that adds tells of its rungs.
        let thresholds = Thresholds { most: 1, ..thresholds };
        let told = found.confirmed(&whole, &whole, &thresholds, &|| false).unwrap();
        assert_eq!(told.ranking[0].rows[0].nats, 700.0);
    }

    #[test]
    fn what_all_of_the_recording_takes_to_where_it_is_none_is_not_named() {
        let mut whole = Plant::new(1, &[(WAVE, &[0.05])]);
        whole.none = Some(WAVE);
        let node = |terms| fit::evaluated(&whole, Plant::model(terms), 0);
        let rungs = vec![node(&[(WAVE, &[0.05])])];
        let found = Found { added: vec![WAVE], rungs, ..Found::of(node(&[])) };
        let found = found.confirmed(&whole, &whole, &Thresholds::default(), &|| false).unwrap();
        assert!(found.added.is_empty() && found.rungs.is_empty());
        let [Remark::NotNamed { effects, .. }] = &found.remarks[..] else {
            panic!("{:?}", found.remarks)
        };
        assert_eq!(effects, &["wave"]);
    }

    #[test]
    fn what_time_does_not_allow_to_be_asked_of_all_of_the_recording_is_told_as_such() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
        let gain = Difference { nats: 30.0, error: 3.0, ranks: 2.0 };
        let on_part = || Found {
            added: vec![WAVE],
            rungs: vec![node(&[(WAVE, &[0.05])])],
            gains: vec![gain],
            costs: vec![gain],
            ..Found::of(node(&[]))
        };
        // Told to stop at once, and after some steps.
        for after in [0, 3] {
            let asked = AtomicUsize::new(0);
            let stop = || asked.fetch_add(1, Ordering::Relaxed) >= after;
            let cut = on_part().confirmed(&plant, &plant, &Thresholds::default(), &stop);
            assert!(cut.is_none(), "{after}");
        }
        let told = on_part().unconfirmed(0.25);
        assert_eq!((told.added.as_slice(), told.stopped), (&[WAVE][..], true));
        assert_eq!(told.gains, [Difference { nats: 120.0, error: 12.0, ranks: 2.0 }]);
        assert_eq!(told.costs, told.gains);
        assert_eq!(told.remarks, [Remark::Unconfirmed { share: 0.25 }]);
    }

    #[test]
    fn names_go_where_errors_within_the_sensors_hide_a_force_that_is_still_lacking() {
        // Every model lacks 2 V; as large as the base's errors are, the sensors' are taken to be.
        let told = |complete: f64, band: f64, usual: Vec<usize>| {
            let (mut plant, mut found) = found(Some(band));
            plant.usual = usual;
            let thresholds = Thresholds { complete, ..Thresholds::default() };
            found.judge_force(&plant, &plant, &thresholds);
            (found.added, found.remarks)
        };
        let (added, remarks) = told(30.0, 0.06, Vec::new());
        assert!(added.is_empty());
        let [Remark::NotTheCause { lacking, because, .. }] = &remarks[..] else { panic!() };
        assert_eq!(lacking, &Some(Lacking { base: 2.0, last: 2.0, unit: "V".into() }));
        let Some(NoCause::LeavesForce { band }) = because else { panic!("{because:?}") };
        assert!((band - 0.06).abs() < 1e-9);
        // So they do where the base errs more.
        assert!(told(1.3, 0.06, Vec::new()).0.is_empty());
        // Where that is in doubt, where errors tell more, of what every system has, and where little is left of it.
        assert_eq!(told(30.0, 0.07, Vec::new()).0, [WAVE]);
        assert_eq!(told(0.5, 0.06, Vec::new()).0, [WAVE]);
        assert_eq!(told(30.0, 0.06, vec![WAVE]).0, [WAVE]);
        for (left, names) in [(0.4, 1), (0.5, 0)] {
            let (plant, mut found) = found(Some(0.01));
            let lacks =
                |rms: f64| Series { force: vec![rms, -rms], ..plant.lacks.clone().unwrap() };
            found.base = found.base.lacking(lacks(2.0));
            found.rungs[0] = found.rungs[0].clone().lacking(lacks(left));
            found.judge_force(
                &plant,
                &plant,
                &Thresholds { complete: 30.0, ..Thresholds::default() },
            );
            assert_eq!(found.added.len(), names, "{left}");
        }
    }

    #[test]
    fn sets_are_told_apart_by_more_than_what_gains_as_much_without_a_name() {
        let (plant, found) = found(None);
        let sets = vec![Vec::new(), vec![(vec![TWIN], 0.0), (vec![WAVE], 5.0), (vec![BEAT], 45.0)]];
        let as_good = |alike: f64| {
            let found = Found { sets: sets.clone(), alike, ..found.clone() };
            found.as_good(&plant).concat()
        };
        assert_eq!(as_good(20.0), [TWIN]);
        assert_eq!(as_good(39.0), [TWIN]);
        assert_eq!(as_good(41.0), [TWIN, BEAT]);
    }
}
