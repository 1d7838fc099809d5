//! Models compared by what they predict one sample ahead.
//!
//! Everything here rests on the prediction errors of models, each at the process noise that suits it best, in
//! units of what the sensors alone would leave. [`node`] is a fitted model, [`fit`] fits one, [`compare`] says
//! which of two is better, [`screen`] which candidates are worth a fit; [`discover`] searches sets of effects. A family
//! that says at once what a whole recording should be is seen through its [`Residuals`].

mod astray;
pub mod autoregression;
mod beam;
pub mod chance;
pub mod compare;
pub mod fit;
mod foretold;
mod found;
mod input_noise;
mod intervals;
mod law;
mod local;
mod looks;
pub mod node;
mod predictive;
pub mod quick;
mod reading;
mod refused;
mod report;
mod residuals;
mod scales;
pub mod screen;
mod sought;
pub mod statistics;
#[cfg(test)]
pub(crate) mod testing;
mod which_reading;
pub mod whitening;

pub use beam::ByHand;
pub use looks::discover;
pub use reading::Reading;
pub use residuals::Residuals;

pub use crate::family::{Ahead, Columns, Rival, Trial, trials};
pub use crate::task::Thresholds;
