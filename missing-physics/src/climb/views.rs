//! What the other views of the error say of a model.

use std::collections::BTreeMap;

use super::Search;
use super::grounds::{CONTRADICTION, by_key};
use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::report::NamedError;

impl<F: ModelFamily + ?Sized> Search<'_, F> {
    /// Whether no other view of the error contradicts: what really acts on the plant helps
    /// in every view, unless something else that is missing spoils that view.
    pub(super) fn confirmed(&self, fit: &Fit) -> bool {
        let before = self.ladder.views();
        let after = by_key(self.family.views(&fit.model, &self.split));
        let old = self.split.rms(&self.fit.residual);
        let new = self.split.rms(&fit.residual);
        // A view may grow by as much as the residual itself falls.
        let allowed = |old: f64, new: f64| (old / new).max(CONTRADICTION);
        let fit = allowed(old.fit, new.fit);
        let validation = allowed(old.validation, new.validation);
        after.iter().all(|(name, error)| {
            before.get(name).is_none_or(|old| {
                error.validation <= validation * old.validation || error.fit <= fit * old.fit
            })
        })
    }

    /// Whether a fit is better in every view in which the present model leaves no more than noise may; with
    /// an effect of the sensor, in every view: there it shows as it is.
    pub(super) fn stands_out(&self, fit: &Fit) -> bool {
        let new = fit.model.terms.iter().filter(|term| !self.fit.model.terms.contains(term));
        let of_sensor = new.copied().any(|term| self.family.is_of_sensor(term));
        let seen = if of_sensor { self.ladder.views() } else { self.within_noise() };
        let after = if seen.is_empty() {
            BTreeMap::new()
        } else {
            by_key(self.family.views(&fit.model, &self.split))
        };
        seen.iter().all(|(name, before)| {
            after.get(name).is_none_or(|error| {
                CONTRADICTION * error.fit < before.fit
                    && CONTRADICTION * error.validation < before.validation
            })
        })
    }

    /// Views in which the present model leaves no more than the noise of the measurement may.
    pub(super) fn within_noise(&self) -> BTreeMap<String, NamedError> {
        let noise = self.family.view_noise();
        let mut views = self.ladder.views();
        views.retain(|name, error| {
            noise.get(name).is_some_and(|noise| error.fit.max(error.validation) <= *noise)
        });
        views
    }
}
