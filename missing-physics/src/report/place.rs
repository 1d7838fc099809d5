//! Where a model fails: coordinates and regimes.

use serde::{Deserialize, Serialize};

/// What a dependence of the error looks like.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Pattern {
    /// The bin with the largest mean error.
    Mean {
        /// Mean error in it.
        error: f64,
        /// Mean of the coordinate in it.
        at: f64,
        /// True where the error counts as positive when it opposes the motion.
        against_motion: bool,
    },
    /// The mean changes once.
    Step {
        /// By this much.
        height: f64,
        /// At this time, s.
        time: f64,
    },
    /// It swings.
    Sine {
        /// With this amplitude.
        amplitude: f64,
        /// With this period, s.
        period: f64,
    },
}

/// Where the model fails: one regime or coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Where {
    /// The coordinate or regime.
    pub coordinate: String,
    /// Share of the squared error, 0..1.
    pub share: f64,
    /// Chance of as strong a dependence on the coordinate where there is none.
    pub p_value: f64,
    /// Unit of the coordinate.
    #[serde(default)]
    pub unit: String,
    /// Unit of the error.
    #[serde(default)]
    pub error_unit: String,
    /// What the dependence looks like; nothing where nothing is there.
    #[serde(default)]
    pub pattern: Option<Pattern>,
}

impl Where {
    /// Largest p-value of a dependence that is told as structure.
    pub const STRUCTURE: f64 = 0.005;

    /// Whether the error depends on the coordinate beyond chance.
    pub fn is_structure(&self) -> bool {
        self.p_value <= Self::STRUCTURE
    }
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
