//! A recording and its models sample by sample: what a page draws.

use serde::Serialize;

/// A recording sample by sample, with what each model of a ladder makes of it. All series are as long as `time`; a value
/// that is not known is not a number.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Samples {
    /// Instants, s, increasing within a piece.
    pub time: Vec<f64>,
    /// The piece of the recording that each sample belongs to, from 1; nothing is known between pieces.
    pub piece: Vec<i64>,
    /// Names of the regimes of the motion.
    pub regimes: Vec<String>,
    /// The regime of each sample, as an index into `regimes`.
    pub regime: Vec<usize>,
    /// Why samples take no part in a comparison.
    pub reasons: Vec<String>,
    /// What the residual may depend on, measured or from the measured motion.
    pub coordinates: Vec<Track>,
    /// What is compared, that which decides last.
    pub compared: Vec<Compared>,
    /// What each effect of the last model contributes, with the data beside it.
    pub laws: Vec<Law>,
}

/// A quantity over time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Track {
    /// Name, e.g. `velocity`.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Its values.
    pub values: Vec<f64>,
    /// True where a residual along it counts as positive when it opposes the motion.
    pub against_motion: bool,
}

/// A measured quantity and what each model predicts of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// Name, e.g. `force`.
    pub name: String,
    /// How it is compared, in words.
    pub about: String,
    /// SI unit.
    pub unit: String,
    /// What was measured.
    pub measured: Vec<f64>,
    /// What is predicted, one series for each model of the ladder.
    pub predicted: Vec<Vec<f64>>,
    /// The reason why a sample takes no part, as an index into [`Samples::reasons`]; nothing where it does.
    pub left_out: Vec<Option<usize>>,
    /// Whether models are chosen by it.
    pub decides: bool,
}

/// A component-plus-residual plot: what an effect contributes to the prediction along a coordinate, and the same with what
/// the model leaves, which is what the data say of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Law {
    /// The effect.
    pub effect: String,
    /// The coordinate, in words.
    pub along: String,
    /// Its SI unit.
    pub unit: String,
    /// The quantity that it contributes to, with its SI unit.
    pub quantity: [String; 2],
    /// True where contributions count as positive when they oppose the motion.
    pub against_motion: bool,
    /// Means over stretches of the coordinate, in order.
    pub bins: Vec<LawBin>,
}

/// Means over a stretch of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LawBin {
    /// Mean of the coordinate.
    pub at: f64,
    /// Mean of what the effect contributes.
    pub law: f64,
    /// The same and the mean of what the model leaves.
    pub data: f64,
}
