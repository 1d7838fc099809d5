//! Rule 1: what an AEP individual remembers.

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use crate::random::{Stream, coin};
use crate::{Individual, Scalar, wide};

/// Search direction per component and age.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AepIndividual {
    /// In place for as many components as most tasks have: individuals lie side by side in memory.
    directions: SmallVec<[i8; 16]>,
    age: u32,
}

impl AepIndividual {
    /// Random directions, age 1.
    pub fn random(dimension: usize, rng: &mut Stream) -> Self {
        let mut local = rng.clone();
        let directions = (0..dimension).map(|_| if coin(&mut local) { 1 } else { -1 }).collect();
        *rng = local;
        Self { directions, age: 1 }
    }

    /// -1 or +1 per component.
    #[inline]
    pub fn directions(&self) -> &[i8] {
        &self.directions
    }

    /// Generations since the last success, plus one.
    #[inline]
    pub fn age(&self) -> u32 {
        self.age
    }

    /// Takes over what `other` carries, without allocating.
    #[inline]
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.directions.copy_from_slice(&other.directions);
        self.age = other.age;
    }
}

impl<T: Scalar> Individual<T> for AepIndividual {
    /// d = sgn(child - parent), age = 1. A component that did not move (the border held it) keeps
    /// its direction: the paper's d is -1 or +1, never 0.
    fn won(&mut self, parent: &[T], child: &[T]) {
        wide::turn(&mut self.directions, parent, child);
        self.age = 1;
    }

    fn survived(&mut self) {
        self.age = self.age.saturating_add(1);
    }

    fn fits(&self, dimension: usize) -> bool {
        self.directions.len() == dimension && self.directions.iter().all(|d| matches!(d, -1 | 1))
    }
}
