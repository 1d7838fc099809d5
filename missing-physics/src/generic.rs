//! What structure along a coordinate looks like, for a term that describes it without explaining it.

use crate::family::Coordinate;
use crate::in_time::{Structure, Trials};
use crate::where_it_fails::{Bins, only_grows, parity};

/// A structure is at one place where fine bins explain more than coarse ones by this share.
const LOCAL: f64 = 0.2;

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

/// The shape of a residual along a coordinate.
pub fn shape(coordinate: &Coordinate, residual: &[f64]) -> Generic {
    let seen = parity(coordinate, residual, &vec![1.0; residual.len()]);
    let values = &coordinate.values;
    if only_grows(coordinate) {
        return Generic::InTime(Trials::new(values).best(&seen).1);
    }
    let (low, high) =
        values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
    let (coarse, fine) = (Bins::new(values), Bins::fine(values));
    match fine.peak(values, &seen) {
        Some((place, height)) if fine.explained(&seen) > coarse.explained(&seen) + LOCAL => {
            Generic::Bump { place, height, range: high - low }
        }
        _ => Generic::Profile { low, high },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dent_is_a_bump_and_a_slope_is_a_profile() {
        let values: Vec<f64> = (0..2000).map(|k| (f64::from(k) * 0.37).sin()).collect();
        let along = |law: fn(f64) -> f64| {
            let coordinate = Coordinate {
                name: "position".into(),
                unit: "m".into(),
                values: values.clone(),
                parity: None,
                state: true,
            };
            shape(&coordinate, &values.iter().map(|v| law(*v)).collect::<Vec<_>>())
        };
        let dent = along(|x| 3.0 * (-((x - 0.2) / 0.02f64).powi(2)).exp());
        assert!(
            matches!(dent, Generic::Bump { place, height, .. } if (place - 0.2).abs() < 0.02 && height > 2.0)
        );
        let slope = along(|x| (3.0 * x).sin());
        assert!(
            matches!(slope, Generic::Profile { low, high } if (low + 1.0).abs() < 0.01 && (high - 1.0).abs() < 0.01)
        );
    }
}
