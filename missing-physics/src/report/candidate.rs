//! How well a candidate would explain what a model leaves.

use serde::{Deserialize, Serialize};

/// A number with its name and unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedValue {
    /// Name, e.g. `dF`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// SI unit.
    pub unit: String,
}

/// The size at which an effect that was not found would have been.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DetectionLimit {
    /// Name of the amplitude.
    pub parameter: String,
    /// Its SI unit.
    pub unit: String,
    /// The size; nothing where none within the amplitude's limits would have been found.
    pub size: Option<f64>,
    /// The shape that it holds for.
    pub at: Vec<NamedValue>,
}

/// How well a candidate would explain what the model of a rung leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Name of the effect.
    pub effect: String,
    /// Share of the held-out squared error that it removes, 0..1 (negative: it makes it worse).
    pub gain: f64,
    /// Chance of as large a gain by any effect of the library where none is missing.
    pub p_value: f64,
    /// Its parameters as they suit the data best.
    #[serde(default)]
    pub size: Vec<NamedValue>,
    /// Held-out log-likelihood that it gains, nats; to first order where it was not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nats: Option<f64>,
}
