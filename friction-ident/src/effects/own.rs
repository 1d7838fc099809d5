//! What a recording may change about an effect that is the same: where its position's zero lies, how warm it is.

use std::f64::consts::TAU;

/// A difference between two recordings of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Own {
    /// The position's zero lies further on by so much, m or rad.
    Home(f64),
    /// Lubricants shear so many times as hard.
    Shear(f64),
}

/// Amplitudes of `a sin(2 pi k x/l) + b cos(2 pi k x/l)` where the position's zero lies further on by `home`: the same
/// force at the same place.
pub fn turned((a, b): (f64, f64), harmonic: usize, home: f64, period: f64) -> (f64, f64) {
    let (sin, cos) = (TAU * harmonic as f64 * home / period).sin_cos();
    (a * cos - b * sin, a * sin + b * cos)
}

#[cfg(test)]
mod tests {
    use super::super::ripple::Ripple;
    use super::super::testing::{Point, smooth};
    use super::super::{ALL, Effect};
    use super::*;

    #[test]
    fn a_law_whose_zero_was_moved_is_the_same_force_at_the_same_place() {
        let values = [1.3, -0.4, 0.6, 0.2, 5e-3];
        for home in [-3e-3, 0.0, 1.7e-3] {
            let moved = Ripple.in_recording(&values, Own::Home(home)).unwrap();
            for x in [-0.02, 1e-3, 0.0137] {
                let here = smooth(&Ripple, &values, Point::at(x + home, 0.0)).0;
                let there = smooth(&Ripple, &moved, Point::at(x, 0.0)).0;
                assert!((here - there).abs() < 1e-9, "{home} {x}: {here} {there}");
            }
        }
    }

    #[test]
    fn what_differs_by_nothing_changes_nothing() {
        for effect in ALL.iter().flat_map(|effect| std::iter::once(effect).chain(effect.forms())) {
            let parameters = effect.about().parameters;
            let values: Vec<f64> = parameters.iter().map(|p| p.default + 0.1).collect();
            for own in [Own::Home(0.0), Own::Shear(1.0)] {
                let same = effect.in_recording(&values, own);
                assert!(same.is_none_or(|same| same == values), "{}", effect.about().name);
            }
        }
    }
}
