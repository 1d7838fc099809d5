//! Where a model fails and what its residual says: for people. Nothing here decides.

mod comparison;
mod errors;
pub mod generic;
mod missing_force;
pub mod noise;
mod residual;
mod residual_map;
pub(crate) mod spectrum;
pub mod views;
pub mod where_it_fails;

pub use comparison::{comparison, fitted_blocks, rung};
pub use errors::{errors, relative_key};
pub use residual::{attach, diagnose};
