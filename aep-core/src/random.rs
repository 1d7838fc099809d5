//! Random streams that depend on what is drawn, never on when or by which thread.
//!
//! Every random number of a run comes from a fresh stream named by (seed, purpose, generation,
//! individual). A run is therefore a function of its seed alone: one thread, many threads and a
//! run resumed from a checkpoint draw the same numbers, and there is no generator state to save.

use rand::{Rng, RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::Scalar;

/// The generator behind every stream. Named, because `StdRng` may change between versions.
pub type Stream = Xoshiro256PlusPlus;

/// What a stream is used for. Two purposes never share numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
#[non_exhaustive]
pub enum Purpose {
    /// Positions of the initial population: the same for every algorithm of a comparison.
    Initial = 1,
    /// What an individual carries at the start (directions, ages, step sizes).
    Individual = 2,
    /// Children.
    Mutation = 3,
    /// Competition.
    Selection = 4,
    /// Seeds of trials.
    Trial = 5,
    /// Seeds of restarted runs.
    Restart = 6,
}

/// All the streams of one generation for one purpose.
#[derive(Clone, Copy, Debug)]
pub struct Streams {
    key: u64,
}

impl Streams {
    /// The streams named by `seed`, `purpose` and `generation`.
    pub fn new(seed: u64, purpose: Purpose, generation: u64) -> Self {
        let key = mix(mix(mix(seed).wrapping_add(purpose as u64)).wrapping_add(generation));
        Self { key }
    }

    /// The stream of one individual.
    #[inline]
    pub fn stream(self, individual: usize) -> Stream {
        Stream::seed_from_u64(self.word(individual))
    }

    /// A single 64-bit number in place of a stream, for deriving seeds.
    #[inline]
    pub fn word(self, individual: usize) -> u64 {
        self.key ^ mix(individual as u64)
    }
}

/// The finaliser of `SplitMix64`: a bijection on 64 bits whose output bits all depend on all input
/// bits (Steele, Lea & Flood 2014).
#[inline]
fn mix(value: u64) -> u64 {
    let z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// One number from N(0, 1).
#[inline]
pub fn normal<T: Scalar>(rng: &mut Stream) -> T {
    T::of(rng.sample::<f64, _>(StandardNormal))
}

/// Fills `numbers` from N(0, 1). The generator's state stays in registers for the whole row.
#[inline]
pub fn fill_normal<T: Scalar>(rng: &mut Stream, numbers: &mut [T]) {
    let mut local = rng.clone();
    for number in numbers {
        *number = normal(&mut local);
    }
    *rng = local;
}

/// One number from the uniform distribution on [0, 1).
#[inline]
pub fn uniform<T: Scalar>(rng: &mut Stream) -> T {
    T::of(rng.random::<f64>())
}

/// One index below `bound`; 0 where there is none.
#[inline]
pub fn index(rng: &mut Stream, bound: usize) -> usize {
    rng.random_range(0..bound.max(1))
}

/// True or false, each with probability 1/2.
#[inline]
pub fn coin(rng: &mut Stream) -> bool {
    rng.next_u64() >> 63 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_fixed_by_their_name() {
        let draw = |seed, purpose, generation, i| {
            normal::<f64>(&mut Streams::new(seed, purpose, generation).stream(i))
        };
        let reference = draw(1, Purpose::Mutation, 2, 3);
        assert_eq!(reference, draw(1, Purpose::Mutation, 2, 3));
        assert_ne!(reference, draw(2, Purpose::Mutation, 2, 3));
        assert_ne!(reference, draw(1, Purpose::Selection, 2, 3));
        assert_ne!(reference, draw(1, Purpose::Mutation, 3, 3));
        assert_ne!(reference, draw(1, Purpose::Mutation, 2, 4));
    }

    #[test]
    fn a_coin_is_an_index_below_two() {
        let (mut one, mut other) = (Stream::seed_from_u64(3), Stream::seed_from_u64(3));
        for _ in 0..1_000 {
            assert_eq!(coin(&mut one), index(&mut other, 2) == 1);
        }
    }

    /// Five-sigma bounds on 10^5 first draws of neighbouring streams: a correct generator fails
    /// once in 10^6 changes of the seed.
    #[test]
    fn first_draws_of_neighbouring_streams_are_standard_normal() {
        let count = 100_000;
        let streams = Streams::new(7, Purpose::Mutation, 1);
        let draws: Vec<f64> = (0..count).map(|i| normal(&mut streams.stream(i))).collect();
        let mean = draws.iter().sum::<f64>() / count as f64;
        let variance = draws.iter().map(|x| x * x).sum::<f64>() / count as f64;
        let lag: f64 = draws.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / count as f64;
        let limit = 5.0 / (count as f64).sqrt();
        assert!(mean.abs() < limit, "mean {mean}");
        assert!((variance - 1.0).abs() < limit * 2f64.sqrt(), "variance {variance}");
        assert!(lag.abs() < limit, "correlation of neighbours {lag}");
    }
}
