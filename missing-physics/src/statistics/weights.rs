//! How much each point counts where effects are screened.

/// Weights for screening: a point whose doubt exceeds the usual residual counts accordingly less.
pub fn weights(doubt: &[f64], residual: &[f64]) -> Vec<f64> {
    let mut sizes: Vec<f64> = residual.iter().map(|value| value.abs()).collect();
    let middle = sizes.len() / 2;
    // Median absolute residual, as a standard deviation.
    let usual = 1.4826 * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    doubt
        .iter()
        .map(|doubt| if usual > 0.0 { 1.0 / (1.0 + (doubt / usual).powi(2)).sqrt() } else { 1.0 })
        .collect()
}
