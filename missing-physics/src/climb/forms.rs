//! Forms of an effect: its main one, or another that describes the data clearly better.

use super::Search;
use crate::climb::screen::{self, Screened};
use crate::climb::tried::{Tried, square};
use crate::family::ModelFamily;
use crate::fit;
use crate::statistics::weights;

/// Another form of an effect is taken where it leaves at most this share of the main form's squared
/// error.
const BETTER_FORM: f64 = 0.8;
/// Other forms are tried where the main form removes at least this share of what the best candidate
/// removes.
const HOPEFUL: f64 = 0.4;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// Of every effect its main form, or the other one that shows clearly more; best first, as `screened` is.
    pub(super) fn one_of_each(&self, screened: &[Screened]) -> Vec<Screened> {
        let main = |of: &Screened| self.family.form_of(of.term).unwrap_or(of.term);
        let left = |candidate: &Screened| [1.0 - candidate.gain, 1.0 - candidate.gain_all];
        let clearly = |form: &Screened, main: &Screened| {
            left(form).iter().zip(left(main)).all(|(form, main)| *form < BETTER_FORM * main)
        };
        let mut chosen: Vec<Screened> = Vec::new();
        for candidate in screened {
            let main_form = screened.iter().find(|other| other.term == main(candidate));
            let is_main = candidate.term == main(candidate);
            let stands = is_main || main_form.is_none_or(|main| clearly(candidate, main));
            if stands && chosen.iter().all(|other| main(other) != main(candidate)) {
                chosen.push(candidate.clone());
            }
        }
        chosen
    }

    /// Another form of an effect that is in the model already, with which the model leaves no more than
    /// with a new effect beside the form that it has.
    pub(super) fn other_form(&self, chosen: &Tried) -> Option<(usize, Tried)> {
        let main = |term: usize| self.family.form_of(term).unwrap_or(term);
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&[], &weights);
        let mut best: Option<(usize, Tried)> = None;
        for old in self.ladder.added() {
            let forms = (0..self.family.terms().len())
                .filter(|&form| form != old && main(form) == main(old))
                .collect::<Vec<_>>();
            if forms.is_empty() || self.stopped() {
                continue;
            }
            let p_value = self.ladder.p_value(old).unwrap_or(chosen.p_value);
            let without = self.fit.model.without(self.family, old);
            let without = fit::refine(self.family, without, &self.fitted);
            for form in forms {
                let values = screen::best_values(self.family, &without, &screening, form);
                let Some(values) = values else { continue };
                let tried = self.tried_from(&without, form, &values, p_value);
                let leaves = best.as_ref().map_or(chosen.square, |(_, best)| best.square);
                if tried.square <= leaves && self.confirmed(&tried.fit) {
                    best = Some((old, tried));
                }
            }
        }
        best
    }

    /// Every candidate in its main form, or in another one that is clearly better. Other forms are only
    /// looked at where the main form is in the running.
    pub(super) fn with_forms(&self, tried: Vec<Tried>) -> Vec<Tried> {
        let before = square(&self.fit);
        let best = tried.iter().map(|main| main.square).fold(before, f64::min);
        let hopeful = before - HOPEFUL * (before - best);
        let better = |main: Tried| if main.square <= hopeful { self.best_form(main) } else { main };
        tried.into_iter().map(better).collect()
    }

    /// The main form of an effect, or another one that is clearly better.
    fn best_form(&self, main: Tried) -> Tried {
        let weights = weights(self.family.doubt(), &self.fit.residual);
        let screening = self.screening(&[], &weights);
        (0..self.family.terms().len())
            .filter(|&form| self.family.form_of(form) == Some(main.terms[0]))
            .filter_map(|form| {
                let values = screen::best_values(self.family, &self.fit, &screening, form)?;
                Some(self.tried(form, &values, main.p_value))
            })
            .filter(|form| form.square < main.square * BETTER_FORM)
            .min_by(|a, b| a.square.total_cmp(&b.square))
            .unwrap_or(main)
    }
}
