//! What a discovery found, as data: the JSON contract that scripts rely on.
//!
//! Adding a field is fine, renaming one is not. Everything is a number, a name or one of a few kinds; where the JSON has a
//! sentence (`summary`, `notes`, `reason` of a decision) `aep-studio` makes it of these. Keys of the maps (`force_rms_N`, `window_rms_m`, ...)
//! are named by the model family.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::candidate::{Candidate, DetectionLimit};
use super::confirmation::Confirmed;
use super::decision::Decision;
use super::diagnosis::Diagnosis;
use super::missing_force::MissingForce;
use super::place::{RegimeShare, Where};
use super::plot::Plot;
use super::remains::Remains;
use super::remark::Remark;
use super::rung::Rung;
use super::surrogates::Surrogates;
use super::verdict::{Ambiguity, Budget, Verdict};
use super::view::View;

/// The whole result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Discovery {
    /// What the data say.
    pub verdict: Verdict,
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
    /// Size of each effect that would have been seen, by effect.
    #[serde(default)]
    pub detection_limits: BTreeMap<String, DetectionLimit>,
    /// Every comparison of two models, and what came of it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub decisions: Vec<Decision>,
    /// What the sensors make of the prediction error, and what is left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub budget: Option<Budget>,
    /// Effects that were not tried because time ran out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub untried: Vec<String>,
    /// Whether the search was cut before its end: what is told is what was found until then.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stopped: bool,
    /// Seed of every random choice.
    pub seed: u64,
    /// Time taken, s.
    pub wall_s: f64,
    /// What keeps the last model incomplete beside its prediction error, the largest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remains: Vec<Remains>,
    /// The effect that is most likely missing, where it was asked for and nothing was to be added.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub most_likely: Option<String>,
    /// What the user should know: doubts about the data, limits of the verdict.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<Remark>,
    /// What whoever asked has to say besides, in words of its own.
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
