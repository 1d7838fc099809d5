//! The force that a model lacks, over time: what would have to be added to the input so that the model follows.
//!
//! A family that predicts one sample ahead may estimate it ([`crate::family::Ahead::missing_force`]). It is in the
//! unit of the compared quantity but owes nothing to its residual: nothing is differentiated.

use crate::diagnosis::{residual_map, where_it_fails};
use crate::family::{Coordinate, ModelFamily, Series};
use crate::report::{MissingForce, RegimeShare, ResidualMap};

/// Most points of the series that are kept.
const MOST_POINTS: usize = 4000;
/// Half-width of a 95 % band in standard deviations.
const BAND: f64 = 1.96;
/// A grid point and its sample lie at most this many sampling intervals apart.
const NEAR: f64 = 1.5;
/// Fewest grid points of a map.
const FEWEST: usize = 60;

impl MissingForce {
    /// Sums up a series, with its shares by regime; nothing where nothing is known or numbers are not finite.
    pub fn of(family: &dyn ModelFamily, series: &Series) -> Option<(Self, Vec<RegimeShare>)> {
        let known: Vec<usize> = (0..series.time.len()).filter(|k| series.known[*k]).collect();
        let (size, band) = series.size()?;
        let recorded = Some(series.rms(&series.recorded)).filter(|rms| rms.is_finite())?;
        let grid = on_grid(family.time(), series);
        let kept: Vec<usize> =
            known.iter().copied().step_by(known.len().div_ceil(MOST_POINTS).max(1)).collect();
        let told = |value: &dyn Fn(usize) -> f64| kept.iter().map(|k| rounded(value(*k))).collect();
        let missing = Self {
            unit: family.quantity().unit,
            rms: size,
            recorded,
            share: if recorded > 0.0 { size / recorded } else { 0.0 },
            band,
            known: known.len() as f64 / series.time.len() as f64,
            time: kept.iter().map(|k| series.time[*k]).collect(),
            force: told(&|k| series.force[k]),
            half_width: told(&|k| BAND * series.deviation[k]),
            maps: maps(family, &grid),
        };
        Some((missing, regimes(family, &grid)))
    }
}

/// The force at the instants of a grid; nothing where it is not known.
fn on_grid(grid: &[f64], series: &Series) -> Vec<Option<f64>> {
    let count = series.time.len();
    let mut intervals: Vec<f64> = series.time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    intervals.sort_unstable_by(f64::total_cmp);
    let near = NEAR * intervals.get(intervals.len() / 2).copied().unwrap_or(0.0);
    let at = |time: &f64| {
        let k = series.time.partition_point(|end| end < time).min(count.saturating_sub(1));
        let known = (series.time[k] - time).abs() <= near && series.known[k];
        known.then_some(series.force[k])
    };
    grid.iter().map(at).collect()
}

fn regimes(family: &dyn ModelFamily, grid: &[Option<f64>]) -> Vec<RegimeShare> {
    let known: Vec<bool> = grid.iter().map(Option::is_some).collect();
    let force: Vec<f64> = grid.iter().map(|force| force.unwrap_or(0.0)).collect();
    let mut shares = where_it_fails::regimes_where(family, &force, &known);
    // Nothing is known of these.
    shares.retain(|regime| regime.time_share > 0.0);
    shares
}

fn maps(family: &dyn ModelFamily, grid: &[Option<f64>]) -> Vec<ResidualMap> {
    let of_state = family.coordinates().iter().filter(|coordinate| coordinate.state);
    of_state.filter_map(|coordinate| along(coordinate, grid, family.time())).collect()
}

/// The mean force along a coordinate where it is known. Along one that has a direction it counts as positive where it
/// opposes the motion, as a residual does.
fn along(coordinate: &Coordinate, grid: &[Option<f64>], time: &[f64]) -> Option<ResidualMap> {
    let known: Vec<usize> = (0..grid.len()).filter(|k| grid[*k].is_some()).collect();
    if known.len() < FEWEST {
        return None;
    }
    let at = |values: &[f64]| -> Vec<f64> { known.iter().map(|k| values[*k]).collect() };
    let against = |parity: &Vec<f64>| at(parity).iter().map(|sign| -sign).collect();
    let part = Coordinate {
        values: at(&coordinate.values),
        parity: coordinate.parity.as_ref().map(against),
        ..coordinate.clone()
    };
    let force: Vec<f64> = grid.iter().copied().flatten().collect();
    Some(residual_map::map(&part, &force, &at(time)))
}

/// Five digits: a plot shows no more.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;
