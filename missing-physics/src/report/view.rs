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

/// A view of the error that grows with an effect that lowers the compared error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Disagreement {
    /// What was added on the rung.
    pub added: Vec<String>,
    /// The compared quantity, whose error falls.
    pub compared: String,
    /// The view that grows.
    pub view: String,
    /// Its unit; nothing for a fraction.
    pub unit: Option<String>,
    /// Held-out error without the effect.
    pub before: f64,
    /// Held-out error with it.
    pub after: f64,
}
