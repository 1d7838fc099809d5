//! How much each point counts where effects are screened.

/// Weights for screening: a point whose doubt exceeds the usual residual counts accordingly less; without doubts all
/// count alike.
pub fn weights(doubt: &[f64], residual: &[f64]) -> Vec<f64> {
    if doubt.is_empty() {
        return vec![1.0; residual.len()];
    }
    let mut sizes: Vec<f64> = residual.iter().map(|value| value.abs()).collect();
    let middle = sizes.len() / 2;
    // Median absolute residual, as a standard deviation.
    let usual = 1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    doubt
        .iter()
        .map(|doubt| if usual > 0.0 { 1.0 / (1.0 + (doubt / usual).powi(2)).sqrt() } else { 1.0 })
        .collect()
}

#[cfg(test)]
mod tests {

    #[test]
    fn doubtful_points_count_less_and_without_doubts_all_count_alike() {
        let residual = [1.0, -1.0, 1.0, -1.0, 1.0];
        let weights = |doubt: &[f64]| super::weights(doubt, &residual);
        assert_eq!(weights(&[]), weights(&[0.0; 5]));
        let some = weights(&[0.0, 0.0, 1.4826, 0.0, 100.0]);
        assert_eq!(some[..2], [1.0, 1.0]);
        assert!((some[2] - 0.5f64.sqrt()).abs() < 1e-12 && some[4] < 0.02, "{some:?}");
    }
}
