//! What was compared, and what came of it: the record that a user can read.

use serde::{Deserialize, Serialize};

use super::refusal::Refusal;

/// What came of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// It stands in the result.
    Added,
    /// It is as good as what stands in the result.
    AsGood,
    /// It gains too little over what it was compared with.
    TooLittle,
    /// Another one is better.
    Worse,
    /// Another shape of an effect does it instead.
    OtherShape,
    /// A parameter ended at a limit of its search or the data do not determine it.
    NotIdentifiable,
    /// It was no longer needed beside the others.
    Dropped,
    /// It stands for no effect, but does what the effects that it was compared with do.
    Rival,
}

/// Why a comparison came out as it did, or what was compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Reason {
    /// The candidate is the best set of its size.
    BestOfSize,
    /// The candidate does without an effect, and as well.
    AsGoodWithout,
    /// The model without the effect that goes errs less than the sensors make, in whose units the effect gains too little.
    WithinSensors,
    /// The prediction error is no lower with the effect that goes.
    ErrorNoLower,
    /// Beside errors that are not the sensors' the effect that goes gains here and loses there.
    NotRecurring,
    /// The effect that goes rings wherever the system moves, but gains too little where that moves fast.
    AtRest,
    /// The effect that goes rings, but gains too little beside what the errors foretell themselves.
    Colour,
    /// An autoregression of the errors foretells what the effect that goes gains.
    Foretold,
    /// Chance gains as much as the effect that goes.
    Chance,
    /// The candidate has an effect in its plain form.
    PlainForm,
    /// The candidate has what every system of its kind has in the place of an effect.
    Usual,
    /// The candidate has simpler effects in the place of one.
    Simpler,
    /// The candidate has another law of a usual effect of the base, which leaves nothing of that one.
    OtherLaw,
    /// Something that stands for no effect was asked.
    Rival {
        /// What it is.
        rival: String,
    },
    /// What was fitted is no such effect.
    Refused {
        /// Why.
        refusal: Refusal,
    },
    /// Prediction errors that are no numbers.
    NotFinite,
}

/// One comparison.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// Number of effects beside the base.
    pub rung: usize,
    /// Effects of the candidate model.
    pub candidate: Vec<String>,
    /// Effects of the model that it was compared with.
    pub compared_with: Vec<String>,
    /// Held-out log-likelihood of the candidate less that of the other, nats; of a part of a long recording as much as
    /// it stands for on all of it.
    pub difference: f64,
    /// Standard error of it, from blocks of 2 s.
    pub standard_error: f64,
    /// Prediction error of the candidate over what the sensors alone make.
    pub budget: f64,
    /// What came of it.
    pub outcome: Outcome,
    /// Why, where the numbers do not say it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because: Option<Reason>,
}
