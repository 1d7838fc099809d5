//! The error of a model in one view.

use serde::{Deserialize, Serialize};

use super::metrics::SplitMetrics;

/// The error of a model in one view: the force along the measured motion, a simulated motion, ...
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// Name, with the length of windows where there are any.
    pub name: String,
    /// What is compared, and how, in words.
    pub about: String,
    /// SI unit of the error.
    pub unit: String,
    /// Its size.
    pub metrics: SplitMetrics,
    /// Error that no model can remove in this view, where it is known.
    pub floor: Option<f64>,
    /// Whether models may be judged by it. A closed loop hides what its controller suppresses, a free
    /// run drifts; both are shown and neither decides.
    pub decides: bool,
    /// What the user should know about these numbers.
    pub warnings: Vec<String>,
}

/// Two views that prefer different models.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Disagreement {
    /// Name of the first view that decides.
    pub judge: String,
    /// The model that it prefers.
    pub prefers: String,
    /// Name of the other view.
    pub view: String,
    /// The model that that one prefers.
    pub instead: String,
    /// Whether models may be judged by the other view, too.
    pub decides: bool,
}
