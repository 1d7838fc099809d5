//! Residuals that no effect can have made: the measured one, shifted in time.
//!
//! A shift keeps the size, the spikes and the autocorrelation of a residual and breaks its alignment
//! with the motion. What a candidate gains on shifted residuals is what it gains by chance. Ordinary
//! t-tests and information criteria take the samples for independent and accept smooth placebos far
//! too often.

use rand::RngExt;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::statistics::basis::dot;

/// Shifts at which the motion resembles itself more than this are no placebos: a periodic motion
/// shifted by its period is the same experiment.
const SELF_SIMILAR: f64 = 0.3;
/// Shortest shift as a share of the recording.
const SHORTEST: f64 = 0.02;
/// Where fewer shifts than this share of all remain, blocks are shuffled instead.
const ENOUGH: f64 = 0.2;
/// Blocks of a shuffle.
const BLOCKS: usize = 24;

/// Draws `count` rearrangements of the grid: entry `i` of one says which residual stands at point
/// `i`. `motion` holds the signals (a velocity, its sign) whose self-similarity rules a shift out.
pub fn rearrangements(
    points: usize,
    count: usize,
    motion: &[Vec<f64>],
    seed: u64,
) -> Vec<Vec<usize>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let shortest = ((points as f64 * SHORTEST) as usize).max(1);
    let shifts: Vec<usize> = (shortest..points.saturating_sub(shortest))
        .filter(|&shift| motion.iter().all(|signal| similarity(signal, shift) < SELF_SIMILAR))
        .collect();
    if (shifts.len() as f64) < ENOUGH * points as f64 {
        return (0..count).map(|_| shuffled(points, &mut random)).collect();
    }
    (0..count)
        .map(|_| {
            let shift = shifts[random.random_range(0..shifts.len())];
            // A reversed residual is as good a placebo and doubles their number.
            let reverse = random.random_bool(0.5);
            (0..points)
                .map(|i| {
                    let k = (i + shift) % points;
                    if reverse { points - 1 - k } else { k }
                })
                .collect()
        })
        .collect()
}

/// Absolute circular correlation of a signal with itself, shifted.
fn similarity(signal: &[f64], shift: usize) -> f64 {
    let (head, tail) = signal.split_at(shift);
    let all = dot(signal, signal);
    if all == 0.0 {
        return 0.0;
    }
    let rest = signal.len() - shift;
    ((dot(tail, &signal[..rest]) + dot(head, &signal[rest..])) / all).abs()
}

/// Draws `count` orders of the grid in which whole blocks of time stand at random places: what lasts
/// longer than a block is broken.
pub fn shuffles(points: usize, count: usize, seed: u64) -> Vec<Vec<usize>> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count).map(|_| shuffled(points, &mut random)).collect()
}

/// Blocks of the grid in random order, each forwards or backwards.
fn shuffled(points: usize, random: &mut Xoshiro256PlusPlus) -> Vec<usize> {
    let offset = random.random_range(0..points);
    let mut order: Vec<usize> = (0..BLOCKS).collect();
    for k in (1..BLOCKS).rev() {
        order.swap(k, random.random_range(0..=k));
    }
    let mut indices = Vec::with_capacity(points);
    for block in order {
        let mut range: Vec<usize> = (block * points / BLOCKS..(block + 1) * points / BLOCKS)
            .map(|i| (i + offset) % points)
            .collect();
        if random.random_bool(0.5) {
            range.reverse();
        }
        indices.append(&mut range);
    }
    indices
}

/// The p-value of a statistic among those of placebos: never 0, as one more placebo could exceed it.
pub fn p_value(statistic: f64, placebos: &[f64]) -> f64 {
    let beyond = placebos.iter().filter(|placebo| **placebo >= statistic).count();
    (beyond + 1) as f64 / (placebos.len() + 1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_residual_stands_somewhere_exactly_once() {
        let periodic: Vec<f64> = (0..500).map(|k| (f64::from(k) * 0.3).sin()).collect();
        for motion in [vec![], vec![periodic]] {
            for order in rearrangements(500, 20, &motion, 3) {
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert!(sorted.into_iter().eq(0..500));
            }
        }
    }

    #[test]
    fn a_shift_by_the_period_is_no_placebo() {
        let square: Vec<f64> = (0..1000).map(|k| if k % 500 < 250 { 1.0 } else { -1.0 }).collect();
        assert!(similarity(&square, 500) > 0.99 && similarity(&square, 250) > 0.99);
        assert!(similarity(&square, 125) < 0.1);
    }
}
