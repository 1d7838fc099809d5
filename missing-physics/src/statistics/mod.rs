//! What residuals and their parts say, as numbers: no model, no family.

pub mod autocorrelation;
pub mod basis;
pub(crate) mod bins;
pub mod in_time;
pub mod metrics;
pub mod periodogram;
pub mod placebo;
pub mod residual_tests;
pub(crate) mod signed_ranks;
pub mod split;
mod weights;

pub use weights::weights;
