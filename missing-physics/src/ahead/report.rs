//! A search as a [`Discovery`]: ladder, ranking, verdict.

use std::collections::BTreeMap;

use super::compare::Difference;
use super::found::{Found, Ranked};
use super::node::Node;
use super::{Ahead, intervals};
use crate::diagnosis::where_it_fails::{self, Look};
use crate::diagnosis::{self, generic, noise};
use crate::family::{Fitted, ModelFamily, detection_limit, on_view, sizes};
use crate::fit::{self, Fit};
use crate::report::{
    Ambiguity, Budget, Candidate, Decision, DetectionLimit, Discovery, MissingForce, NamedValue,
    Reason, RegimeShare, Remark, Rung, SplitMetrics, Verdict, floor_key,
};
use crate::statistics::split::Split;
use crate::statistics::weights;
use crate::task::Settings;

/// A model that errs less than this share of what the sensors make says that their noise is less: right models of 152
/// simulated recordings err at least 0.52 of it.
const SENSORS_BETTER: f64 = 0.5;

/// What is told of a search.
pub struct Report<'a> {
    pub family: &'a dyn ModelFamily,
    /// All of the recording.
    pub ahead: &'a dyn Ahead,
    pub settings: &'a Settings<'a>,
    pub found: Found,
    /// Whether time is up before a long recording was asked in full: what takes long for people to see is left out.
    pub brief: bool,
    /// Whether time is up while it is told.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

impl Report<'_> {
    /// All that is told.
    pub fn discovery(self) -> Discovery {
        let family = on_view(self.family);
        let points = family.target().len();
        let split = Split::new(points, family.blocks());
        let as_fit = |node: &Node| fit::evaluate(family, node.model.clone(), &vec![1.0; points]);
        let base_fit = as_fit(&self.found.base);
        let fits: Vec<Fit> = self.found.rungs.iter().map(as_fit).collect();
        let last_fit = fits.last().unwrap_or(&base_fit);
        let added = self.names(&self.found.added);
        let ambiguous = self.ambiguous();
        let budget = self.budget();
        let verdict = self.verdict(&budget, !ambiguous.is_empty());
        let motion = family.motion();
        let places = |fit: &Fit| {
            if self.is_brief() {
                return Vec::new();
            }
            let weights = weights(family.doubt(), &fit.residual);
            let seed = self.settings.seed;
            let view = Look { residual: &fit.residual, weights: &weights, motion: &motion, seed };
            where_it_fails::coordinates(family, &view)
        };
        let where_last = places(last_fit);
        let where_base = if added.is_empty() { where_last.clone() } else { places(&base_fit) };
        let quantity = family.quantity();
        let mut noise_floor = family.noise();
        let floor = noise::floor_of(family, &last_fit.residual);
        noise_floor.insert(floor_key(&quantity.name, &quantity.unit), floor);
        let ladder = self.ladder(&split, &base_fit, &fits);
        let last = self.lacks(self.found.rungs.last().unwrap_or(&self.found.base), last_fit);
        let base =
            if added.is_empty() { last.clone() } else { self.lacks(&self.found.base, &base_fit) };
        let generic_term = (verdict == Verdict::Unexplained)
            .then(|| self.generic_term(&where_last, &last_fit.residual))
            .flatten();
        let mut remarks = self.found.remarks.clone();
        if budget.last < SENSORS_BETTER {
            remarks.push(Remark::SensorsBetter { times: budget.last });
        }
        if let Some(deviation) = self.found.input_noise {
            let (input, unit) = (quantity.name, quantity.unit);
            remarks.push(Remark::InputNoise { input, deviation, unit });
        }
        let mut discovery = Discovery {
            verdict,
            added,
            ladder,
            ranking: self.ranking(),
            where_it_fails: where_last,
            where_base,
            regimes: last.1,
            regimes_base: base.1,
            missing_force: last.0,
            missing_force_base: base.0,
            ambiguous,
            generic_term,
            noise_floor,
            detection_limits: self.limits(),
            decisions: self.found.decisions.iter().map(finite).collect(),
            // Sensors of which nothing is known make no budget.
            budget: Some(budget)
                .filter(|b| [b.expected, b.base, b.last].iter().all(|x| x.is_finite())),
            untried: self.names(&self.found.untried),
            seed: 0,
            wall_s: 0.0,
            remains: self.found.places.clone(),
            most_likely: None,
            remarks,
            notes: Vec::new(),
            stopped: self.found.stopped,
            diagnosis: None,
            diagnosis_base: None,
            views: Vec::new(),
            confirmation: None,
            surrogates: None,
            plots: family.plots(&base_fit.model, &last_fit.model),
        };
        if !self.is_brief() {
            diagnosis::attach(family, &base_fit, last_fit, self.settings.seed, &mut discovery);
        } else if !discovery.stopped {
            discovery.remarks.push(Remark::ToldInBrief);
        }
        discovery
    }

    fn is_brief(&self) -> bool {
        self.brief || (self.stop)()
    }

    /// The force that a model lacks, and its shares by regime; where nothing is known of it those of the error.
    fn lacks(&self, node: &Node, fit: &Fit) -> (Option<MissingForce>, Vec<RegimeShare>) {
        let series = node.missing_force(self.ahead);
        match series.and_then(|series| MissingForce::of(on_view(self.family), series)) {
            Some((missing, regimes)) => (Some(missing), regimes),
            None => (None, where_it_fails::regimes(on_view(self.family), &fit.residual)),
        }
    }

    /// A term that describes what is left along the coordinate that it depends on most, as text to add.
    fn generic_term(&self, places: &[crate::report::Where], residual: &[f64]) -> Option<String> {
        let place = places.iter().find(|place| place.is_structure())?;
        let named = |c: &&crate::family::Coordinate| c.name == place.coordinate;
        let family = on_view(self.family);
        let coordinate = family.coordinates().iter().find(named)?;
        family.generic_term(coordinate, &generic::shape(coordinate, residual))
    }

    fn names(&self, terms: &[usize]) -> Vec<String> {
        terms.iter().map(|term| self.family.terms()[*term].name.clone()).collect()
    }

    fn budget(&self) -> Budget {
        let of = |node: &Node| node.scale / self.ahead.budget();
        let last = self.found.rungs.last().unwrap_or(&self.found.base);
        Budget {
            expected: self.ahead.budget(),
            base: of(&self.found.base),
            last: of(last),
            allowed: self.settings.thresholds.complete,
            complete: self.found.complete,
        }
    }

    fn verdict(&self, budget: &Budget, ambiguous: bool) -> Verdict {
        let nothing = self.found.added.is_empty();
        match (nothing, budget.complete, self.found.stopped) {
            (_, _, true) => Verdict::Stopped,
            (true, true, _) => Verdict::NothingMissing,
            (true, false, _) => Verdict::Unexplained,
            (false, ..) if ambiguous => Verdict::Ambiguous,
            (false, ..) => Verdict::EffectsFound,
        }
    }

    fn ambiguous(&self) -> Vec<Ambiguity> {
        let added = &self.found.added;
        let mut sets: Vec<Ambiguity> = Vec::new();
        let as_good = self.found.as_good(self.family);
        let exchanged: Vec<_> = as_good.iter().filter_map(|set| self.exchanged(set)).collect();
        // Rivals of one and the same effect stand together.
        for term in added {
            let mut terms = vec![*term];
            for (gone, rival) in &exchanged {
                // Another law of a usual effect is that effect.
                let other = self.family.law_of(*rival) != Some(*term);
                if gone == term && other && !terms.contains(rival) {
                    terms.push(*rival);
                }
            }
            if terms.len() > 1 {
                let effects = self.names(&terms);
                let experiment = self.family.experiment(&effects);
                sets.push(Ambiguity { effects, experiment });
            }
        }
        sets
    }

    /// The one effect that was found and is not in a set, and the one that the set has in its place; what every system has
    /// may go or come with them.
    fn exchanged(&self, set: &[usize]) -> Option<(usize, usize)> {
        let added = self.found.added.as_slice();
        let beside = |these: &[usize], those: &[usize]| -> Vec<usize> {
            let lacks = |term: &usize| !Found::is_in(those, *term, self.family);
            these.iter().copied().filter(lacks).collect()
        };
        let (mut gone, mut rivals) = (beside(added, set), beside(set, added));
        if gone.len() != rivals.len() {
            gone.retain(|term| !self.family.is_usual(*term));
            rivals.retain(|term| !self.family.is_usual(*term));
        }
        let ([gone], [rival]) = (&gone[..], &rivals[..]) else { return None };
        Some((*gone, *rival))
    }

    /// The rungs; `fits` are those above the base, along the measured motion.
    fn ladder(&self, split: &Split, base_fit: &Fit, fits: &[Fit]) -> Vec<Rung> {
        let base = self.rung(&self.found.base, base_fit, split, None);
        let above = self.found.rungs.iter().zip(fits).enumerate();
        let above = above.map(|(k, (node, fit))| self.rung(node, fit, split, Some(k)));
        std::iter::once(base).chain(above).collect()
    }

    fn rung(&self, node: &Node, fit: &Fit, split: &Split, k: Option<usize>) -> Rung {
        let terms = self.family.terms();
        let added = k.iter().map(|k| terms[self.found.added[*k]].name.clone());
        let gain: Option<&Difference> = k.map(|k| &self.found.gains[k]);
        Rung {
            added: added.collect(),
            p_value: k.and_then(|k| self.found.p_values.get(k).copied()).map(|p| {
                // A gain that is no number is none.
                if gain.is_some_and(|gain| gain.nats.is_nan()) { 1.0 } else { p }
            }),
            likelihood_gain: gain.map(|gain| gain.nats).filter(|nats| nats.is_finite()),
            ..rung((self.family, self.ahead), node, fit, split)
        }
    }

    fn ranking(&self) -> Vec<Vec<Candidate>> {
        let row = |ranked: &Ranked| -> Vec<Candidate> {
            let each = ranked.rows.iter().map(|row| Candidate {
                effect: self.family.terms()[row.term].name.clone(),
                gain: share(row.nats, ranked.points),
                // A gain that is no number is none.
                p_value: if row.nats.is_nan() { 1.0 } else { row.p_value },
                size: self.size(row.term, &row.model),
                nats: Some(row.nats).filter(|nats| nats.is_finite()),
            });
            each.collect()
        };
        self.found.ranking.iter().map(row).collect()
    }

    fn size(&self, term: usize, model: &Fitted) -> Vec<NamedValue> {
        let position = model.terms.iter().position(|t| *t == term);
        position.map_or_else(Vec::new, |position| {
            let values = &model.values[model.range(self.family, position)];
            sizes(&self.family.terms()[term], values)
        })
    }

    /// The size at which each candidate that was not found would have gained enough.
    fn limits(&self) -> BTreeMap<String, DetectionLimit> {
        let mut limits = BTreeMap::new();
        for promise in &self.found.last_screening {
            let term = &self.family.terms()[promise.term];
            let amplitude = crate::family::shapes::amplitudes(term).first().copied();
            let (Some(amplitude), Some(leverage)) = (amplitude, promise.leverage) else { continue };
            if leverage <= 0.0 || self.family.form_of(promise.term).is_some() {
                continue;
            }
            let better = self.settings.thresholds.in_part(self.ahead.asked()).better;
            let size = (better / leverage).sqrt();
            let Some(start) = promise.starts.first() else { continue };
            let values = &start.values[start.range(self.family, start.terms.len() - 1)];
            limits.insert(term.name.clone(), detection_limit(term, values, amplitude, size));
        }
        limits
    }
}

/// What is told of a model by itself; `fit` is the same model along the measured motion.
pub fn rung(
    (family, ahead): (&dyn ModelFamily, &dyn Ahead),
    node: &Node,
    fit: &Fit,
    split: &Split,
) -> Rung {
    let terms = family.terms();
    let effects = fit.model.terms.iter().filter(|&&t| !terms[t].always);
    Rung {
        added: Vec::new(),
        effects: effects.map(|&t| terms[t].name.clone()).collect(),
        parameters: intervals::of((family, ahead), node),
        error: diagnosis::errors(on_view(family), fit, split),
        p_value: None,
        metrics: Some(SplitMetrics::of(&fit.residual, on_view(family).target(), split)),
        likelihood_gain: None,
        budget: Some(node.scale / ahead.budget()).filter(|times| times.is_finite()),
    }
}

/// Share of the squared error that a gain in log-likelihood of so many errors stands for; what makes it more than
/// twice as large is told as twice.
fn share(nats: f64, points: f64) -> f64 {
    // The larger of the two is the number where one is none.
    (1.0 - (-2.0 * nats / points.max(1.0)).exp()).max(-1.0)
}

/// The decision in numbers that a file can hold.
fn finite(decision: &Decision) -> Decision {
    let numbers = [decision.difference, decision.standard_error, decision.budget];
    if numbers.iter().all(|number| number.is_finite()) {
        return decision.clone();
    }
    let or_zero = |number: f64| if number.is_finite() { number } else { 0.0 };
    Decision {
        difference: or_zero(decision.difference),
        standard_error: or_zero(decision.standard_error),
        budget: or_zero(decision.budget),
        because: Some(Reason::NotFinite),
        ..decision.clone()
    }
}

#[cfg(test)]
mod tests;
