//! Whether values lie above zero again and again, whatever their sizes.

/// By how many of its standard deviations the sum of the ranks of those above zero exceeds what chance makes it where
/// values lie as often below as above (F. Wilcoxon, Biometrics Bulletin 1, 1945); a few huge ones count as a few. Values
/// of exactly zero say nothing.
pub fn signed_ranks(values: impl Iterator<Item = f64>) -> f64 {
    let mut told: Vec<f64> = values.filter(|value| *value != 0.0).collect();
    told.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let count = told.len() as f64;
    let signed: f64 =
        told.iter().zip(1..).map(|(value, rank)| f64::from(rank) * value.signum()).sum();
    let deviation = (count * (count + 1.0) * (2.0 * count + 1.0) / 6.0).sqrt();
    if told.is_empty() { 0.0 } else { signed / deviation }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn few_values_have_the_rank_sums_of_the_table() {
        // 1 and 3 above, 2 below: 4 - 2 of a deviation of sqrt(1 + 4 + 9).
        let by_hand = 2.0 / 14f64.sqrt();
        assert!((signed_ranks([10.0, 0.0, -20.0, 1e9].into_iter()) - by_hand).abs() < 1e-12);
        assert!((signed_ranks([-10.0, 20.0, -1e9].into_iter()) + by_hand).abs() < 1e-12);
        assert_eq!(signed_ranks(std::iter::empty()), 0.0);
        assert_eq!(signed_ranks([0.0, 0.0].into_iter()), 0.0);
    }

    #[test]
    fn values_without_a_side_pass_for_one_as_seldom_as_asked_whatever_their_tails() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
        // Cauchy: their mean has no standard error.
        let mut draw = || (std::f64::consts::PI * (random.random::<f64>() - 0.5)).tan();
        let (trials, level) = (20_000, 0.01);
        let above = (0..trials).filter(|_| signed_ranks((0..30).map(|_| draw())) > 2.326).count();
        let expected = level * f64::from(trials);
        assert!((above as f64 - expected).abs() < 4.0 * expected.sqrt(), "{above} {expected}");
    }

    #[test]
    fn what_holds_nearly_everywhere_is_seen_beside_one_value_that_dwarfs_all() {
        let values = |k: u32| if k == 7 { 1000.0 } else { 1.0 + f64::from(k % 5) };
        assert!(signed_ranks((0..20).map(values)) > 3.9);
        assert!(signed_ranks((0..20).map(|k| if k % 2 == 0 { values(k) } else { -100.0 })) < 0.0);
    }
}
