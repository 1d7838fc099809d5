//! Models fitted to the compared quantity: a search for the valley, a refinement to its bottom, intervals.

mod refine;
mod search;
pub mod uncertainty;
mod until;

pub use refine::{Fit, as_given, evaluate, predict, refine, residual, weighted_square};
pub use search::shaped;
pub use search::{Found, identify, identify_by};
pub use until::Until;
