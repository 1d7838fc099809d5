//! How well a candidate would explain what a model leaves.

use serde::{Deserialize, Serialize};

/// How well a candidate would explain what the model of a rung leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Name of the effect.
    pub effect: String,
    /// Share of the held-out squared error that it removes, 0..1 (negative: it makes it worse).
    pub gain: f64,
    /// Chance of as large a gain by any effect of the library where none is missing.
    pub p_value: f64,
    /// Size with unit, in words: "8.2 N at 1.1 mm/s".
    #[serde(default)]
    pub size: String,
    /// Held-out log-likelihood that it gains, nats; to first order where it was not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nats: Option<f64>,
}
