//! False alarms on surrogates of a recording: what the last model would have made, its own errors in another order.
//!
//! The errors of real axes are never white, so that no formula gives the rate of false alarms there. Surrogates hold
//! nothing beyond the last model: what a discovery that begins with it names in them is one.

use serde::{Deserialize, Serialize};

/// What discoveries named in surrogates, where there was nothing to name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Surrogates {
    /// Number of surrogates that were asked for.
    pub asked: usize,
    /// Number of them that were searched to the end: of the others nothing is known.
    pub count: usize,
    /// Effects named in those in which any were.
    pub named: Vec<Vec<String>>,
}
