//! Where the model fails: the coordinates that the residual depends on, and the regimes that hold
//! the error.

use rayon::prelude::*;

use crate::family::{Coordinate, ModelFamily};
use crate::report::{Pattern, RegimeShare, Where};
use crate::statistics::bins::Bins;
use crate::statistics::in_time::{Structure, Trials};
use crate::statistics::placebo;

/// Number of rearranged residuals.
const PLACEBOS: usize = 199;

/// Where in the recording the residual is looked at.
pub struct Look<'a> {
    /// Target minus prediction.
    pub residual: &'a [f64],
    /// Weight of each point.
    pub weights: &'a [f64],
    /// Signals whose self-similarity makes a shift useless as a placebo.
    pub motion: &'a [Vec<f64>],
    /// Seed of the placebos.
    pub seed: u64,
}

/// For every coordinate: the share of the squared error that a function of this coordinate alone
/// would remove (a step for each of 20 bins of equally many points or of 100 of equal width, whichever is
/// more after adjustment for their number), the chance of as much by accident, and where along the coordinate it is worst. Largest share first.
pub fn coordinates(family: &dyn ModelFamily, view: &Look<'_>) -> Vec<Where> {
    let points = view.residual.len();
    let shifts = placebo::rearrangements(points, PLACEBOS, view.motion, view.seed);
    let shuffles = placebo::shuffles(points, PLACEBOS, view.seed);
    let unit = family.quantity().unit;
    let mut found: Vec<Where> = family
        .coordinates()
        .par_iter()
        .map(|coordinate| {
            if only_grows(coordinate) {
                along_time(coordinate, view, &shuffles, &unit)
            } else {
                along(coordinate, view, &shifts, &unit)
            }
        })
        .collect();
    found.sort_by(|a, b| b.share.total_cmp(&a.share));
    found
}

/// Whether a coordinate is, or behaves like, time.
pub fn only_grows(coordinate: &Coordinate) -> bool {
    coordinate.values.windows(2).all(|pair| pair[0] < pair[1])
}

/// Dependence on a coordinate of the motion.
fn along(coordinate: &Coordinate, view: &Look<'_>, orders: &[Vec<usize>], unit: &str) -> Where {
    let (coarse, fine) = (Bins::new(&coordinate.values), Bins::fine(&coordinate.values));
    let (share, p_value) =
        tested(coordinate, view, orders, |seen| coarse.explained(seen).max(fine.explained(seen)));
    let plain = parity(coordinate, view.residual, &vec![1.0; view.residual.len()]);
    let local = fine.explained(&plain) > coarse.explained(&plain);
    let pattern = worst(if local { &fine } else { &coarse }, coordinate, &plain);
    place(coordinate, unit, (share, p_value), pattern)
}

/// Dependence on a coordinate that only ever grows: time.
fn along_time(
    coordinate: &Coordinate,
    view: &Look<'_>,
    orders: &[Vec<usize>],
    unit: &str,
) -> Where {
    let trials = Trials::new(&coordinate.values);
    let (share, p_value) = tested(coordinate, view, orders, |seen| trials.best(seen).0);
    let plain = parity(coordinate, view.residual, &vec![1.0; view.residual.len()]);
    let pattern = match trials.best(&plain).1 {
        Structure::Step { time, height } => Pattern::Step { height, time },
        Structure::Sine { period, amplitude } => Pattern::Sine { amplitude, period },
    };
    place(coordinate, unit, (share, p_value), Some(pattern))
}

/// A statistic of the residual and its p-value among those of the rearranged residual.
fn tested(
    coordinate: &Coordinate,
    view: &Look<'_>,
    orders: &[Vec<usize>],
    statistic: impl Fn(&[f64]) -> f64,
) -> (f64, f64) {
    let share = statistic(&parity(coordinate, view.residual, view.weights));
    let placebos: Vec<f64> = orders
        .iter()
        .map(|order| {
            let moved: Vec<f64> = order.iter().map(|&k| view.residual[k]).collect();
            let weights: Vec<f64> = order.iter().map(|&k| view.weights[k]).collect();
            statistic(&parity(coordinate, &moved, &weights))
        })
        .collect();
    (share, placebo::p_value(share, &placebos))
}

/// Only the coordinates that are, or behave like, time; the instants themselves where there is none and they only grow.
pub fn times(family: &dyn ModelFamily, view: &Look<'_>) -> Vec<Where> {
    let shuffles = placebo::shuffles(view.residual.len(), PLACEBOS, view.seed);
    let unit = family.quantity().unit;
    let instants =
        Coordinate { state: false, ..Coordinate::of_state("time", "s", family.time().to_vec()) };
    let mut growing: Vec<&Coordinate> =
        family.coordinates().iter().filter(|c| only_grows(c)).collect();
    if growing.is_empty() && only_grows(&instants) {
        growing.push(&instants);
    }
    growing.par_iter().map(|time| along_time(time, view, &shuffles, &unit)).collect()
}

/// Share of the squared error and of the time in every regime; both sum to one.
pub fn regimes(family: &dyn ModelFamily, residual: &[f64]) -> Vec<RegimeShare> {
    regimes_where(family, residual, &vec![true; residual.len()])
}

/// The same of the points that are known alone.
pub fn regimes_where(
    family: &dyn ModelFamily,
    residual: &[f64],
    known: &[bool],
) -> Vec<RegimeShare> {
    let of_known = |member: &dyn Fn(usize) -> bool| {
        let inside = (0..residual.len()).filter(|k| known[*k] && member(*k));
        inside.fold((0usize, 0.0), |(count, sum), k| (count + 1, sum + residual[k] * residual[k]))
    };
    let (points, total) = of_known(&|_| true);
    let mut shares: Vec<RegimeShare> = family
        .regimes()
        .iter()
        .map(|regime| {
            let (count, square) = of_known(&|k| regime.member[k]);
            RegimeShare {
                regime: regime.name.clone(),
                share: square / total.max(f64::MIN_POSITIVE),
                time_share: count as f64 / points.max(1) as f64,
                rms: (square / count.max(1) as f64).sqrt(),
            }
        })
        .collect();
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    shares
}

/// The bin with the largest mean value.
fn worst(bins: &Bins, coordinate: &Coordinate, values: &[f64]) -> Option<Pattern> {
    let against_motion = coordinate.parity.is_some();
    let (at, error) = bins.peak(&coordinate.values, values)?;
    Some(Pattern::Mean { error, at, against_motion })
}

/// Where the model fails along `coordinate`.
fn place(coordinate: &Coordinate, unit: &str, by: (f64, f64), pattern: Option<Pattern>) -> Where {
    Where {
        coordinate: coordinate.name.clone(),
        share: by.0,
        p_value: by.1,
        unit: coordinate.unit.clone(),
        error_unit: unit.to_owned(),
        pattern,
    }
}

pub(crate) fn parity(coordinate: &Coordinate, residual: &[f64], weights: &[f64]) -> Vec<f64> {
    let weighted = residual.iter().zip(weights).map(|(r, w)| r * w);
    match &coordinate.parity {
        None => weighted.collect(),
        Some(parity) => weighted.zip(parity).map(|(r, s)| r * s).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_that_follows_a_coordinate_is_explained_by_it() {
        let values: Vec<f64> = (0..1000).map(|k| (f64::from(k) * 0.37).sin()).collect();
        let bins = Bins::new(&values);
        let follows: Vec<f64> = values.iter().map(|v| v * v).collect();
        let other: Vec<f64> = (0..1000).map(|k| (f64::from(k) * 1.913).sin()).collect();
        assert!(bins.explained(&follows) > 0.9);
        assert!(bins.explained(&other) < 0.1);
    }
}
