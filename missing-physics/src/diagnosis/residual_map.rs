//! Residual maps: the mean residual along a coordinate, with a band that knows of its autocorrelation.
//!
//! Neighbours in time err together, so that the mean over a bin that the motion crosses in a few long
//! passes is less certain than its number of points says. The variance of the mean of the points `B` is
//! `var / |B|² · sum over pairs in B of rho(their distance in time)`, with the autocorrelation `rho` of
//! what the map leaves, summed up to its first zero (a residual that swings is then not given a band
//! that is too narrow), and the variance of that bin.

use crate::diagnosis::where_it_fails::parity;
use crate::family::Coordinate;
use crate::report::{MapBin, ResidualMap};
use crate::statistics::autocorrelation::{autocorrelation, pieces};
use crate::statistics::bins::Bins;

/// Half-width of a 95 % band in standard errors.
const BAND: f64 = 1.96;
/// Longest memory of a residual that is looked for, as a share of the points.
const MEMORY: f64 = 0.1;

/// The map of `residual` along `coordinate` on a grid of `time`.
pub fn map(coordinate: &Coordinate, residual: &[f64], time: &[f64]) -> ResidualMap {
    let bins = Bins::new(&coordinate.values);
    let seen = parity(coordinate, residual, &vec![1.0; residual.len()]);
    let (means, at) = (bins.means(&seen), bins.means(&coordinate.values));
    let left: Vec<f64> =
        seen.iter().zip(&bins.of).map(|(value, bin)| value - means[*bin]).collect();
    let spread = bins.means(&left.iter().map(|value| value * value).collect::<Vec<f64>>());
    let pieces = pieces(time);
    let most = ((MEMORY * residual.len() as f64) as usize).max(1);
    // The residual itself, without the sign of the motion, is what has a memory.
    let plain = parity(coordinate, &left, &vec![1.0; left.len()]);
    let rho = autocorrelation(&plain, &pieces, most);
    let memory = rho.iter().position(|r| *r <= 0.0).unwrap_or(rho.len());
    // Pairs of points of the same bin, weighed with their correlation; each point with itself first.
    let mut pairs = bins.count.clone();
    for (lag, rho) in rho.iter().enumerate().take(memory).skip(1) {
        for piece in pieces.iter().filter(|piece| piece.len() > lag) {
            for k in piece.start..piece.end - lag {
                let bin = bins.of[k];
                if bin == bins.of[k + lag] {
                    let sign = coordinate
                        .parity
                        .as_ref()
                        .map_or(1.0, |parity| (parity[k] * parity[k + lag]).signum());
                    pairs[bin] += 2.0 * rho * sign;
                }
            }
        }
    }
    let bins = (0..means.len())
        .filter(|&bin| bins.count[bin] > 0.0)
        .map(|bin| {
            let count = bins.count[bin];
            // The bin's own mean was taken out of its spread.
            let independent = (count * count / pairs[bin].max(1.0)).clamp(1.0, count);
            let variance = spread[bin] * independent / (independent - 1.0).max(0.5);
            let reach = BAND * (variance / independent).sqrt();
            let (mean, at) = (means[bin], at[bin]);
            MapBin { at, mean, low: mean - reach, high: mean + reach, points: count as usize }
        })
        .collect();
    ResidualMap {
        coordinate: coordinate.name.clone(),
        unit: coordinate.unit.clone(),
        against_motion: coordinate.parity.is_some(),
        bins,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// A residual with a memory of about ten samples along a coordinate that wanders to and fro.
    fn trial(seed: u64, opposed: bool) -> ResidualMap {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
        let time: Vec<f64> = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
        let phase = normal();
        let values: Vec<f64> =
            time.iter().map(|t| (0.9 * t + phase).sin() + 0.5 * (2.3 * t).sin()).collect();
        let mut state = 0.0;
        let residual: Vec<f64> = values
            .iter()
            .map(|x| {
                state = 0.9 * state + normal();
                // Noise that grows along the coordinate.
                state * (1.5 + x)
            })
            .collect();
        let signs = time.iter().map(|t| (0.9 * t).cos().signum()).collect();
        let coordinate = Coordinate {
            name: "x".into(),
            unit: "m".into(),
            values,
            parity: opposed.then_some(signs),
            state: true,
        };
        map(&coordinate, &residual, &time)
    }

    #[test]
    fn ninety_five_per_cent_bands_of_nothing_hold_zero_in_about_ninety_five_per_cent() {
        for opposed in [false, true] {
            let (mut inside, mut all) = (0, 0);
            for bin in (0..60).flat_map(|seed| trial(seed, opposed).bins) {
                all += 1;
                inside += usize::from(bin.low <= 0.0 && 0.0 <= bin.high);
            }
            let share = f64::from(inside as u32) / f64::from(all as u32);
            // Bands for independent points hold it in about 50 %.
            assert!((0.91..=0.985).contains(&share), "{opposed}: {share}");
        }
    }

    #[test]
    fn a_constant_residual_has_a_map_without_a_band() {
        let values: Vec<f64> = (0..100).map(|k| (0.3 * f64::from(k)).sin()).collect();
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let coordinate =
            Coordinate { name: "x".into(), unit: "m".into(), values, parity: None, state: true };
        let map = map(&coordinate, &[2.0; 100], &time);
        assert!(map.bins.iter().all(|bin| bin.low == 2.0 && bin.high == 2.0));
    }
}
