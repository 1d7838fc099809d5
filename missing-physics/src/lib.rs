//! Tells what a model lacks.
//!
//! A measurement is compared with a model; what the model leaves shows *where* it fails, a search among
//! candidate terms shows *which* one is missing, and a ladder of refits shows what each of them gains on
//! held-out data. The engine knows nothing of friction or any other subject: it works for every
//! [`ModelFamily`].
//!
//! # A tour
//!
//! Arrows point down this list; a room imports rooms below it, never one above.
//!
//! | room | what is in it |
//! |---|---|
//! | [`discover`], [`suggest`], [`confirm`], [`identify`], [`extend`] | the ways in: search, look once, try on another recording, fit a given model |
//! | [`ahead`] | what decides, from errors one sample ahead: fit, compare, screen, search sets, tell |
//! | `task` | what is asked: [`Settings`], [`Thresholds`], [`Event`]s for an [`Observer`] |
//! | [`diagnosis`] | where a model fails and what its residual says: shown to people, decides nothing |
//! | [`fit`] | least squares of a model on the compared quantity, intervals |
//! | [`family`] | the seam to a subject: [`ModelFamily`], [`Term`], [`family::Ahead`] |
//! | [`statistics`] | residuals as numbers: surrogate data, spectra, tests, splits |
//! | [`report`] | result types: a [`Discovery`] and its parts, the JSON contract |
//! | [`measurement`] | [`Recording`] and what is to be known of it before any model |

pub mod ahead;
mod confirm;
pub mod diagnosis;
mod discover;
pub mod family;
pub mod fit;
mod identify;
pub mod measurement;
mod predicted;
pub mod report;
pub mod statistics;
mod task;

pub use confirm::confirm;
pub use discover::{discover, likely, suggest};
pub use family::{
    ComparedQuantity, Coordinate, Fitted, FnFamily, Given, ModelFamily, Regime, Role, Term,
    TermParameter,
};
pub use identify::{Extended, extend, identify};
pub use measurement::{Channel, Hold, Recording, RecordingError};
pub use predicted::prediction_fit;
pub use report::Discovery;
pub use task::{DiscoverError, Event, Observer, Settings, Thresholds, model_of, terms};

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
