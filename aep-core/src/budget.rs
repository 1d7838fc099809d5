//! When a run ends.

use std::fmt;
use std::time::Duration;

use serde::{Deserialize, Serialize};

/// What a run may use. Whatever is reached first ends it; nothing set means no limit.
///
/// ```
/// use aep_core::Budget;
/// let budget = Budget::evaluations(20_000).with_target(1e-8).with_stagnation(500, 1e-9);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Evaluations. A generation that would exceed it is not begun; the initial population is
    /// always evaluated.
    pub evaluations: Option<u64>,
    /// Generations after the initial population.
    pub generations: Option<u64>,
    /// Wall time, resumed runs included. A generation in progress is finished.
    pub time: Option<Duration>,
    /// Cost that is good enough.
    pub target: Option<f64>,
    /// Generations without progress.
    pub stagnation: Option<Stagnation>,
}

/// A run stagnates when its best cost has not fallen by more than `tolerance` times its magnitude
/// within `generations` generations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stagnation {
    /// Number of generations.
    pub generations: u64,
    /// Relative improvement that counts as progress.
    pub tolerance: f64,
}

impl Budget {
    /// A budget of evaluations.
    pub fn evaluations(evaluations: u64) -> Self {
        Self { evaluations: Some(evaluations), ..Self::default() }
    }

    /// A budget of generations.
    pub fn generations(generations: u64) -> Self {
        Self { generations: Some(generations), ..Self::default() }
    }

    /// A budget of wall time.
    pub fn time(time: Duration) -> Self {
        Self { time: Some(time), ..Self::default() }
    }

    /// Adds a limit of evaluations.
    #[must_use]
    pub fn with_evaluations(self, evaluations: u64) -> Self {
        Self { evaluations: Some(evaluations), ..self }
    }

    /// Adds a limit of generations.
    #[must_use]
    pub fn with_generations(self, generations: u64) -> Self {
        Self { generations: Some(generations), ..self }
    }

    /// Adds a limit of wall time.
    #[must_use]
    pub fn with_time(self, time: Duration) -> Self {
        Self { time: Some(time), ..self }
    }

    /// Ends the run at a cost of `target` or less.
    #[must_use]
    pub fn with_target(self, target: f64) -> Self {
        Self { target: Some(target), ..self }
    }

    /// Ends the run after `generations` generations without progress.
    #[must_use]
    pub fn with_stagnation(self, generations: u64, tolerance: f64) -> Self {
        Self { stagnation: Some(Stagnation { generations, tolerance }), ..self }
    }
}

/// Why a run ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum StopReason {
    /// The target cost was reached.
    Target,
    /// The evaluations were used up.
    Evaluations,
    /// The generations were used up.
    Generations,
    /// The time was used up.
    Time,
    /// There was no progress for long enough.
    Stagnation,
    /// The stop flag was set, or the problem broke an evaluation off.
    Interrupted,
    /// The algorithm itself saw no point in going on.
    Exhausted(String),
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Target => f.write_str("target reached"),
            Self::Evaluations => f.write_str("evaluations used up"),
            Self::Generations => f.write_str("generations used up"),
            Self::Time => f.write_str("time used up"),
            Self::Stagnation => f.write_str("no progress"),
            Self::Interrupted => f.write_str("interrupted"),
            Self::Exhausted(why) => write!(f, "exhausted: {why}"),
        }
    }
}
