//! Structure along a coordinate that no effect explains.

use crate::statistics::in_time::Structure;

/// A shape along one coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Generic {
    /// Along time: a step or a swing.
    InTime(Structure),
    /// Something at one place of the range.
    Bump {
        /// Where, in the coordinate's unit.
        place: f64,
        /// Mean residual there.
        height: f64,
        /// Length of the whole range, in the coordinate's unit.
        range: f64,
    },
    /// A smooth dependence over the whole range.
    Profile {
        /// Lower end of the range.
        low: f64,
        /// Upper end.
        high: f64,
    },
}
