//! The rungs: models of growing size, their errors on fitted and held-out data.

use std::collections::BTreeMap;

use crate::climb::screen::Screened;
use crate::diagnosis::{errors, relative_key};
use crate::family::{Fitted, ModelFamily, sizes};
use crate::fit::{Fit, uncertainty};
use crate::report::{Ambiguity, Candidate, NamedError, Rung, SplitMetrics};
use crate::statistics::split::Split;

/// What has been added so far, rung by rung.
pub struct Ladder<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    split: Split,
    fitted: Vec<f64>,
    rungs: Vec<Rung>,
    ranking: Vec<Vec<Candidate>>,
    added: Vec<usize>,
    /// The model of each rung.
    models: Vec<Fitted>,
    contests: Vec<Contest>,
}

/// A term and what was tried in its place.
struct Contest {
    term: usize,
    /// With p-values.
    others: Vec<(usize, f64)>,
    /// Those of them that do as well.
    rivals: Vec<usize>,
}

impl<'a, F: ModelFamily + ?Sized> Ladder<'a, F> {
    pub(crate) fn new(family: &'a F, split: Split, fitted: Vec<f64>) -> Self {
        Self {
            family,
            split,
            fitted,
            rungs: Vec::new(),
            ranking: Vec::new(),
            added: Vec::new(),
            models: Vec::new(),
            contests: Vec::new(),
        }
    }

    pub(crate) fn push(&mut self, added: &[usize], fit: &Fit, p_value: Option<f64>) {
        self.added.extend(added);
        let rung = self.rung(self.names(added), fit, p_value);
        self.rungs.push(rung);
        self.models.push(fit.model.clone());
    }

    /// Names of terms.
    pub(crate) fn names(&self, terms: &[usize]) -> Vec<String> {
        terms.iter().map(|&term| self.family.terms()[term].name.clone()).collect()
    }

    /// Takes back all that has been added.
    pub(crate) fn clear(&mut self) {
        self.rungs.truncate(1);
        self.ranking.truncate(1);
        self.added.clear();
        self.models.truncate(1);
        self.contests.clear();
    }

    /// Replaces the last rung by one without `term`.
    pub(crate) fn drop(&mut self, term: usize, fit: &Fit) {
        self.added.retain(|&index| index != term);
        if let Some(last) = self.rungs.pop() {
            let rung = self.rung(last.added, fit, last.p_value);
            self.rungs.push(rung);
            self.models.pop();
            self.models.push(fit.model.clone());
        }
    }

    /// Replaces the rungs that have a term by those in which another one, or another form of it, is in its
    /// place; `p_value` is that of the new one.
    pub(crate) fn replace(&mut self, from: usize, to: usize, fits: &[Fit], p_value: f64) {
        let of = |term: &mut usize| *term = if *term == from { to } else { *term };
        self.added.iter_mut().for_each(of);
        for contest in self.contests.iter_mut().filter(|contest| contest.term == from) {
            contest.term = to;
            // What was as good as the one says nothing of the other; the one may be as good as it.
            contest.rivals.clear();
            let exchanged = contest.others.iter_mut().filter(|(other, _)| *other == to);
            exchanged.for_each(|(other, _)| *other = from);
        }
        let names = [from, to].map(|term| self.family.terms()[term].name.as_str());
        let rungs: Vec<usize> = self.rungs_with(from).collect();
        for (k, fit) in rungs.into_iter().zip(fits) {
            let old = &self.rungs[k];
            let renamed = |name: &String| if name == names[0] { names[1] } else { name }.to_owned();
            let added: Vec<String> = old.added.iter().map(renamed).collect();
            let p_value = if added == old.added { old.p_value } else { Some(p_value) };
            self.rungs[k] = self.rung(added, fit, p_value);
            self.models[k] = fit.model.clone();
        }
        self.ranking.pop();
    }

    fn rungs_with(&self, term: usize) -> impl Iterator<Item = usize> {
        (0..self.models.len()).filter(move |&k| self.models[k].terms.contains(&term))
    }

    /// p-value with which a term was added.
    pub(crate) fn p_value(&self, term: usize) -> Option<f64> {
        self.rungs_with(term).next().and_then(|k| self.rungs[k].p_value)
    }

    /// The model of every rung that has a term.
    pub(crate) fn models_with(&self, term: usize) -> impl Iterator<Item = &Fitted> {
        self.rungs_with(term).map(|k| &self.models[k])
    }

    pub(crate) fn rank(&mut self, screened: &[Screened]) {
        let row = screened.iter().map(|candidate| Candidate {
            effect: self.family.terms()[candidate.term].name.clone(),
            gain: candidate.gain,
            p_value: candidate.p_value,
            size: sizes(&self.family.terms()[candidate.term], &candidate.values),
            nats: None,
        });
        self.ranking.push(row.collect());
    }

    /// Notes what else was tried in the place of a term, with p-values, and which of that did as well.
    pub(crate) fn contest(&mut self, term: usize, others: Vec<(usize, f64)>, rivals: Vec<usize>) {
        self.contests.push(Contest { term, others, rivals });
    }

    /// Terms of the model, each with what was tried in its place and is not in the model.
    pub(crate) fn contested(&self) -> Vec<(usize, Vec<(usize, f64)>)> {
        let here = |contest: &&Contest| self.added.contains(&contest.term);
        let absent = |(term, _): &(usize, f64)| !self.added.contains(term);
        let open = |contest: &Contest| {
            (contest.term, contest.others.iter().copied().filter(absent).collect())
        };
        self.contests.iter().filter(here).map(open).collect()
    }

    /// Adds those that do as well in the place of `term` as it does, now that all else is there.
    pub(crate) fn rivals(&mut self, term: usize, rivals: Vec<usize>) {
        if let Some(contest) = self.contests.iter_mut().find(|contest| contest.term == term) {
            for rival in rivals {
                if !contest.rivals.contains(&rival) {
                    contest.rivals.push(rival);
                }
            }
        }
    }

    /// Number of rungs.
    pub(crate) fn height(&self) -> usize {
        self.rungs.len()
    }

    /// Indices of the terms added, in order.
    pub(crate) fn added(&self) -> Vec<usize> {
        self.added.clone()
    }

    /// Every error of the last rung.
    pub(crate) fn views(&self) -> BTreeMap<String, NamedError> {
        self.rungs.last().map(|rung| rung.error.clone()).unwrap_or_default()
    }

    /// Relative error of the last rung on held-out data.
    pub(crate) fn relative(&self) -> f64 {
        let key = relative_key(self.family);
        self.rungs.last().and_then(|rung| rung.error.get(&key)).map_or(f64::NAN, |e| e.validation)
    }

    /// Added effects with those that do as well in their place: which of them is at work, this data
    /// cannot tell.
    pub(crate) fn ambiguous(&self) -> Vec<Ambiguity> {
        let name = |term: usize| self.family.terms()[term].name.clone();
        self.contests
            .iter()
            .filter(|contest| self.added.contains(&contest.term))
            .filter_map(|contest| {
                let rivals = contest.rivals.iter().filter(|rival| !self.added.contains(rival));
                let effects: Vec<String> =
                    std::iter::once(&contest.term).chain(rivals).copied().map(name).collect();
                let experiment = self.family.experiment(&effects);
                (effects.len() > 1).then_some(Ambiguity { effects, experiment })
            })
            .collect()
    }

    pub(crate) fn into_parts(self) -> (Vec<Rung>, Vec<Vec<Candidate>>, Vec<String>, Split) {
        let names = self.added.iter().map(|&term| self.family.terms()[term].name.clone());
        let added = names.collect();
        (self.rungs, self.ranking, added, self.split)
    }

    fn rung(&self, added: Vec<String>, fit: &Fit, p_value: Option<f64>) -> Rung {
        let terms = self.family.terms();
        let effects = fit.model.terms.iter().filter(|&&k| !terms[k].always);
        Rung {
            added,
            effects: effects.map(|&k| terms[k].name.clone()).collect(),
            parameters: uncertainty::estimates(self.family, fit, &self.fitted),
            error: errors(self.family, fit, &self.split),
            p_value,
            metrics: Some(SplitMetrics::of(&fit.residual, self.family.target(), &self.split)),
            likelihood_gain: None,
            budget: None,
        }
    }
}
