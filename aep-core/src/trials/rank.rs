//! Which of two methods is ahead, and by how much.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};
use statrs::function::erf::erfc;

/// What a trial achieved: one that reached the target counts more than one that did not; of two
/// that did, the faster one; of two that did not, the one with the smaller cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Merit {
    reached: bool,
    value: f64,
}

impl Merit {
    /// The merit of a trial with this final cost.
    pub fn new(evaluations_to_target: Option<u64>, cost: f64) -> Self {
        let reached = evaluations_to_target.is_some();
        Self { reached, value: evaluations_to_target.map_or(cost, |used| used as f64) }
    }

    /// Better is smaller.
    fn order(&self, other: &Self) -> Ordering {
        other.reached.cmp(&self.reached).then(self.value.total_cmp(&other.value))
    }
}

/// Result of the rank test of Mann and Whitney.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RankTest {
    /// Probability that a trial of the first method is better than one of the second, ties counted
    /// half: the effect size A of Vargha and Delaney. 0.5: no difference; 1: always better.
    pub effect: f64,
    /// Two-sided p-value of "no difference", normal approximation with correction for ties and for
    /// continuity; good from about eight trials each.
    pub p_value: f64,
}

/// Compares the trials of two methods.
///
/// References: H. B. Mann, D. R. Whitney, Annals of Mathematical Statistics 18, 1947; A. Vargha,
/// H. D. Delaney, J. Educational and Behavioral Statistics 25, 2000.
pub fn rank_test(first: &[Merit], second: &[Merit]) -> RankTest {
    let (m, n) = (first.len() as f64, second.len() as f64);
    if first.is_empty() || second.is_empty() {
        return RankTest { effect: 0.5, p_value: 1.0 };
    }
    let mut all: Vec<(&Merit, bool)> = first.iter().map(|merit| (merit, true)).collect();
    all.extend(second.iter().map(|merit| (merit, false)));
    all.sort_by(|a, b| a.0.order(b.0));
    let (mut rank_sum, mut ties, mut below) = (0.0, 0.0, 0.0);
    for group in all.chunk_by(|a, b| a.0.order(b.0).is_eq()) {
        let size = group.len() as f64;
        let own = group.iter().filter(|(_, of_first)| *of_first).count() as f64;
        rank_sum += own * (below + f64::midpoint(size, 1.0));
        ties += size.powi(3) - size;
        below += size;
    }
    let u = m * n + m * (m + 1.0) / 2.0 - rank_sum;
    let total = m + n;
    let variance = m * n / 12.0 * ((total + 1.0) - ties / (total * (total - 1.0)));
    let distance = ((u - m * n / 2.0).abs() - 0.5).max(0.0);
    let p_value = if variance > 0.0 { erfc(distance / (2.0 * variance).sqrt()) } else { 1.0 };
    RankTest { effect: u / (m * n), p_value: p_value.min(1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn costs(values: &[f64]) -> Vec<Merit> {
        values.iter().map(|v| Merit::new(None, *v)).collect()
    }

    /// Against `SciPy` 1.17: `mannwhitneyu(first, second, method="asymptotic")` gives U = 3,
    /// p = 0.060102806.
    #[test]
    fn p_value_and_effect_match_a_reference() {
        let first = costs(&[1.1, 2.2, 3.3, 4.4, 5.5]);
        let second = costs(&[2.5, 6.1, 7.2, 8.3, 9.4]);
        let test = rank_test(&first, &second);
        assert!((test.effect - 22.0 / 25.0).abs() < 1e-12, "{test:?}");
        assert!((test.p_value - 0.060_102_806).abs() < 1e-8, "{test:?}");
    }

    #[test]
    fn equal_trials_show_no_difference() {
        let test = rank_test(&costs(&[1.0; 9]), &costs(&[1.0; 9]));
        assert_eq!((test.effect, test.p_value), (0.5, 1.0));
    }

    #[test]
    fn reaching_the_target_beats_any_cost() {
        let reached: Vec<Merit> = (0..9).map(|i| Merit::new(Some(1_000 + i), 1e-3)).collect();
        let test = rank_test(&reached, &costs(&[1e-9; 9]));
        assert_eq!(test.effect, 1.0);
        assert!(test.p_value < 1e-3);
    }
}
