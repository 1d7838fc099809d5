//! Individuals with their positions and costs.

use serde::{Deserialize, Serialize, de::DeserializeOwned};

use crate::{Points, Scalar};

/// What an individual carries beside its position and its cost, and what it learns from a
/// competition. `()` for algorithms whose individuals carry nothing.
pub trait Individual<T: Scalar>: Clone + Send + Sync + Serialize + DeserializeOwned {
    /// This child replaced its parent; positions are in search coordinates.
    fn won(&mut self, _parent: &[T], _child: &[T]) {}

    /// This parent survived its child.
    fn survived(&mut self) {}

    /// Whether it belongs to positions of so many components; a damaged checkpoint may hold one that does not.
    fn fits(&self, _dimension: usize) -> bool {
        true
    }
}

impl<T: Scalar> Individual<T> for () {}

/// Positions (search coordinates), costs and individuals, one slot each.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "I: Individual<T>")]
pub struct Population<T: Scalar, I> {
    /// Positions in search coordinates.
    pub positions: Points<T>,
    /// Costs; infinite where the evaluation failed.
    pub costs: Vec<T>,
    /// What each individual carries.
    pub individuals: Vec<I>,
}

impl<T: Scalar, I> Population<T, I> {
    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.costs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.costs.is_empty()
    }

    /// The slot with the smallest cost.
    pub fn best(&self) -> usize {
        let mut best = 0;
        for (i, cost) in self.costs.iter().enumerate() {
            if *cost < self.costs[best] {
                best = i;
            }
        }
        best
    }

    /// Slots from the best to the worst.
    pub fn ranking(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.len()).collect();
        order.sort_by(|&a, &b| {
            self.costs[a].partial_cmp(&self.costs[b]).unwrap_or(std::cmp::Ordering::Equal)
        });
        order
    }

    /// Whether it can take the place of another one.
    pub(crate) fn is_like(&self, other: &Self) -> bool
    where
        I: Individual<T>,
    {
        let dimension = other.positions.dimension();
        let numbers = |p: &Self| p.positions.batch().as_slice().len();
        let shape = |p: &Self| (p.len(), p.individuals.len(), p.positions.dimension(), numbers(p));
        shape(self) == shape(other)
            && self.individuals.iter().all(|carried| carried.fits(dimension))
    }

    /// Replaces slot `i` by slot `k` of `other`, which then holds an old individual.
    #[inline]
    pub fn take(&mut self, i: usize, other: &mut Self, k: usize) {
        self.positions.row_mut(i).copy_from_slice(other.positions.row(k));
        self.costs[i] = other.costs[k];
        std::mem::swap(&mut self.individuals[i], &mut other.individuals[k]);
    }
}
