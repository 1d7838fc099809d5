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

/// An error of a model, with what is compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedError {
    /// What is compared, e.g. `force` or `window`.
    pub quantity: String,
    /// SI unit; nothing for a fraction of the quantity's own size.
    pub unit: Option<String>,
    /// On the blocks used for fitting.
    pub fit: f64,
    /// On the held-out blocks.
    pub validation: f64,
}

impl NamedError {
    /// An error in a unit.
    pub fn absolute(quantity: &str, unit: &str, error: SplitError) -> Self {
        let SplitError { fit, validation } = error;
        Self { quantity: quantity.to_owned(), unit: Some(unit.to_owned()), fit, validation }
    }

    /// An error as a fraction.
    pub fn relative(quantity: &str, error: SplitError) -> Self {
        let SplitError { fit, validation } = error;
        Self { quantity: quantity.to_owned(), unit: None, fit, validation }
    }

    /// Its name in maps: `force_rms_N`, `force_relative`. Made, never taken apart.
    pub fn key(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{}_rms_{unit}", self.quantity),
            None => relative_key(&self.quantity),
        }
    }

    /// The two numbers.
    pub fn size(&self) -> SplitError {
        SplitError { fit: self.fit, validation: self.validation }
    }
}

/// Key of the relative error of a quantity.
pub fn relative_key(quantity: &str) -> String {
    format!("{quantity}_relative")
}

/// Key of the noise floor of a quantity in a unit.
pub fn floor_key(quantity: &str, unit: &str) -> String {
    format!("{quantity}_{unit}")
}

/// One rung of the ladder: a structure, its parameters, its errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rung {
    /// The effect added on this rung; several where they only help together, none on the base rung.
    pub added: Vec<String>,
    /// Every effect of the model on this rung.
    pub effects: Vec<String>,
    /// `effect.parameter` -> estimate.
    pub parameters: BTreeMap<String, Estimate>,
    /// [`NamedError::key`] -> the error.
    pub error: BTreeMap<String, NamedError>,
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

impl Rung {
    /// Its name in tables point by point, from its number in the ladder: `base`, `1_stribeck`, `2_ripple`.
    pub fn label(&self, number: usize) -> String {
        if number == 0 { "base".to_owned() } else { format!("{number}_{}", self.added.join("+")) }
    }
}
