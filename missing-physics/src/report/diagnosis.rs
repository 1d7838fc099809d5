//! What the residual of a model says by itself.

use serde::{Deserialize, Serialize};

use super::residual_map::ResidualMap;

/// What the residual of a model says.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// Whether it resembles itself; nothing where there are too few points to tell.
    pub whiteness: Option<Whiteness>,
    /// Whether it follows an input: one entry for each coordinate of the state, smallest p-value first.
    pub independence: Vec<Independence>,
    /// The mean residual along each coordinate.
    pub maps: Vec<ResidualMap>,
    /// Lines of its spectra over time and along coordinates.
    pub lines: Vec<Line>,
}

/// Whether a residual resembles itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Whiteness {
    /// Time between lags, s.
    pub interval_s: f64,
    /// Autocorrelation at lag 1, 2, ...
    pub autocorrelation: Vec<f64>,
    /// What white noise would have after the comparison's smoothing.
    pub expected: Vec<f64>,
    /// Half-width of the 95 % band around that, lag by lag.
    pub bound: Vec<f64>,
    /// The statistic, chi-squared where the residual is white.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Chance of as large a statistic where the residual is white.
    pub p_value: f64,
    /// Time after which the autocorrelation first lies inside its band, s; nothing where it does not
    /// within the lags looked at.
    pub memory_s: Option<f64>,
}

/// Whether a residual follows an input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Independence {
    /// The input.
    pub input: String,
    /// Time by which the residual comes after the input, s; negative where it comes before.
    pub lag_s: Vec<f64>,
    /// Correlation at each lag.
    pub correlation: Vec<f64>,
    /// Half-width of the 95 % band at each lag.
    pub bound: Vec<f64>,
    /// Lag at which the correlation stands out most, s.
    pub worst_lag_s: f64,
    /// Correlation there.
    pub worst: f64,
    /// Chance of as much at any lag where the residual does not depend on the input.
    pub p_value: f64,
}

/// A line that another one is told by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LineOf {
    /// `time`, or the coordinate along which it is periodic.
    pub along: String,
    /// Period, in `unit`.
    pub period: f64,
    /// SI unit of the period.
    pub unit: String,
}

/// What a line has to do with another one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Relation {
    /// The same period is stronger along another coordinate.
    StrongerAlong {
        /// The coordinate.
        coordinate: String,
    },
    /// A harmonic.
    Harmonic {
        /// Whole number of periods in one of the fundamental.
        order: u32,
        /// The fundamental.
        of: LineOf,
    },
    /// Another line, seen while the coordinate changes at one rate.
    SeenAt {
        /// The other line.
        of: LineOf,
        /// The rate, in `unit`.
        rate: f64,
        /// SI unit of the rate.
        unit: String,
    },
}

/// A line of a spectrum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// `time`, or the coordinate along which the residual is periodic.
    pub along: String,
    /// Period, in `unit`.
    pub period: f64,
    /// SI unit of the period.
    pub unit: String,
    /// Amplitude in the unit of the compared quantity.
    pub amplitude: f64,
    /// Chance of such a line anywhere in a spectrum without lines.
    pub p_value: f64,
    /// What it has to do with another line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relation: Option<Relation>,
}
