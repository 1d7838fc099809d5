//! Tells what a model lacks.
//!
//! A measurement is compared with a model; the residual shows *where* the model fails, a screening of
//! candidate terms shows *which* one is missing, and a ladder of refits shows what each of them gains
//! on held-out data. The engine knows nothing of friction or any other subject: it works for every
//! [`ModelFamily`].

pub mod ahead;
pub mod autocorrelation;
pub mod basis;
mod climb;
pub mod confirm;
pub mod data_check;
pub mod diagnosis;
pub mod discover;
pub mod evidence;
pub mod family;
pub mod fit;
pub mod generic;
pub mod in_time;
pub mod ladder;
mod limits;
pub mod metrics;
pub mod missing_force;
pub mod noise;
pub mod pairs;
pub mod placebo;
pub mod quantity;
pub mod recording;
pub mod report;
pub mod residual_map;
pub mod residual_tests;
pub mod screen;
pub mod search;
pub mod shapes;
pub mod spectrum;
pub mod split;
pub mod surrogates;
mod tried;
pub mod uncertainty;
pub mod verdict;
pub mod views;
pub mod where_it_fails;

pub use discover::{DiscoverError, Event, Observer, Settings, discover, suggest};
pub use family::{Coordinate, Fitted, ModelFamily, Parameter, Quantity, Regime, Role, Term};
pub use recording::{Channel, Hold, Recording, RecordingError};
pub use report::Discovery;

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
