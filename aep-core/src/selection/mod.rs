//! Who survives.

mod one_to_one;
mod tournament;

pub use one_to_one::OneToOne;
pub use tournament::{Ties, Tournament};

use crate::random::Streams;
use crate::{Individual, Population, Scalar};

/// Competition between parents and their children. Child `i` descends from parent `i`.
///
/// After the call `parents` holds the survivors, as many as before; `children` may hold anything.
/// The selection tells each individual how its competition ended ([`Individual::won`],
/// [`Individual::survived`]).
pub trait Selection<T: Scalar, I: Individual<T>>: Send + Sync {
    /// Moves the survivors into `parents`.
    fn select(
        &self,
        parents: &mut Population<T, I>,
        children: &mut Population<T, I>,
        streams: Streams,
    );
}
