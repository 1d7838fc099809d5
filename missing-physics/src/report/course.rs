//! What something that varies freely was found to be.

use serde::{Deserialize, Serialize};

use super::candidate::NamedValue;

/// How a free term runs over time or along a coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Course {
    /// It changes once.
    Step {
        /// By this much, in `unit`.
        change: f64,
        /// At this time or place, in `along_unit`.
        at: f64,
        /// SI unit of the change.
        unit: String,
        /// SI unit of time or place.
        along_unit: String,
    },
    /// It swings.
    Wave {
        /// By so much to either side, in `unit`.
        amplitude: f64,
        /// Once in this time or way, in `along_unit`.
        period: f64,
        /// SI unit of the amplitude.
        unit: String,
        /// SI unit of time or place.
        along_unit: String,
    },
    /// It may change anywhere.
    Varies {
        /// Largest less smallest value, in `unit`.
        range: f64,
        /// Where it changes most: from here, in `along_unit`,
        from: f64,
        /// to here.
        to: f64,
        /// SI unit of the range.
        unit: String,
        /// SI unit of time or place.
        along_unit: String,
    },
    /// It has no course; its parameters.
    Values {
        /// Each with its unit.
        values: Vec<NamedValue>,
    },
}
