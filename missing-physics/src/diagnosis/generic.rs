//! What structure along a coordinate looks like, for a term that describes it without explaining it.

use crate::diagnosis::where_it_fails::{only_grows, parity};
use crate::family::{Coordinate, Generic};
use crate::statistics::bins::Bins;
use crate::statistics::in_time::Trials;

/// A structure is at one place where fine bins explain more than coarse ones by this share.
const LOCAL: f64 = 0.2;

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
