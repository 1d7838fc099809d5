//! Why what was fitted is no such effect.

use serde::{Deserialize, Serialize};

use super::candidate::NamedValue;

/// Why a fitted effect is not named, however much it gains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Refusal {
    /// Beside it nothing is left of what every model has.
    NothingLeft {
        /// `term.parameter` that is gone.
        parameter: String,
    },
    /// An amplitude ended at the limit of its search.
    AtLimit {
        /// `effect.parameter`.
        parameter: String,
    },
    /// A value is where the effect no longer is that effect (a gap of no width).
    NotThatEffect {
        /// Name of the effect.
        effect: String,
        /// The value, by the name of its parameter or of what the effect makes of several.
        value: NamedValue,
        /// What it was held against, in the unit of the value.
        limit: f64,
        /// What that means, as the effect says it.
        meaning: String,
    },
    /// The data do not tell a value that makes it that effect.
    Unknown {
        /// `effect.parameter`.
        parameter: String,
        /// Lower end of its 95 % interval.
        low: f64,
        /// Upper end of its 95 % interval.
        high: f64,
        /// Unit of both.
        unit: String,
    },
    /// It is so small a share of what a given input has of it that filters make as much.
    ShareOfGiven {
        /// Name of the effect.
        effect: String,
        /// The share.
        share: f64,
        /// Least share that counts.
        least: f64,
    },
    /// It makes so small a share of the compared quantity that filters make as much.
    ShareOfQuantity {
        /// Name of the effect.
        effect: String,
        /// The share.
        share: f64,
        /// Least share that counts.
        least: f64,
    },
    /// It makes no more than noise that moves the axis can.
    WithinNoise {
        /// Name of the effect.
        effect: String,
        /// Root mean square of what it makes of the compared quantity.
        change: f64,
        /// Root mean square of the noise.
        noise: f64,
        /// Unit of both.
        unit: String,
    },
    /// It shifts in time by no more than the samples may.
    WithinSamples {
        /// Name of the effect.
        effect: String,
        /// Number of samples.
        samples: f64,
    },
}
