//! The rungs: models of growing size, their errors on fitted and held-out data.

use std::collections::BTreeMap;

use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::metrics::SplitMetrics;
use crate::report::{Ambiguity, Candidate, Rung, SplitError};
use crate::screen::Screened;
use crate::split::Split;
use crate::uncertainty;

/// What has been added so far, rung by rung.
pub struct Ladder<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    split: Split,
    fitted: Vec<f64>,
    rungs: Vec<Rung>,
    ranking: Vec<Vec<Candidate>>,
    added: Vec<usize>,
    /// Terms with those that did as well when they were added.
    rivals: Vec<(usize, Vec<usize>)>,
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
            rivals: Vec::new(),
        }
    }

    pub(crate) fn push(&mut self, added: &[usize], fit: &Fit, p_value: Option<f64>) {
        self.added.extend(added);
        let name = (!added.is_empty()).then(|| self.joined(added));
        let rung = self.rung(name, fit, p_value);
        self.rungs.push(rung);
    }

    /// Names of terms that were added together.
    pub(crate) fn joined(&self, terms: &[usize]) -> String {
        let names: Vec<&str> =
            terms.iter().map(|&term| self.family.terms()[term].name.as_str()).collect();
        names.join(" + ")
    }

    /// Takes back all that has been added.
    pub(crate) fn clear(&mut self) {
        self.rungs.truncate(1);
        self.ranking.truncate(1);
        self.added.clear();
        self.rivals.clear();
    }

    /// Replaces the last rung by one without `term`.
    pub(crate) fn drop(&mut self, term: usize, fit: &Fit) {
        self.added.retain(|&index| index != term);
        if let Some(last) = self.rungs.pop() {
            let rung = self.rung(last.added, fit, last.p_value);
            self.rungs.push(rung);
        }
    }

    /// Replaces the last rung by one in which a term has another form.
    pub(crate) fn replace(&mut self, from: usize, to: usize, fit: &Fit) {
        self.added.iter_mut().filter(|term| **term == from).for_each(|term| *term = to);
        self.rivals.iter_mut().filter(|(term, _)| *term == from).for_each(|(term, _)| *term = to);
        if let Some(last) = self.rungs.pop() {
            let names = [from, to].map(|term| self.family.terms()[term].name.as_str());
            let renamed = |name: String| if name == names[0] { names[1].to_owned() } else { name };
            let rung = self.rung(last.added.map(renamed), fit, last.p_value);
            self.rungs.push(rung);
            self.ranking.pop();
        }
    }

    pub(crate) fn rank(&mut self, screened: &[Screened]) {
        let row = screened.iter().map(|candidate| Candidate {
            effect: self.family.terms()[candidate.term].name.clone(),
            gain: candidate.gain,
            p_value: candidate.p_value,
            size: self.family.describe(candidate.term, &candidate.values),
        });
        self.ranking.push(row.collect());
    }

    pub(crate) fn rivals(&mut self, term: usize, rivals: Vec<usize>) {
        self.rivals.push((term, rivals));
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
    pub(crate) fn views(&self) -> BTreeMap<String, SplitError> {
        self.rungs.last().map(|rung| rung.error.clone()).unwrap_or_default()
    }

    /// Relative error of the last rung on held-out data.
    pub(crate) fn relative(&self) -> f64 {
        let key = relative_key(self.family);
        self.rungs.last().and_then(|rung| rung.error.get(&key)).map_or(f64::NAN, |e| e.validation)
    }

    /// Added effects with the rivals that have nothing more to say once the effect is in: which of
    /// them is at work, this data cannot tell.
    pub(crate) fn ambiguous(&self, screened: &[Screened], alpha: f64) -> Vec<Ambiguity> {
        let idle = |term: &usize| {
            !self.added.contains(term)
                && screened.iter().any(|c| c.term == *term && (c.p_value > alpha || c.gain < 0.02))
        };
        let name = |term: usize| self.family.terms()[term].name.clone();
        self.rivals
            .iter()
            .filter(|(term, _)| self.added.contains(term))
            .filter_map(|(term, rivals)| {
                let effects: Vec<String> = std::iter::once(*term)
                    .chain(rivals.iter().copied().filter(idle))
                    .map(name)
                    .collect();
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

    fn rung(&self, added: Option<String>, fit: &Fit, p_value: Option<f64>) -> Rung {
        let terms = self.family.terms();
        let effects = fit.model.terms.iter().filter(|&&k| !terms[k].always);
        Rung {
            added,
            effects: effects.map(|&k| terms[k].name.clone()).collect(),
            parameters: uncertainty::estimates(self.family, fit, &self.fitted),
            error: errors(self.family, fit, &self.split),
            p_value,
            metrics: Some(SplitMetrics::of(&fit.residual, self.family.target(), &self.split)),
        }
    }
}

/// Every error of a model: of the compared quantity, absolute and relative, and in the family's
/// other views.
pub fn errors<F: ModelFamily + ?Sized>(
    family: &F,
    fit: &Fit,
    split: &Split,
) -> BTreeMap<String, SplitError> {
    let quantity = family.quantity();
    let rms = split.rms(&fit.residual);
    let size = split.rms(family.target());
    let part = |error: f64, of: f64| if of > 0.0 { error / of } else { 0.0 };
    let relative = SplitError {
        fit: part(rms.fit, size.fit),
        validation: part(rms.validation, size.validation),
    };
    let mut errors = family.views(&fit.model, split);
    errors.insert(format!("{}_rms_{}", quantity.name, quantity.unit), rms);
    errors.insert(relative_key(family), relative);
    errors
}

/// Key of the relative error.
pub fn relative_key<F: ModelFamily + ?Sized>(family: &F) -> String {
    format!("{}_relative", family.quantity().name)
}
