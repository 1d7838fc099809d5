//! What the data say, in one word and in one number.

use serde::{Deserialize, Serialize};

/// What the data say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// One or more effects were found and added.
    EffectsFound,
    /// The base model explains the data down to what noise does.
    NothingMissing,
    /// Structure remains that no candidate explains.
    Unexplained,
    /// Several candidates explain it equally well on this data.
    Ambiguous,
    /// The search was cut short before anything was certain.
    Stopped,
}

/// What the sensors make of the prediction error, and what the models leave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Prediction error that the sensors alone make: a standard deviation, m or rad.
    pub expected: f64,
    /// Prediction error of the base model, in multiples of it.
    pub base: f64,
    /// Prediction error of the last model, in multiples of it.
    pub last: f64,
    /// Up to this multiple a model is complete, where nothing is left at one place.
    #[serde(default)]
    pub allowed: f64,
    /// Whether the last model leaves no more than sensors make, or noise of the input ([`InputNoise`](super::Remark::InputNoise)).
    pub complete: bool,
}

/// Effects that this data cannot tell apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ambiguity {
    /// Names of the effects.
    pub effects: Vec<String>,
    /// The experiment that would tell them apart, as the subject says it; nothing where it knows none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub experiment: Option<String>,
}
