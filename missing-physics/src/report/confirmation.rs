//! What other recordings say of a ladder.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::NamedValue;

/// A rung of a ladder on recordings that had no part in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Confirmation {
    /// The effect that the rung added; nothing on the base rung.
    pub added: Vec<String>,
    /// Every effect of the rung.
    pub effects: Vec<String>,
    /// Name of the error -> its size with the parameters as they were found; nothing is fitted but [`Self::own`].
    pub error: BTreeMap<String, f64>,
    /// Whether the effect predicts better here as it was found, and gains enough where all is fitted here.
    pub holds: Option<bool>,
    /// Share of the squared prediction error that it removes on held-out data where all parameters are fitted here.
    pub gain: Option<f64>,
    /// p-value of what it gains as it was found.
    pub p_value: Option<f64>,
    /// What it gains in log-likelihood of the prediction errors as it was found, nats; nothing is fitted but
    /// [`Self::own`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nats: Option<f64>,
    /// What belongs to a recording and was fitted to these ones: where homing put the position's zero, how warm it was.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own: Vec<NamedValue>,
}

/// A ladder on recordings that had no part in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Confirmed {
    /// Names of the recordings.
    pub recording: String,
    /// One for each rung.
    pub rungs: Vec<Confirmation>,
}
