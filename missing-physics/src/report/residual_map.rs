//! The mean residual along a coordinate, as it is told.

use serde::{Deserialize, Serialize};

/// The mean residual in one bin of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapBin {
    /// Mean of the coordinate.
    pub at: f64,
    /// Mean of the residual.
    pub mean: f64,
    /// Lower end of the 95 % band.
    pub low: f64,
    /// Upper end of the 95 % band.
    pub high: f64,
    /// Points in the bin.
    pub points: usize,
}

/// The mean residual along a coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ResidualMap {
    /// The coordinate.
    pub coordinate: String,
    /// Its SI unit.
    pub unit: String,
    /// True where the residual counts as positive when it opposes the motion.
    pub against_motion: bool,
    /// Bins with about the same number of points, in order.
    pub bins: Vec<MapBin>,
}
