//! Motion that repeats: how long a cycle is, and how well the force repeats from one to the next.

use serde::{Deserialize, Serialize};

use crate::measurement::Recording;
use crate::measurement::quantity::quantity;

/// Motion that repeats.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Length of a cycle in samples.
    pub samples: usize,
    /// Length of a cycle, s.
    pub period_s: f64,
    /// Whole cycles in the recording.
    pub cycles: usize,
    /// Root mean square of what differs in the force from cycle to cycle, over the square root of
    /// two: the part of the force that no model of the motion can explain.
    pub force_repeatability: Option<f64>,
    /// Unit of the force.
    pub force_unit: String,
}

/// The scan for the period looks at about this many samples.
const COARSE: usize = 1500;
/// What differs from cycle to cycle, as a share of the signal's own deviation.
const COARSE_MATCH: f64 = 0.1;
const MATCH: f64 = 0.02;
/// Most pairs of samples that the search for the exact period looks at for a candidate: those of 270 000 samples.
const MOST_PAIRS: usize = 100_000_000;
/// How far from the best lag of a part that of the whole is looked for.
const LAST_LAGS: usize = 3;

impl Cycle {
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        // Over several segments a sample's number says nothing of the motion.
        let [_] = recording.segments() else {
            return None;
        };
        let motion = recording.channel("reference").or_else(|| recording.channel("position"))?;
        let samples = period(&motion.values)?;
        let force = recording.channel("force");
        Some(Self {
            samples,
            period_s: samples as f64 * recording.interval(),
            cycles: motion.values.len() / samples,
            force_repeatability: force
                .map(|force| difference(&force.values, samples) / std::f64::consts::SQRT_2),
            force_unit: force.map(|force| force.unit.clone()).unwrap_or_default(),
        })
    }

    pub(super) fn in_words(&self) -> String {
        let motion = format!(
            "the motion repeats every {}, {} times",
            quantity(self.period_s, "s"),
            self.cycles
        );
        let Some(force) = self.force_repeatability else {
            return motion;
        };
        let force = quantity(force, &self.force_unit);
        format!("{motion}; from cycle to cycle the force differs by {force} rms")
    }
}

/// The shortest lag after which the signal repeats, at least twice.
fn period(values: &[f64]) -> Option<usize> {
    let stride = values.len().div_ceil(COARSE).max(1);
    let coarse: Vec<f64> = values.iter().copied().step_by(stride).collect();
    let spread = deviation(&coarse);
    if spread == 0.0 {
        return None;
    }
    // A smooth signal is like itself after a few samples: first it must become unlike.
    let lags = 1..=coarse.len() / 2;
    let unlike = lags.clone().find(|&lag| difference(&coarse, lag) > spread)?;
    let candidates = (unlike..*lags.end()).filter(|&lag| {
        let here = difference(&coarse, lag);
        here < COARSE_MATCH * spread && here <= difference(&coarse, lag + 1)
    });
    candidates.take(20).find_map(|lag| {
        let best = refined(values, lag * stride, stride)?;
        (difference(values, best) < MATCH * spread).then_some(best)
    })
}

/// The best lag around `near`. Looked for on part of a very long recording, as the time grows with its square, and then
/// once more on all of it next to what was found.
fn refined(values: &[f64], near: usize, stride: usize) -> Option<usize> {
    let longest = values.len() / 2;
    let around = |near: usize, by: usize| near.saturating_sub(by)..=(near + by).min(longest);
    let best = |lags: std::ops::RangeInclusive<usize>, skip: usize| {
        let of = |lag: usize| every(values, lag, skip);
        lags.min_by(|&a, &b| of(a).total_cmp(&of(b)))
    };
    let skip = (2 * stride).saturating_mul(values.len()).div_ceil(MOST_PAIRS);
    let found = best(around(near, stride), skip)?;
    if skip > 1 { best(around(found, LAST_LAGS), 1) } else { Some(found) }
}

/// [`difference`] from every `skip`-th sample.
fn every(values: &[f64], lag: usize, skip: usize) -> f64 {
    if skip == 1 {
        return difference(values, lag);
    }
    let pairs = values.iter().zip(&values[lag..]).step_by(skip);
    let (count, squares) =
        pairs.fold((0u32, 0.0), |(count, sum), (a, b)| (count + 1, sum + (b - a).powi(2)));
    (squares / f64::from(count.max(1))).sqrt()
}

/// Root mean square of `x(k + lag) - x(k)`.
fn difference(values: &[f64], lag: usize) -> f64 {
    let pairs = values.iter().zip(&values[lag..]);
    let squares: f64 = pairs.map(|(a, b)| (b - a).powi(2)).sum();
    (squares / (values.len() - lag).max(1) as f64).sqrt()
}

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_period_of_a_recording_that_is_searched_in_part_is_exact() {
        let cycle = 43_211;
        let signal = |k: usize| {
            let turn = std::f64::consts::TAU * (k % cycle) as f64 / cycle as f64;
            turn.sin() + 0.3 * (3.0 * turn).cos()
        };
        let values: Vec<f64> = (0..600_000).map(signal).collect();
        let stride = values.len().div_ceil(COARSE);
        assert!(2 * stride * values.len() > MOST_PAIRS, "all of it is searched");
        assert_eq!(period(&values), Some(cycle));
    }
}
