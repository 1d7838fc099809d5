//! A model with its values.

/// A model with its values: terms by their index in [`ModelFamily::terms`](super::ModelFamily::terms), parameters one term
/// after the other.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Fitted {
    /// Indices of the terms.
    pub terms: Vec<usize>,
    /// Values of all parameters.
    pub values: Vec<f64>,
}

impl Fitted {
    /// This model with one term more.
    #[must_use]
    pub fn with(&self, term: usize, values: &[f64]) -> Self {
        let mut more = self.clone();
        more.terms.push(term);
        more.values.extend_from_slice(values);
        more
    }
}
