//! Where the flexible form begins that takes an effect's place.

/// An effect as it stands in a model, before its flexible form takes its place.
#[derive(Clone, Copy)]
pub struct Before<'a> {
    /// The value of its parameter of this name, SI; nothing for one that it does not have or that is not fitted.
    pub value: &'a dyn Fn(&str) -> Option<f64>,
    /// Level of Coulomb friction in the model, where it has one.
    pub level: Option<f64>,
    /// Highest speed of the recording.
    pub top_speed: f64,
}

/// Where the flexible form begins, beyond the values of parameters that both forms have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Begin {
    /// Parameters of the flexible form by name, SI; others that the effect does not have begin at 0 where they have a sign,
    /// at their usual value else.
    pub values: Vec<(String, f64)>,
    /// What Coulomb friction takes over.
    pub level: f64,
}

impl Begin {
    /// At these values.
    pub fn at<const N: usize>(values: [(&str, f64); N]) -> Self {
        let values = values.map(|(name, value)| (name.to_owned(), value)).to_vec();
        Self { values, level: 0.0 }
    }
}
