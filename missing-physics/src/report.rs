//! What a discovery found, as data: the JSON contract that scripts rely on.
//!
//! Adding a field is fine, renaming one is not. Keys of the maps (`force_rms_N`, `window_rms_m`, ...)
//! are named by the model family.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::ahead::decision::Decision;
use crate::confirm::Confirmed;
use crate::diagnosis::Diagnosis;
use crate::metrics::SplitMetrics;
use crate::missing_force::MissingForce;
use crate::surrogates::Surrogates;
use crate::views::View;

/// What the data say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// One or more effects were found and added.
    EffectsFound,
    /// The base model explains the data down to what noise does.
    NothingMissing,
    /// Structure remains that no candidate explains.
    Unexplained,
    /// Several candidates explain it equally well on this data.
    Ambiguous,
    /// The search was cut short before anything could be said.
    Stopped,
}

/// What the sensors make of the prediction error, and what the models leave.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Budget {
    /// Prediction error that the sensors alone make: a standard deviation, m or rad.
    pub expected: f64,
    /// Prediction error of the base model, in multiples of it.
    pub base: f64,
    /// Prediction error of the last model, in multiples of it.
    pub last: f64,
    /// Whether the last model leaves no more than sensors make.
    pub complete: bool,
}

/// A parameter with its interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the 95 % interval.
    pub low: f64,
    /// Upper end of the 95 % interval.
    pub high: f64,
    /// SI unit.
    pub unit: String,
    /// False where the data do not determine the value.
    pub identifiable: bool,
}

/// An error on the blocks that were fitted and on those held out.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SplitError {
    /// On the blocks used for fitting.
    pub fit: f64,
    /// On the held-out blocks.
    pub validation: f64,
}

/// One rung of the ladder: a structure, its parameters, its errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rung {
    /// The effect added on this rung (several, joined with `+`, where they only help together);
    /// nothing on the base rung.
    pub added: Option<String>,
    /// Every effect of the model on this rung.
    pub effects: Vec<String>,
    /// `effect.parameter` -> estimate.
    pub parameters: BTreeMap<String, Estimate>,
    /// Name of the error -> its size on fitted and held-out data.
    pub error: BTreeMap<String, SplitError>,
    /// Chance that a term with no part in the data gains as much; nothing on the base rung.
    pub p_value: Option<f64>,
    /// The error of the compared quantity in its usual measures.
    #[serde(default)]
    pub metrics: Option<SplitMetrics>,
    /// Held-out log-likelihood of the prediction errors over that of the rung below, nats.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood_gain: Option<f64>,
    /// Prediction error in multiples of what the sensors alone make.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<f64>,
}

/// How well a candidate would explain what the model of a rung leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Name of the effect.
    pub effect: String,
    /// Share of the held-out squared error that it removes, 0..1 (negative: it makes it worse).
    pub gain: f64,
    /// Chance of as large a gain by any effect of the library where none is missing.
    pub p_value: f64,
    /// Size with unit, in words: "8.2 N at 1.1 mm/s".
    #[serde(default)]
    pub size: String,
    /// Held-out log-likelihood that it gains, nats; to first order where it was not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nats: Option<f64>,
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
    /// In words.
    pub note: String,
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

/// Effects that this data cannot tell apart.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ambiguity {
    /// Names of the effects.
    pub effects: Vec<String>,
    /// The experiment that would tell them apart.
    pub experiment: String,
}

/// A curve or a cloud of the report page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// Label of the abscissa, with unit.
    pub x_label: String,
    /// Label of the ordinate, with unit.
    pub y_label: String,
    /// The curves, all on the same axes.
    pub curves: Vec<Curve>,
}

/// One curve of a [`Plot`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name in the legend.
    pub label: String,
    /// Abscissa.
    pub x: Vec<f64>,
    /// Ordinate, as long as `x`.
    pub y: Vec<f64>,
}

/// The whole result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Discovery {
    /// What the data say.
    pub verdict: Verdict,
    /// The verdict in one or two sentences.
    #[serde(default)]
    pub summary: String,
    /// Effects in the order added.
    pub added: Vec<String>,
    /// From the base model up.
    pub ladder: Vec<Rung>,
    /// One list per rung, best first.
    pub ranking: Vec<Vec<Candidate>>,
    /// Where the last model fails (the base model's is in `where_base`).
    #[serde(rename = "where")]
    pub where_it_fails: Vec<Where>,
    /// Where the base model fails.
    #[serde(default)]
    pub where_base: Vec<Where>,
    /// Shares by regime of the square of the last model's missing force, where that is known; else of its error.
    #[serde(default)]
    pub regimes: Vec<RegimeShare>,
    /// The same of the base model.
    #[serde(default)]
    pub regimes_base: Vec<RegimeShare>,
    /// The force that the last model lacks, where the family can tell.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing_force: Option<MissingForce>,
    /// The force that the base model lacks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub missing_force_base: Option<MissingForce>,
    /// Effects that this data cannot tell apart.
    pub ambiguous: Vec<Ambiguity>,
    /// Where structure remains that no effect explains: a term, as text to save and to add, that
    /// describes it.
    #[serde(default)]
    pub generic_term: Option<String>,
    /// What other recordings say of the ladder, where there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confirmation: Option<Confirmed>,
    /// How many false alarms surrogates of the recording gave, where they were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub surrogates: Option<Surrogates>,
    /// Size of the error that no model can remove, by quantity.
    pub noise_floor: BTreeMap<String, f64>,
    /// Size of each effect that would have been seen, in words, by effect.
    #[serde(default)]
    pub detection_limits: BTreeMap<String, String>,
    /// Every comparison of two models, and what came of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub decisions: Vec<Decision>,
    /// What the sensors make of the prediction error, and what is left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Effects that were not tried because time ran out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untried: Vec<String>,
    /// Seed of every random choice.
    pub seed: u64,
    /// Time taken, s.
    pub wall_s: f64,
    /// Things the user should know: doubts about the data, limits of the verdict.
    #[serde(default)]
    pub notes: Vec<String>,
    /// What the residual of the last model says by itself.
    #[serde(default)]
    pub diagnosis: Option<Diagnosis>,
    /// The same of the base model, where it is another one.
    #[serde(default)]
    pub diagnosis_base: Option<Diagnosis>,
    /// The errors of the last model in several views, where they were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub views: Vec<View>,
    /// Curves for the page; not part of the JSON contract.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plots: Vec<Plot>,
}
