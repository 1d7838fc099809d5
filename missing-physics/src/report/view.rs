//! The error of a model in one view.

use serde::{Deserialize, Serialize};

use super::metrics::SplitMetrics;

/// What is compared, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Compares {
    /// A quantity along the measured motion.
    Residual {
        /// Which: `force`.
        quantity: String,
        /// Above it nothing is compared, Hz.
        bandwidth: f64,
    },
    /// A simulated motion, from a fitted start in each window; outliers are capped.
    Windows {
        /// Length of a window, s.
        length: f64,
    },
    /// A simulated motion, from the first sample of each segment.
    FreeRun,
    /// A simulated motion under the controller that the recording shows.
    ClosedLoop {
        /// Share of the variance of its force that the controller describes, 0..1.
        described: f64,
        /// Root mean square of what the measured motion lags behind the reference, in the unit of the view.
        lag: f64,
    },
}

/// Why the numbers of a view must not be taken as they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Caveat {
    /// A free run adds up the force error twice, also that of noise, and ranks models wrongly.
    Drifted {
        /// Its error as a multiple of that of short windows.
        times: f64,
    },
    /// The controller hides what a model lacks.
    Hidden {
        /// Error of a bare mass without any friction, in the unit of the view.
        bare: f64,
        /// The same as a share of the motion.
        share: f64,
    },
}

/// The error of a model in one view: the force along the measured motion, a simulated motion, ...
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// Name, with the length of windows where there are any.
    pub name: String,
    /// What is compared, and how.
    pub compares: Compares,
    /// SI unit of the error.
    pub unit: String,
    /// Its size.
    pub metrics: SplitMetrics,
    /// Error that no model can remove in this view, where it is known.
    pub floor: Option<f64>,
    /// Whether models may be judged by it. A closed loop hides what its controller suppresses, a free
    /// run drifts; both are shown and neither decides.
    pub decides: bool,
    /// Why these numbers must not be taken as they are, where that is so.
    pub caveat: Option<Caveat>,
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
