//! One rung of a ladder: a structure, its parameters and its errors.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::metrics::SplitMetrics;

/// A parameter with its interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
    /// SI unit.
    pub unit: String,
    /// False where the data do not determine the value.
    pub identifiable: bool,
}

/// An error on the blocks that were fitted and on those held out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitError {
    /// On the blocks used for fitting.
    pub fit: f64,
    /// On the held-out blocks.
    pub validation: f64,
}

/// One rung of the ladder: a structure, its parameters, its errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rung {
    /// The effect added on this rung (several, joined with `+`, where they only help together);
    /// nothing on the base rung.
    pub added: Option<String>,
    /// Every effect of the model on this rung.
    pub effects: Vec<String>,
    /// `effect.parameter` -> estimate.
    pub parameters: BTreeMap<String, Estimate>,
    /// Name of the error -> its size on fitted and held-out data.
    pub error: BTreeMap<String, SplitError>,
    /// Chance that a term with no part in the data gains as much; nothing on the base rung.
    pub p_value: Option<f64>,
    /// The error of the compared quantity in its usual measures.
    #[serde(default)]
    pub metrics: Option<SplitMetrics>,
    /// Held-out log-likelihood of the prediction errors over that of the rung below, nats.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood_gain: Option<f64>,
    /// Prediction error in multiples of what the sensors alone make.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<f64>,
}
