//! Which part of the data is fitted and which is held out.
//!
//! Whole blocks are held out, never single samples: residuals are autocorrelated, so that a sample
//! between two fitted neighbours says nothing new.

use std::ops::Range;

use crate::report::SplitError;

/// Blocks that a recording without repeats is cut into.
const BLOCKS: usize = 15;

/// Marks every grid point as fitted or held out.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    blocks: Vec<Range<usize>>,
    held_out: Vec<bool>,
}

impl Split {
    /// Holds out a third of the blocks, spread so that no periodic motion can fall in step with
    /// them. `blocks` are those that the family wants (cycles of a repeated motion); where it has
    /// fewer than three, `points` grid points are cut evenly.
    pub fn new(points: usize, blocks: Vec<Range<usize>>) -> Self {
        let blocks = if blocks.len() >= 3 { blocks } else { even(points, BLOCKS) };
        let held_out = (0..blocks.len()).map(is_held_out).collect();
        Self { blocks, held_out }
    }

    /// Blocks in order of time, with whether each is held out.
    pub fn blocks(&self) -> impl Iterator<Item = (&Range<usize>, bool)> {
        self.blocks.iter().zip(self.held_out.iter().copied())
    }

    /// One flag per grid point: true where it is fitted. Points outside every block are neither
    /// fitted nor held out; see [`Split::validation`].
    pub fn fit(&self, points: usize) -> Vec<bool> {
        self.mask(points, false)
    }

    /// One flag per grid point: true where it is held out.
    pub fn validation(&self, points: usize) -> Vec<bool> {
        self.mask(points, true)
    }

    fn mask(&self, points: usize, held_out: bool) -> Vec<bool> {
        let mut mask = vec![false; points];
        for (range, out) in self.blocks() {
            if out == held_out {
                mask[range.clone()].fill(true);
            }
        }
        mask
    }

    /// Root mean square of `values` on fitted and on held-out points.
    pub fn rms(&self, values: &[f64]) -> SplitError {
        let part = |held_out: bool| {
            let (mut sum, mut count) = (0.0, 0usize);
            for (range, out) in self.blocks() {
                if out == held_out {
                    sum += values[range.clone()].iter().map(|value| value * value).sum::<f64>();
                    count += range.len();
                }
            }
            (sum / count.max(1) as f64).sqrt()
        };
        SplitError { fit: part(false), validation: part(true) }
    }
}

/// A third of all blocks in an aperiodic order (multiples of the golden ratio, modulo 1).
fn is_held_out(block: usize) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    ((block as f64 + 1.0) * GOLDEN).fract() < 1.0 / 3.0
}

fn even(points: usize, count: usize) -> Vec<Range<usize>> {
    (0..count).map(|k| k * points / count..(k + 1) * points / count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn about_a_third_is_held_out_and_nothing_twice() {
        let split = Split::new(3000, Vec::new());
        let (fit, out) = (split.fit(3000), split.validation(3000));
        assert!(fit.iter().zip(&out).all(|(a, b)| a != b));
        let share = out.iter().filter(|held| **held).count() as f64 / 3000.0;
        assert!((0.2..0.45).contains(&share), "{share}");
    }

    #[test]
    fn three_or_four_cycles_leave_at_least_one_on_each_side() {
        for cycles in 3..6 {
            let split = Split::new(400, even(400, cycles));
            let out = split.blocks().filter(|(_, held)| *held).count();
            assert!(out >= 1 && out < cycles, "{cycles} cycles: {out} held out");
        }
    }
}
