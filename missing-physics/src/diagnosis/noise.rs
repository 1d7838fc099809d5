//! The noise floor: the error that no model of the given coordinates can remove.
//!
//! Two instants with nearly the same motion should leave nearly the same residual, whatever the
//! physics; half the mean squared difference of such neighbours is the variance of the noise. This
//! is the Gamma test (Stefansson, Koncar, Jones 1997, Neural Computing & Applications 5, 131-133):
//! the differences of the 1st to p-th neighbours are extrapolated to distance zero.

use rayon::prelude::*;

use crate::family::{Coordinate, ModelFamily};

/// Neighbours of each point. Few: farther ones differ by structure that the model lacks, and the line
/// through them would undershoot at distance zero.
const NEIGHBOURS: usize = 3;
/// Most points that are looked at; more are thinned out evenly.
const MOST_POINTS: usize = 4000;
/// Neighbours closer in time than this share of the recording share the same noise.
const APART: f64 = 0.01;

/// [`floor`] over the coordinates that make up a family's state.
pub fn floor_of(family: &dyn ModelFamily, residual: &[f64]) -> f64 {
    let state: Vec<Coordinate> =
        family.coordinates().iter().filter(|coordinate| coordinate.state).cloned().collect();
    floor(residual, &state)
}

/// Standard deviation of what cannot be explained by any smooth function of the coordinates, in
/// the unit of the residual; 0 where there are too few points to tell.
pub fn floor(residual: &[f64], coordinates: &[Coordinate]) -> f64 {
    let stride = residual.len().div_ceil(MOST_POINTS).max(1);
    let index: Vec<usize> = (0..residual.len()).step_by(stride).collect();
    if index.len() < 40 * NEIGHBOURS || coordinates.is_empty() {
        return 0.0;
    }
    let axes: Vec<Vec<f64>> = coordinates
        .iter()
        .map(|coordinate| ranks(&index.iter().map(|&i| coordinate.values[i]).collect::<Vec<_>>()))
        .collect();
    let apart = ((index.len() as f64 * APART) as usize).max(2);
    let near: Vec<[(f64, f64); NEIGHBOURS]> = (0..index.len())
        .into_par_iter()
        .map(|i| neighbours(i, &axes, apart, |j| (residual[index[i]] - residual[index[j]]).powi(2)))
        .collect();
    // Mean squared distance and half mean squared difference for the 1st .. p-th neighbour.
    let count = near.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64, k: usize| {
        near.iter().map(|row| pick(&row[k])).sum::<f64>() / count
    };
    let points: Vec<(f64, f64)> =
        (0..NEIGHBOURS).map(|k| (mean(|p| p.0, k), 0.5 * mean(|p| p.1, k))).collect();
    intercept(&points).clamp(0.5 * points[0].1, points[0].1).sqrt()
}

/// Ranks from 0 to 1: every coordinate counts alike, whatever its unit and distribution.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    for (rank, index) in order.into_iter().enumerate() {
        ranks[index] = rank as f64 / values.len() as f64;
    }
    ranks
}

/// Squared distances and squared differences of the nearest points that are apart in time.
fn neighbours(
    i: usize,
    axes: &[Vec<f64>],
    apart: usize,
    difference: impl Fn(usize) -> f64,
) -> [(f64, f64); NEIGHBOURS] {
    let mut nearest = [(f64::INFINITY, usize::MAX); NEIGHBOURS];
    for j in (0..axes[0].len()).filter(|j| j.abs_diff(i) >= apart) {
        let distance: f64 = axes.iter().map(|axis| (axis[i] - axis[j]).powi(2)).sum();
        if distance < nearest[NEIGHBOURS - 1].0 {
            let place = nearest.partition_point(|(other, _)| *other <= distance);
            nearest[place..].rotate_right(1);
            nearest[place] = (distance, j);
        }
    }
    nearest.map(
        |(distance, j)| {
            if j == usize::MAX { (0.0, 0.0) } else { (distance, difference(j)) }
        },
    )
}

/// Value at 0 of the least-squares line through the points.
fn intercept(points: &[(f64, f64)]) -> f64 {
    let count = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
    let covariance: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let variance: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    if variance > 0.0 { my - covariance / variance * mx } else { my }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn noise_under_a_smooth_function_of_two_coordinates_is_found_within_ten_per_cent() {
        use rand::RngExt;
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut uniform = || random.random_range(-1.0..1.0);
        let (a, b): (Vec<f64>, Vec<f64>) = (0..3000).map(|_| (uniform(), uniform())).unzip();
        // Uniform noise of +-0.3 has a standard deviation of 0.1732.
        let residual: Vec<f64> =
            a.iter().zip(&b).map(|(x, y)| (3.0 * x).sin() + x * y + 0.3 * uniform()).collect();
        let coordinate = |name: &str, values: Vec<f64>| Coordinate {
            name: name.into(),
            unit: String::new(),
            values,
            parity: None,
            state: true,
        };
        let floor = floor(&residual, &[coordinate("a", a), coordinate("b", b)]);
        assert!((floor / 0.1732 - 1.0).abs() < 0.1, "{floor}");
    }
}
