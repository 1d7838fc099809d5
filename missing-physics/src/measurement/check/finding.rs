//! What follows from a look at a recording, as kinds with numbers.

use serde::{Deserialize, Serialize};

use super::sampling::Gap;

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Good to know.
    Info,
    /// Limits what can be found.
    Warning,
    /// Nothing trustworthy can be found like this.
    Serious,
}

/// One thing that limits the analysis of a recording, or is good to know. Numbers are in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Finding {
    /// Holes in the samples.
    Gaps {
        /// How many.
        count: usize,
        /// The longest one.
        longest: Gap,
        /// Whether it ends a segment; a shorter one is bridged by straight lines.
        ends_a_segment: bool,
    },
    /// So few samples that the time may be in another unit.
    SlowSampling {
        /// Median interval, s.
        interval_s: f64,
    },
    /// The intervals vary.
    Jitter {
        /// Root mean square of their deviation as a fraction of the median.
        jitter: f64,
        /// The median, s.
        interval_s: f64,
    },
    /// Every sample of a channel has the same value.
    Constant {
        /// Name of the channel.
        channel: String,
        /// The value.
        value: f64,
        /// Unit of the value.
        unit: String,
        /// Whether nothing can be said of a drive without this channel.
        needed: bool,
    },
    /// A channel is held at a limit.
    Clipped {
        /// Name of the channel.
        channel: String,
        /// The limit.
        level: f64,
        /// Unit of the limit.
        unit: String,
        /// Share of the samples, 0..1.
        share: f64,
    },
    /// The force takes energy out of the axis, as none does that moves it against friction.
    NegativeWork {
        /// Sum of force times way over the sum of their sizes, -1..0.
        share: f64,
    },
    /// No axis moves so fast.
    Fast {
        /// Speed that is exceeded in 1 % of the samples.
        top: f64,
        /// Unit of the speed.
        unit: String,
    },
    /// The axis moves in one direction: friction and a constant force cannot be told apart.
    OneDirection,
    /// The direction changes too rarely to be sure of what happens there.
    FewReversals {
        /// Changes of direction.
        reversals: usize,
    },
    /// The position is counted.
    Counts {
        /// Size of one count.
        count: f64,
        /// Unit of the count.
        unit: String,
        /// Speed of one count a sample.
        step: f64,
        /// Speed that is exceeded in 1 % of the samples.
        top: f64,
        /// Unit of the speeds.
        speed_unit: String,
        /// Whether one count a sample is coarse against the motion.
        coarse: bool,
    },
    /// How the axis moves.
    Speeds {
        /// Speed that is exceeded in 1 % of the samples.
        top: f64,
        /// Speed below which the motion is slow.
        slow: f64,
        /// Unit of the speeds.
        unit: String,
        /// Share of the samples that are slow, 0..1.
        slow_share: f64,
        /// Changes of direction.
        reversals: usize,
    },
    /// The motion repeats.
    Repeats {
        /// Length of a cycle, s.
        period_s: f64,
        /// Whole cycles.
        cycles: usize,
        /// Root mean square of what differs in the force from cycle to cycle, over the square root of two.
        force: Option<f64>,
        /// Unit of the force.
        force_unit: String,
    },
}

impl Finding {
    /// How much it matters.
    pub fn severity(&self) -> Severity {
        match self {
            Self::Constant { needed: true, .. } => Severity::Serious,
            Self::Gaps { .. }
            | Self::SlowSampling { .. }
            | Self::Jitter { .. }
            | Self::Clipped { .. }
            | Self::NegativeWork { .. }
            | Self::Fast { .. }
            | Self::OneDirection
            | Self::FewReversals { .. }
            | Self::Counts { coarse: true, .. } => Severity::Warning,
            Self::Constant { .. }
            | Self::Counts { .. }
            | Self::Speeds { .. }
            | Self::Repeats { .. } => Severity::Info,
        }
    }
}
