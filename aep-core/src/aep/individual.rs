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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Purpose, Streams};

    #[test]
    fn half_of_the_directions_go_down_and_half_go_up() {
        let mut rng = Streams::new(3, Purpose::Individual, 0).stream(0);
        let random = AepIndividual::random(10_000, &mut rng);
        let down = random.directions().iter().filter(|d| **d == -1).count();
        assert!(random.directions().iter().all(|d| d.abs() == 1) && random.age() == 1);
        // Four standard deviations.
        assert!((4_800..=5_200).contains(&down), "{down}");
    }

    #[test]
    fn what_does_not_belong_to_its_positions_does_not_fit() {
        let carried = |directions: &[i8]| AepIndividual { directions: directions.into(), age: 1 };
        let fits = |directions: &[i8]| Individual::<f64>::fits(&carried(directions), 2);
        assert!(fits(&[1, -1]));
        assert!(!fits(&[1]) && !fits(&[1, -1, 1]) && !fits(&[1, 0]));
    }
}
