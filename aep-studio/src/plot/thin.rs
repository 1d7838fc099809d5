//! Fewer points than were measured, and the same picture.

/// Most points of a cloud.
const CLOUD: usize = 3000;
/// A line keeps the extremes of this many slices of the width.
const SLICES: usize = 480;

/// Evenly chosen points of a cloud.
pub(crate) fn cloud(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().copied().step_by(points.len().div_ceil(CLOUD).max(1)).collect()
}

/// A line, reduced to the lowest and highest point of each slice where it has more than can be seen.
pub(crate) fn line(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= 2 * SLICES {
        return points.to_vec();
    }
    let size = points.len().div_ceil(SLICES);
    points.chunks(size).flat_map(extremes).collect()
}

/// Lowest and highest point in the order in which they occur.
fn extremes(slice: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let index = |k: Option<usize>| k.unwrap_or(0);
    let by_height = |a: &usize, b: &usize| slice[*a].1.total_cmp(&slice[*b].1);
    let low = index((0..slice.len()).min_by(by_height));
    let high = index((0..slice.len()).max_by(by_height));
    let mut kept = vec![low.min(high), low.max(high)];
    kept.dedup();
    kept.into_iter().map(|k| slice[k]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_survives_thinning() {
        let mut points: Vec<(f64, f64)> = (0..50_000).map(|k| (f64::from(k), 0.0)).collect();
        points[31_234].1 = 9.0;
        let thin = line(&points);
        assert!(thin.len() <= 2 * SLICES + 2);
        assert!(thin.contains(&(31_234.0, 9.0)));
        assert!(thin.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn a_cloud_keeps_points_from_everywhere() {
        let points: Vec<(f64, f64)> = (0..50_000).map(|k| (f64::from(k), 0.0)).collect();
        let thin = cloud(&points);
        assert!(thin.len() <= CLOUD && thin.last().unwrap().0 > 49_900.0);
    }
}
