//! Competition of each child with its own parent.

use crate::random::Streams;
use crate::{Individual, Population, Scalar, Selection};

/// A child competes with its parent only (the paper's step 5).
///
/// Nobody else is displaced, so the population keeps its diversity, and the best cost can never
/// get worse. The paper then sorts the population. No rule of AEP depends on the order, so
/// individuals stay in their slots here; [`Population::ranking`] gives the order when somebody
/// asks for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OneToOne {
    /// The child must be better to replace its parent, as in AEP.
    #[default]
    Strict,
    /// An equally good child replaces its parent too, as in differential evolution: moves across
    /// plateaus.
    AcceptEqual,
}

impl OneToOne {
    #[inline]
    fn replaces<T: Scalar>(self, child: T, parent: T) -> bool {
        child < parent || (self == Self::AcceptEqual && child == parent)
    }

    /// The contest in slot `i` alone.
    #[inline]
    pub(crate) fn compete<T: Scalar, I: Individual<T>>(
        self,
        parents: &mut Population<T, I>,
        children: &mut Population<T, I>,
        i: usize,
    ) {
        if self.replaces(children.costs[i], parents.costs[i]) {
            let (from, to) = (parents.positions.row(i), children.positions.row(i));
            children.individuals[i].won(from, to);
            parents.take(i, children, i);
        } else {
            parents.individuals[i].survived();
        }
    }
}

impl<T: Scalar, I: Individual<T>> Selection<T, I> for OneToOne {
    fn select(&self, parents: &mut Population<T, I>, children: &mut Population<T, I>, _: Streams) {
        for i in 0..parents.len() {
            self.compete(parents, children, i);
        }
    }
}
