//! What several parameters make together.

use serde::{Deserialize, Serialize};

use super::rung::Estimate;

/// A quantity that several parameters make together, with its interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Combination {
    /// Its name, e.g. `F_C+`.
    pub name: String,
    /// What it is, in words.
    pub title: String,
    /// Its value.
    #[serde(flatten)]
    pub estimate: Estimate,
}

/// Quantities that the parameters of a model make together: these may be determined where the parameters are not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Combinations {
    /// The quantities, in the order in which they are told.
    pub quantities: Vec<Combination>,
    /// Parameters behind them that the data do not determine one by one, `term.parameter`.
    pub not_alone: Vec<String>,
}
