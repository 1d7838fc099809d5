//! Whether costs repeat themselves.

use serde::{Deserialize, Serialize};

use super::lineage::Lineage;

/// Positions whose cost has to come again before costs are taken for free of noise.
const ENOUGH: u32 = 10;

/// What evaluating positions once more has told of the run's cost.
///
/// A lineage that no longer becomes better may have arrived, or its lowest cost is chance's: that position is evaluated once
/// more, beside the next children. Another cost tells noise for good. Of all positions this is the one to ask: of
/// noise that is seldom (outliers) it is the likeliest victim.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Repeats {
    /// Positions that still may be asked.
    left: u32,
    noisy: bool,
}

impl Repeats {
    /// Before anything was evaluated; nothing ever is evaluated once more where that is not `wanted`.
    pub fn new(wanted: bool) -> Self {
        Self { left: if wanted { ENOUGH } else { 0 }, noisy: false }
    }

    /// Whether a position has had two costs.
    pub fn noisy(self) -> bool {
        self.noisy
    }

    /// What is evaluated beside the children of a lineage: a position, or nothing.
    pub fn asked(self, lineage: &Lineage) -> &[f64] {
        lineage.doubted().filter(|_| self.left > 0).map_or(&[], |(position, _)| position)
    }

    /// Takes the cost of that position, the last one, from those of the children; numbers are known to `epsilon` of their
    /// size.
    pub fn compare<'a>(
        &mut self,
        lineage: &mut Lineage,
        costs: &'a [f64],
        epsilon: f64,
    ) -> &'a [f64] {
        let first = lineage.doubted().filter(|_| self.left > 0).map(|(_, cost)| cost);
        let (Some(first), Some((again, costs))) = (first, costs.split_last()) else { return costs };
        self.note(first, *again, epsilon);
        lineage.note_repeated(self.noisy);
        costs
    }

    fn note(&mut self, first: f64, again: f64, epsilon: f64) {
        // A sum in another order is no noise.
        let allowed = 1e5 * epsilon * first.abs();
        let same = (again - first).abs() <= allowed;
        self.noisy = !same;
        self.left = if self.noisy { 0 } else { self.left - 1 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_other_cost_tells_noise_and_ten_equal_ones_that_there_is_none() {
        let mut repeats = Repeats::new(true);
        (1..ENOUGH).for_each(|_| repeats.note(3.0, 3.0, f64::EPSILON));
        assert_eq!((repeats.left, repeats.noisy()), (1, false));
        let mut exact = repeats;
        exact.note(3.0, 3.0 + 1e-14, f64::EPSILON);
        assert_eq!((exact.left, exact.noisy()), (0, false));
        repeats.note(3.0, f64::INFINITY, f64::EPSILON);
        assert_eq!((repeats.left, repeats.noisy()), (0, true));
    }
}
