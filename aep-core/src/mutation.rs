//! How a child is made.

use crate::random::Stream;
use crate::{Domain, Individual, Population, Scalar};

/// Where a mutation writes its child.
#[derive(Debug)]
pub struct Child<'a, T: Scalar, I> {
    /// Position in search coordinates; holds old numbers, every component must be written.
    pub position: &'a mut [T],
    /// What the child carries; holds an old individual, must be written too.
    pub individual: &'a mut I,
}

/// How one child is made from one parent, with a view of the whole population.
///
/// Everything random must come from the stream passed in: it belongs to this individual in this
/// generation, which is what makes runs reproducible and resumable. State that depends on the
/// population is computed in [`Mutation::prepare`]; it is not saved in checkpoints because it is
/// computed again before it is used.
pub trait Mutation<T: Scalar>: Send + Sync {
    /// What an individual carries for this mutation.
    type Individual: Individual<T>;

    /// What an individual carries at the start.
    fn individual(&self, domain: &Domain<T>, rng: &mut Stream) -> Self::Individual;

    /// Called once before the children of a generation are made.
    fn prepare(&mut self, _population: &Population<T, Self::Individual>, _domain: &Domain<T>) {}

    /// Makes the child of the individual in slot `parent`.
    fn mutate(
        &self,
        parent: usize,
        population: &Population<T, Self::Individual>,
        domain: &Domain<T>,
        rng: &mut Stream,
        child: Child<'_, T, Self::Individual>,
    );
}
