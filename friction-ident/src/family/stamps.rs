//! Whether it is the samples that jitter, or the time stamps alone.
//!
//! A drive samples by its clock; who writes the samples down may stamp them by another one. Where the stamps are right the
//! position lies off the even grid by its velocity times the jitter, where they are wrong it does not: a regression of what
//! is fast in the position on what is fast in that product tells, one or nothing. Of an encoder of nanometres a jitter of a
//! hundredth of a sample is several times what the sensor makes.

use std::ops::Range;

use missing_physics::Recording;
use missing_physics::ahead::statistics::spread;
use missing_physics::statistics::basis::dot;

/// Samples to either side over which a velocity is taken.
const REACH: usize = 4;
/// Samples of a block: errors within one may be alike.
const BLOCK: usize = 64;
/// Standard errors by which the position must lie nearer to the even grid than to the stamps.
const CLEAR: f64 = 3.0;
/// What lies further away than so many standard deviations says nothing: an impact, a count at the turn.
const OUTLIER: f64 = 4.0;
/// Fewest samples of a segment that are asked.
const LEAST: usize = 32;
/// Smallest way that an axis goes by the jitter, as a share of what else is fast in its position: less than a hundredth of the
/// square makes no difference.
const MATTERS: f64 = 0.1;

/// A recording with even samples in the place of stamps that jitter.
pub(super) struct Even {
    pub recording: Recording,
    /// Root mean square of what its stamps were off, as a share of a sample.
    pub jitter: f64,
}

/// One segment: where its stamps lie on an even grid.
struct Grid {
    samples: Range<usize>,
    /// Even instants, s.
    even: Vec<f64>,
    /// By how much each stamp is later, s.
    late: Vec<f64>,
}

impl Grid {
    /// The grid nearest to the stamps; nothing where a stamp is off by half a sample or more: then rows are missing, or the
    /// rate changes.
    fn of(samples: Range<usize>, time: &[f64]) -> Option<Self> {
        let time = &time[samples.clone()];
        let n = time.len() as f64;
        if time.len() < LEAST {
            return None;
        }
        let middle = 0.5 * (n - 1.0);
        let mean = time.iter().sum::<f64>() / n;
        let centred = |k: usize| k as f64 - middle;
        let slope: f64 = time.iter().enumerate().map(|(k, t)| centred(k) * (t - mean)).sum::<f64>()
            * 12.0
            / (n * (n * n - 1.0));
        let even: Vec<f64> = (0..time.len()).map(|k| mean + slope * centred(k)).collect();
        let late: Vec<f64> = time.iter().zip(&even).map(|(t, even)| t - even).collect();
        let is_near = slope > 0.0 && late.iter().all(|late| late.abs() < 0.5 * slope);
        is_near.then_some(Self { samples, even, late })
    }

    /// What is fast in the position, and in the way that it goes by the jitter.
    fn fast(&self, position: &[f64]) -> Vec<(f64, f64)> {
        let position = &position[self.samples.clone()];
        let last = position.len() - 1;
        let way = |k: usize| {
            let (from, to) = (k.saturating_sub(REACH), (k + REACH).min(last));
            (position[to] - position[from]) / (self.even[to] - self.even[from]) * self.late[k]
        };
        let ways: Vec<f64> = (0..=last).map(way).collect();
        let third = |x: &[f64]| x[3] - 3.0 * x[2] + 3.0 * x[1] - x[0];
        position.windows(4).map(third).zip(ways.windows(4).map(third)).collect()
    }
}

/// The recording on an even grid, where its stamps jitter and its position says that its samples do not.
pub(super) fn even(recording: &Recording) -> Option<Even> {
    let position = recording.require("position").ok()?;
    let grids: Option<Vec<Grid>> =
        recording.segments().iter().map(|s| Grid::of(s.clone(), recording.time())).collect();
    let grids = grids?;
    let late = grids.iter().flat_map(|grid| &grid.late);
    let square: f64 = late.map(|late| late * late).sum();
    let jitter = (square / recording.len() as f64).sqrt() / recording.interval();
    let fast: Vec<(f64, f64)> = grids.iter().flat_map(|grid| grid.fast(position)).collect();
    let (share, error) = share(&fast)?;
    if share + CLEAR * error >= 0.5 {
        return None;
    }
    let time = grids.into_iter().flat_map(|grid| grid.even).collect();
    let recording = recording.clone().with_time(time).ok()?;
    Some(Even { recording, jitter })
}

/// The share of the second of each pair that is in the first, and its standard error; nothing where the second is too small
/// beside the rest to matter.
fn share(pairs: &[(f64, f64)]) -> Option<(f64, f64)> {
    let (both, square) = sums(pairs.iter());
    let all = both / square;
    let off = |(y, z): &(f64, f64)| y - all * z;
    let rest: Vec<f64> = pairs.iter().filter(|(_, z)| *z != 0.0).map(off).collect();
    if rest.is_empty() || square <= MATTERS * MATTERS * dot(&rest, &rest) {
        return None;
    }
    let most = OUTLIER * spread(&rest);
    let near = |pair: &&(f64, f64)| off(pair).abs() <= most;
    let (both, square) = sums(pairs.iter().filter(near));
    if square <= 0.0 {
        return None;
    }
    let share = both / square;
    let blocks = pairs.chunks(BLOCK).map(|block| {
        let (both, square) = sums(block.iter().filter(near));
        (both - share * square).powi(2)
    });
    Some((share, blocks.sum::<f64>().sqrt() / square))
}

/// Of the products of each pair, and of the squares of its second.
fn sums<'a>(pairs: impl Iterator<Item = &'a (f64, f64)>) -> (f64, f64) {
    pairs.fold((0.0, 0.0), |(both, square), (y, z)| (both + y * z, square + z * z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::Channel;
    use rand::{RngExt, SeedableRng};

    /// A motion of which the samples, the stamps or both are off by up to `jitter` of one, read in counts.
    fn recording(samples: f64, stamps: f64, count: f64) -> Recording {
        let mut random = rand::rngs::StdRng::seed_from_u64(1);
        let mut off = |jitter: f64| jitter * random.random_range(-1.0..1.0);
        let (mut time, mut position) = (Vec::new(), Vec::new());
        for k in 0..6000 {
            let even = f64::from(k) * 1e-3;
            let (sample, stamp) = (off(samples) * 1e-3, off(stamps) * 1e-3);
            let x: f64 = 0.1 * (5.0 * (even + sample)).sin();
            position.push((x / count).round() * count);
            // Who stamps a sample as it is knows when it was.
            time.push(even + if stamps == 0.0 { sample } else { stamp });
        }
        let force = position.iter().map(|x| -2.5 * x).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Recording::new("jitter", time, channels).unwrap()
    }

    #[test]
    fn stamps_that_jitter_beside_even_samples_are_made_even() {
        for (stamps, count) in [(0.01, 1e-8), (0.4, 1e-6)] {
            let even = even(&recording(0.0, stamps, count)).unwrap();
            assert!((even.jitter / (stamps / 3.0_f64.sqrt()) - 1.0).abs() < 0.05);
            let steps = even.recording.time().windows(2).map(|pair| pair[1] - pair[0]);
            assert!(steps.into_iter().all(|step| (step / 1e-3 - 1.0).abs() < 1e-4));
        }
    }

    #[test]
    fn samples_that_jitter_keep_their_stamps_and_even_ones_too() {
        for (samples, stamps) in [(0.01, 0.0), (0.4, 0.0), (0.0, 0.0)] {
            assert!(even(&recording(samples, stamps, 1e-8)).is_none(), "{samples} {stamps}");
        }
        // Counts that are far larger than what the jitter makes tell neither.
        assert!(even(&recording(0.0, 0.001, 1e-3)).is_none());
    }

    #[test]
    fn where_rows_are_missing_nothing_is_evened() {
        let all = recording(0.0, 0.01, 1e-8);
        let kept = |values: &[f64]| [&values[..3000], &values[3100..]].concat();
        let channels = all.channels().iter();
        let channels = channels.map(|c| Channel::new(&*c.name, &*c.unit, kept(&c.values)));
        let holed = Recording::new("holed", kept(all.time()), channels.collect()).unwrap();
        assert!(even(&holed).is_none());
    }
}
