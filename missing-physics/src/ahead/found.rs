//! What a search found, brought to all of the recording and judged.

use super::chance::Chance;
use super::compare::{Comparison, Difference};
use super::decision::Decision;
use super::fit::{self, Fitter};
use super::node::Node;
use super::screen::Promise;
use super::thresholds::Thresholds;
use super::{Ahead, local};
use crate::family::{Fitted, ModelFamily};

/// Steps of a refit on all of a recording that was searched in part.
const IN_FULL: usize = 8;

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
    /// Chance of a gain as large as what the last model would lose without it, for each effect.
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
    /// The last model and its number of effects.
    pub fn top(&self) -> (&Node, usize) {
        (self.rungs.last().unwrap_or(&self.base), self.added.len())
    }

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
            Fitter::new(family, ahead).fit(node.model.clone(), setting, IN_FULL)
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

    /// Takes all names back where what is left is in a few wild samples, or where samples are known to be faulty: that is
    /// no business of any effect.
    pub fn judge<F: ModelFamily + ?Sized>(
        &mut self,
        family: &F,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let Some(top) = self.rungs.last().filter(|_| !self.complete) else { return };
        if local::faults(&top.errors).is_none() && ahead.faults().is_none() {
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
    pub fn is_in<F: ModelFamily + ?Sized>(terms: &[usize], term: usize, family: &F) -> bool {
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
    pub chance: Chance,
    /// Number of errors that say as much as independent ones.
    pub points: f64,
}
