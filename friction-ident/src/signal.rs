//! Sampled signals.

/// Derivative of `values` at `time`: exact for a parabola on any grid inside, one-sided at the ends.
pub fn derivative(time: &[f64], values: &[f64]) -> Vec<f64> {
    let samples = values.len().min(time.len());
    if samples < 2 {
        return vec![0.0; values.len()];
    }
    let slope = |k: usize| (values[k + 1] - values[k]) / (time[k + 1] - time[k]);
    let inner = (1..samples - 1).map(|k| {
        let (before, after) = (time[k] - time[k - 1], time[k + 1] - time[k]);
        (slope(k - 1) * after + slope(k) * before) / (before + after)
    });
    let mut all = Vec::with_capacity(values.len());
    all.push(slope(0));
    all.extend(inner);
    all.push(slope(samples - 2));
    all.resize(values.len(), 0.0);
    all
}

/// A quantile of the absolute values.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    let index = ((sizes.len() as f64 * share) as usize).min(sizes.len().saturating_sub(1));
    *sizes.select_nth_unstable_by(index, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_derivative_of_a_parabola_is_exact_on_an_irregular_grid() {
        let time = [0.0, 0.1, 0.15, 0.4, 0.45, 1.0];
        let values = time.map(|t| 3.0 * t * t - t);
        let slope = derivative(&time, &values);
        for k in 1..5 {
            assert!((slope[k] - (6.0 * time[k] - 1.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_single_sample_has_no_slope() {
        assert_eq!(derivative(&[0.0], &[5.0]), [0.0]);
        assert!(derivative(&[], &[]).is_empty());
    }
}
