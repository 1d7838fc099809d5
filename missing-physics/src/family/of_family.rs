//! A model with its values, seen with the family that its terms belong to.

use std::ops::Range;

use super::fitted::Fitted;
use super::model_family::ModelFamily;
use super::term::{Term, TermParameter};

impl Fitted {
    /// This model without one of its terms.
    #[must_use]
    pub fn without(&self, family: &dyn ModelFamily, term: usize) -> Self {
        let mut less = Self::default();
        for (position, &index) in self.terms.iter().enumerate() {
            if index != term {
                less.terms.push(index);
                less.values.extend_from_slice(&self.values[self.range(family, position)]);
            }
        }
        less
    }

    /// Where in `values` the parameters of the term at `position` stand.
    pub fn range(&self, family: &dyn ModelFamily, position: usize) -> Range<usize> {
        let count = |index: &usize| family.terms()[*index].parameters.len();
        let start = self.terms[..position].iter().map(count).sum();
        start..start + count(&self.terms[position])
    }

    /// All parameters with the term they belong to, in the order of `values`.
    pub fn parameters<'a>(
        &'a self,
        family: &'a dyn ModelFamily,
    ) -> impl Iterator<Item = (&'a Term, &'a TermParameter)> {
        self.terms.iter().flat_map(|&index| {
            let term = &family.terms()[index];
            term.parameters.iter().map(move |parameter| (term, parameter))
        })
    }

    /// This model with every value within the limits of the family.
    #[must_use]
    pub fn within(mut self, family: &dyn ModelFamily) -> Self {
        let limits: Vec<(f64, f64)> =
            self.parameters(family).map(|(_, p)| (p.lower, p.upper)).collect();
        for (value, (lower, upper)) in self.values.iter_mut().zip(limits) {
            *value = value.clamp(lower, upper);
        }
        self
    }
}
