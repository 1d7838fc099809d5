//! Where a model fails: coordinates and regimes.

use serde::{Deserialize, Serialize};

/// Where the model fails: one regime or coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Where {
    /// The coordinate or regime.
    pub coordinate: String,
    /// Share of the squared error, 0..1.
    pub share: f64,
    /// Chance of as strong a dependence on the coordinate where there is none.
    pub p_value: f64,
    /// In words.
    pub note: String,
}

/// Share of the error, or of the missing force, in one regime of the experiment; regimes do not overlap.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegimeShare {
    /// Name of the regime, e.g. `reversal`.
    pub regime: String,
    /// Share of the squared error, 0..1; all regimes sum to 1.
    pub share: f64,
    /// Share of the time, 0..1; all regimes sum to 1.
    pub time_share: f64,
    /// Root mean square of the error or force inside, in the unit of the compared quantity.
    pub rms: f64,
}
