//! The noise of values that change slowly from one sample to the next, by what changes quickly.

use std::ops::Range;

use super::statistics;
use crate::statistics::basis::dot;

/// Weights of a difference of fourth order.
const BINOMIAL: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];

/// Noise by its differences of fourth order, in which what acts slowly hardly shows. `colour` are the autocorrelations
/// from lag 1 that the noise has, none where it is white; differences are taken within runs.
pub fn noise(values: &[f64], runs: &[Range<usize>], colour: &[f64]) -> f64 {
    let differences: Vec<f64> = runs
        .iter()
        .flat_map(|run| values[run.clone()].windows(5))
        .map(|v| dot(v, &BINOMIAL))
        .collect();
    let alike =
        |lag: usize| if lag == 0 { 1.0 } else { colour.get(lag - 1).copied().unwrap_or(0.0) };
    let pairs = (0..5).flat_map(|i| (0..5).map(move |j: usize| (i, j)));
    let square: f64 = pairs.map(|(i, j)| BINOMIAL[i] * BINOMIAL[j] * alike(i.abs_diff(j))).sum();
    statistics::spread(&differences) / square.max(1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Noise of deviation 0.1, each sample this share of the one before, on a swing of 3 and with jumps.
    fn made(share: f64) -> Vec<f64> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut state = 0.0;
        let mut next = |k: i32| {
            let new: f64 = StandardNormal.sample(&mut random);
            state = share * state + (1.0 - share * share).sqrt() * new;
            0.1 * state + 3.0 * (0.05 * f64::from(k)).sin() + f64::from(k / 700)
        };
        (0..4000).map(&mut next).collect()
    }

    #[test]
    fn white_noise_is_known_below_what_swings_and_jumps() {
        let (values, runs) = (made(0.0), [0..2000, 2000..4000]);
        assert!((noise(&values, &runs, &[]) / 0.1 - 1.0).abs() < 0.05);
        assert_eq!(noise(&values, &[0..4, 4..8], &[]), 0.0);
    }

    #[test]
    fn coloured_noise_is_known_where_its_colour_is() {
        let values = made(0.9);
        let colour: Vec<f64> = (1..60).map(|lag| 0.9f64.powi(lag)).collect();
        assert!((noise(&values, &[0..2000, 2000..4000], &colour) / 0.1 - 1.0).abs() < 0.06);
        // Taken for white it seems to be a fraction of that.
        assert!(noise(&values, &[0..2000, 2000..4000], &[]) < 0.03);
    }
}
