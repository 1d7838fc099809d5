//! What was best while another effect was still missing need not be so beside it: at the top of the ladder
//! every effect is compared once more with those that were tried in its place.

use super::Search;
use crate::climb::screen;
use crate::climb::tried::{Tried, as_good, square};
use crate::family::ModelFamily;
use crate::fit::{self, Fit};
use crate::statistics::weights;
use crate::task::Event;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// Exchanges one effect for another that leaves clearly less in its place, and says whether it did.
    /// Where there is none, the ladder knows which others do as well, beside those that did when the effect was
    /// added: what has been added since may only mend what the wrong one of them left.
    pub(super) fn reconsider(&mut self) -> bool {
        let weights = weights(self.family.doubt(), &self.fit.residual);
        for (old, others) in self.ladder.contested() {
            let without = self.fit.model.without(self.family, old);
            let without = fit::refine(self.family, without, &self.fitted);
            let before = square(&without);
            let present = Tried::new(&[old], self.fit.clone(), 0.0);
            let mut rivals = Vec::new();
            for (other, p_value) in others {
                if self.stopped() {
                    return false;
                }
                let screening = self.screening(&[], &weights);
                let values = screen::best_values(self.family, &without, &screening, other);
                let Some(values) = values.filter(|_| self.family.joins(&without.model, other))
                else {
                    continue;
                };
                let tried = self.tried_from(&without, other, &values, p_value);
                if self.at_bound(&tried) {
                    continue;
                }
                let better = tried.square < present.square && !as_good(&present, &tried, before);
                if better && self.exchanges < self.settings.most && self.confirmed(&tried.fit) {
                    self.exchanges += 1;
                    self.replace(old, tried);
                    return true;
                }
                if as_good(&tried, &present, before) {
                    rivals.push(other);
                }
            }
            self.ladder.rivals(old, rivals);
        }
        false
    }

    /// Puts another effect, or another form, in the place of one, on every rung that has it.
    pub(super) fn replace(&mut self, old: usize, tried: Tried) {
        let new = tried.terms[0];
        let terms = self.family.terms();
        self.observer.event(&Event::Replaced { from: &terms[old].name, to: &terms[new].name });
        let model = &tried.fit.model;
        let values = &model.values[model.range(self.family, model.terms.len() - 1)];
        let mut fits: Vec<Fit> = self
            .ladder
            .models_with(old)
            .map(|model| model.without(self.family, old).with(new, values))
            .map(|model| fit::refine(self.family, model, &self.fitted))
            .collect();
        fits.pop();
        fits.push(tried.fit);
        self.ladder.replace(old, new, &fits, tried.p_value);
        self.fit = fits.swap_remove(fits.len() - 1);
    }
}
