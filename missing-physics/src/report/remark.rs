//! What a user should know beside a verdict.

use serde::{Deserialize, Serialize};

use super::refusal::Refusal;
use super::remains::NoCause;
use crate::measurement::Hold;

/// A force that is lacking with and without effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lacking {
    /// Root mean square without them.
    pub base: f64,
    /// With them.
    pub last: f64,
    /// SI unit of both.
    pub unit: String,
}

/// A doubt about the data, a limit of the verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Remark {
    /// Effects gain enough and are not named.
    NotNamed {
        /// The effects.
        effects: Vec<String>,
        /// Why.
        refusal: Refusal,
    },
    /// A search on parts of the recording found an effect that gains too little on all of it or lowers no error
    /// there.
    FoundInPartOnly {
        /// The effect.
        effect: String,
    },
    /// Time ran out before what a search on parts of the recording found was asked of all of it.
    Unconfirmed {
        /// Share of the recording that was searched.
        share: f64,
    },
    /// The last model errs so much less than the sensors are said to that their noise was taken as too large.
    SensorsBetter {
        /// Prediction error of the last model in multiples of what the sensors make.
        times: f64,
    },
    /// The last model errs more than the sensors make it, and as much as noise of the input does that the recording does not hold:
    /// what it leaves is white.
    InputNoise {
        /// The input.
        input: String,
        /// Standard deviation of that noise from sample to sample.
        deviation: f64,
        /// Its SI unit.
        unit: String,
    },
    /// Time ran out, or Ctrl-C came, after the search: maps and tests of the residual were left out.
    ToldInBrief,
    /// Of a very long recording pieces spread over it were looked at.
    InPieces {
        /// Samples of all of it.
        samples: usize,
        /// Samples of the pieces.
        looked_at: usize,
        /// Number of the pieces.
        pieces: usize,
    },
    /// A usual effect of the base model follows another law here, which leaves nothing of it: that stands in the base
    /// model and counts as no effect that is missing.
    OtherLaw {
        /// The effect of the base model.
        of: String,
        /// The effect that is its law here.
        law: String,
        /// What the base model gains by it, nats.
        nats: f64,
    },
    /// What makes the input late is no more than what it does between two samples may: it belongs to how the recording is
    /// read, stands in the base model and counts as no effect that is missing.
    OfReading {
        /// The effect that stands for it.
        effect: String,
        /// How late, and how late the reading may be.
        refusal: Refusal,
        /// What the base model gains by it, nats.
        nats: f64,
    },
    /// Effects come nearest and are not the cause.
    NotTheCause {
        /// The effects.
        effects: Vec<String>,
        /// Prediction error of the base model in multiples of what the sensors make.
        base: f64,
        /// With the effects.
        last: f64,
        /// The force that is lacking, where that is why.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        lacking: Option<Lacking>,
        /// What else speaks against them.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        because: Option<NoCause>,
    },
    /// Nothing was named, and there was no time to search more than pieces of the recording.
    SearchedInPieces {
        /// The pieces as a share of it.
        share: f64,
    },
    /// How the input was read between samples, where nobody said it.
    Read {
        /// The input.
        input: String,
        /// How it acts between samples.
        hold: Hold,
        /// Log-likelihood of the simplest model over that in the other reading, nats.
        nats: f64,
        /// Whether that is too little, so that the search decided.
        by_search: bool,
    },
    /// The noise of the input was smoothed away: models predict better so, and better than with an
    /// effect that makes it late.
    Smoothed {
        /// The input.
        input: String,
        /// Cut-off of the filter, Hz.
        below: f64,
    },
    /// Samples of a long recording follow each other faster than the position tells them apart from its noise: several were
    /// taken together, the input averaged over them.
    TakenTogether {
        /// The input.
        input: String,
        /// Number of samples.
        every: usize,
        /// Time from one that was looked at to the next, s.
        apart: f64,
    },
    /// The time stamps jitter and the position does not move by them: the samples were taken as even.
    EvenSamples {
        /// Root mean square of what the stamps were off, samples.
        jitter: f64,
    },
    /// Another model gives the input.
    Given {
        /// The input.
        input: String,
        /// Shift in time that its samples and filters may make, samples.
        most_shift: f64,
    },
}
