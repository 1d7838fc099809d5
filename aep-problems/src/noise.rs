//! Noise that can be repeated.

use aep_core::Purpose;
use aep_core::random::{Stream, Streams};

/// The random numbers of an evaluation: a function of `seed` and of the position, so that a noisy run
/// can be repeated too.
pub fn stream_at(seed: u64, z: &[f64]) -> Stream {
    let key = z.iter().fold(seed, |key, z| Streams::new(key, Purpose::Trial, z.to_bits()).word(0));
    Streams::new(key, Purpose::Trial, 1).stream(0)
}
