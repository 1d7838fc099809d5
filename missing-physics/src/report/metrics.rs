//! The size of an error in its usual measures.

use serde::{Deserialize, Serialize};

/// The size of an error in its usual measures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// Root mean square of the error, in the unit of the compared quantity.
    pub rms: f64,
    /// That over the root mean square of the measurement; nothing where the measurement is zero.
    pub relative: Option<f64>,
    /// `100 (1 - |e| / |y - mean y|)`; nothing where the measurement is constant. Negative where the
    /// mean of the measurement predicts better than the model.
    pub fit_percent: Option<f64>,
    /// `100 (1 - var e / var y)`, blind to a constant error; nothing where the measurement is constant.
    pub variance_accounted_for_percent: Option<f64>,
    /// Points it was taken over.
    pub points: usize,
}

/// Measures on fitted and on held-out blocks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitMetrics {
    /// On the blocks used for fitting.
    pub fit: Metrics,
    /// On the held-out blocks.
    pub validation: Metrics,
}
