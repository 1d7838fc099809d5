//! The force that a model lacks, as it is told.

use serde::{Deserialize, Serialize};

use super::residual_map::ResidualMap;

/// How large the force is that a model lacks, and where. Only instants at which it is known count.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MissingForce {
    /// SI unit of the forces.
    pub unit: String,
    /// Root mean square of the missing force.
    pub rms: f64,
    /// Root mean square of the recorded force at the same instants.
    pub recorded: f64,
    /// The one over the other.
    pub share: f64,
    /// Root mean square of the half-widths of its 95 % bands.
    pub band: f64,
    /// Share of the time at which it is known, 0..1.
    pub known: f64,
    /// Instants, s, at most 4000; those at which it is not known are left out.
    pub time: Vec<f64>,
    /// Missing force at them.
    pub force: Vec<f64>,
    /// Half-width of its 95 % band at them.
    pub half_width: Vec<f64>,
    /// Its mean along the coordinates of the state.
    pub maps: Vec<ResidualMap>,
}
