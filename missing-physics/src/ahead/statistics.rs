//! Robust sums over prediction errors.

/// Errors beyond this many standard deviations count linearly, not by their square (P. J. Huber).
pub const HUBER: f64 = 4.0;
/// Largest lag of the autocorrelation that deflates a likelihood.
const LAGS: usize = 30;
/// Autocorrelation below which the rest is taken for noise.
const NEGLIGIBLE: f64 = 0.03;

/// Huber's loss of an error in standard deviations, nats.
pub fn loss(z: f64) -> f64 {
    let size = z.abs();
    if size < HUBER { 0.5 * z * z } else { HUBER * size - 0.5 * HUBER * HUBER }
}

/// Sum of the losses of `errors` in units of `scale`.
pub fn total(errors: &[f64], scale: f64) -> f64 {
    errors.iter().map(|e| loss(e / scale)).sum()
}

/// Weight of an error in least squares that solve Huber's problem.
pub fn weight(z: f64) -> f64 {
    1.0 / (z.abs() / HUBER).max(1.0)
}

/// Root mean square; squares beyond `cut` times their mean count as that.
pub fn rms(errors: &[f64], cut: f64) -> f64 {
    let count = errors.len().max(1) as f64;
    let mean = errors.iter().map(|e| e * e).sum::<f64>() / count;
    (errors.iter().map(|e| (e * e).min(cut * mean)).sum::<f64>() / count).sqrt()
}

/// Median size, as the standard deviation of normal errors.
pub fn spread(errors: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = errors.iter().map(|e| e.abs()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// How many errors say as much as one that is independent: `1 + 2 sum` of the positive autocorrelations.
pub fn correlation(errors: &[f64]) -> f64 {
    let count = errors.len().max(1) as f64;
    let deviation = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
    // Unlike `clamp` this takes a deviation that is no number.
    let cut: Vec<f64> =
        errors.iter().map(|e| e.max(-6.0 * deviation).min(6.0 * deviation)).collect();
    let mean = cut.iter().sum::<f64>() / count;
    let z: Vec<f64> = cut.iter().map(|e| e - mean).collect();
    let square = crate::statistics::basis::dot(&z, &z);
    let mut factor = 1.0;
    for lag in 1..LAGS.min(z.len()) {
        let r = crate::statistics::basis::dot(&z[..z.len() - lag], &z[lag..]) / square;
        // Not a number counts as nothing.
        if r.is_nan() || r < NEGLIGIBLE {
            break;
        }
        factor += 2.0 * r;
    }
    factor
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Errors of deviation 1, each this share of the one before.
    fn coloured(count: usize, share: f64) -> Vec<f64> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(3);
        let mut state = 0.0;
        let mut next = || {
            let new: f64 = StandardNormal.sample(&mut random);
            state = share * state + (1.0 - share * share).sqrt() * new;
            state
        };
        (0..count).map(|_| next()).collect()
    }

    #[test]
    fn the_loss_goes_on_straight_where_the_square_ends() {
        assert_eq!(loss(-2.0), 2.0);
        assert_eq!(loss(HUBER), 0.5 * HUBER * HUBER);
        assert_eq!(loss(HUBER + 1.0) - loss(HUBER), HUBER);
        // The weight is the derivative over the error.
        for z in [0.5, 3.0, 7.0, 40.0] {
            let slope = (loss(z + 1e-6) - loss(z - 1e-6)) / 2e-6;
            assert!((weight(z) * z - slope).abs() < 1e-6, "{z}");
        }
        assert_eq!(total(&[2.0, -4.0], 2.0), 0.5 + 2.0);
    }

    #[test]
    fn sizes_of_normal_errors_are_their_deviation_and_wild_ones_count_little() {
        let mut errors = coloured(20_000, 0.0);
        assert!((rms(&errors, 16.0) - 1.0).abs() < 0.03 && (spread(&errors) - 1.0).abs() < 0.03);
        errors[0] = 1e3;
        // One square of 1e6 among 2e4 is 50 at the mean, 16 times that at most over the count.
        assert!(rms(&errors, f64::INFINITY) > 7.0 && rms(&errors, 16.0) < 1.05);
        assert!((spread(&errors) - 1.0).abs() < 0.03);
        assert_eq!((spread(&[]), rms(&[], 1.0)), (0.0, 0.0));
    }

    #[test]
    fn errors_that_resemble_each_other_say_less() {
        assert_eq!(correlation(&coloured(20_000, 0.0)), 1.0);
        for share in [0.3, 0.6] {
            let exact = (1.0 + share) / (1.0 - share);
            let factor = correlation(&coloured(20_000, share));
            assert!((factor / exact - 1.0).abs() < 0.12, "{share}: {factor} {exact}");
        }
        // What swings says no more than its own number.
        assert_eq!(correlation(&coloured(20_000, -0.5)), 1.0);
        assert_eq!(correlation(&[f64::NAN; 50]), 1.0);
    }
}
