//! What colours the errors of a model: each is foretold in part by the few before it.
//!
//! What a model lacks swings for longer than a sample, so that its prediction errors resemble their neighbours. Their
//! likelihood is that of what an [`Autoregression`] leaves of them: that is white.

use std::ops::Range;

use super::autoregression::Autoregression;
use super::statistics;

/// Most errors before one that foretell it.
pub const ORDER: usize = 8;
/// Errors beyond this many times their usual size count as that where the law is found: a spike is no colour.
const CUT: f64 = 6.0;
/// The usual size is the median's, and at least this share of the root mean square.
const LEAST: f64 = 0.3;

/// The law that colours errors.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    of: Autoregression,
}

impl Law {
    /// Of errors that nothing foretells.
    pub fn none() -> Self {
        Self { of: Autoregression::none() }
    }

    /// Whether it leaves all errors as they are.
    pub fn is_none(&self) -> bool {
        self.of.order() == 0
    }

    /// Of errors that lie at `instants` of a recording, each foretold by so many at most; pieces of it have nothing to do with
    /// each other.
    pub fn of(errors: &[f64], instants: &[(f64, usize)], order: usize) -> Self {
        let usual = statistics::spread(errors).max(LEAST * statistics::rms(errors, f64::INFINITY));
        let cut: Vec<f64> = errors.iter().map(|e| e.max(-CUT * usual).min(CUT * usual)).collect();
        Self { of: Autoregression::of(&cut, &runs(instants), order, 1.0) }
    }

    /// What it leaves of errors.
    pub fn left(&self, errors: &[f64], instants: &[(f64, usize)]) -> Vec<f64> {
        if self.is_none() {
            return errors.to_vec();
        }
        self.of.left(errors, &runs(instants))
    }
}

/// The errors of each piece.
pub(super) fn runs(instants: &[(f64, usize)]) -> Vec<Range<usize>> {
    let mut first = 0;
    let piece = |piece: &[(f64, usize)]| {
        first += piece.len();
        first - piece.len()..first
    };
    instants.chunk_by(|a, b| a.1 == b.1).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn noise(count: usize, seed: u64) -> Vec<f64> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        (0..count).map(|_| StandardNormal.sample(&mut random)).collect()
    }

    /// Noise that rings: poles of radius 0.9.
    fn ringing(noise: &[f64]) -> Vec<f64> {
        let mut errors: Vec<f64> = Vec::new();
        for new in noise {
            let before = |lag: usize| errors.len().checked_sub(lag).map_or(0.0, |k| errors[k]);
            errors.push(new + 1.5 * before(1) - 0.81 * before(2));
        }
        errors
    }

    fn one_piece(count: usize) -> Vec<(f64, usize)> {
        (0..count).map(|k| (k as f64, 0)).collect()
    }

    #[test]
    fn what_is_left_of_coloured_errors_is_the_noise_that_made_them() {
        let made = noise(20_000, 1);
        let errors = ringing(&made);
        let instants = one_piece(errors.len());
        let law = Law::of(&errors, &instants, ORDER);
        let found = &law.of.with_before(ORDER).coefficients;
        let (first, second) = (found[0], found[1]);
        assert!((first - 1.5).abs() < 0.05 && (second + 0.81).abs() < 0.05, "{first} {second}");
        let left = law.left(&errors, &instants);
        let off: Vec<f64> = left.iter().zip(&made).map(|(a, b)| a - b).collect();
        assert!(statistics::rms(&off, f64::INFINITY) < 0.05);
        assert_eq!(statistics::correlation(&left), 1.0);
    }

    #[test]
    fn errors_that_nothing_foretells_stay_as_they_are() {
        let errors = noise(5_000, 2);
        let instants = one_piece(errors.len());
        let left = Law::of(&errors, &instants, ORDER).left(&errors, &instants);
        let off: Vec<f64> = left.iter().zip(&errors).map(|(a, b)| a - b).collect();
        assert!(statistics::rms(&off, f64::INFINITY) < 0.06);
        // Nothing is known of none.
        for nothing in [vec![0.0; 50], vec![f64::NAN; 50], Vec::new()] {
            let instants = &instants[..nothing.len()];
            let left = Law::of(&nothing, instants, ORDER).left(&nothing, instants);
            assert_eq!(format!("{left:?}"), format!("{nothing:?}"));
        }
    }

    #[test]
    fn pieces_have_nothing_to_do_with_each_other() {
        let errors = ringing(&noise(2_000, 3));
        let instants: Vec<(f64, usize)> = (0..2_000).map(|k| (k as f64, k / 500)).collect();
        let law = Law::of(&errors, &instants, ORDER);
        let left = law.left(&errors, &instants);
        for first in [0, 500, 1000, 1500] {
            assert_eq!(left[first], errors[first]);
            let piece = law.left(&errors[first..first + 500], &instants[first..first + 500]);
            assert_eq!(left[first..first + 500], piece);
        }
    }

    #[test]
    fn a_few_wild_errors_are_no_colour() {
        let mut errors = noise(20_000, 4);
        let instants = one_piece(errors.len());
        errors[7_000] = 1e3;
        errors[7_001] = 1e3;
        // As they are these two would say that half of an error follows from the one before.
        let law = Law::of(&errors, &instants, ORDER);
        let found = &law.of.with_before(1).coefficients;
        assert!(found[0].abs() < 0.02, "{found:?}");
    }

    #[test]
    fn errors_that_are_mostly_none_keep_the_colour_of_the_others() {
        // The axis rests three quarters of the time: the median error is none.
        let ringing = ringing(&noise(8_000, 5));
        let moves = |k: usize| k % 400 < 100;
        let error = |(k, e): (usize, &f64)| if moves(k) { *e } else { 0.0 };
        let errors: Vec<f64> = ringing.iter().enumerate().map(error).collect();
        let instants = one_piece(errors.len());
        let left = Law::of(&errors, &instants, ORDER).left(&errors, &instants);
        let rms = |values: &[f64]| statistics::rms(values, f64::INFINITY);
        assert!(rms(&left) < 0.5 * rms(&errors), "{} {}", rms(&left), rms(&errors));
    }
}
