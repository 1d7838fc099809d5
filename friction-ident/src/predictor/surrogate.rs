//! A recording that a model would have made: its own predictions with its own errors in another order.
//!
//! What the errors have to do with the motion is gone, their sizes and their colour are not: whatever is found in it
//! beyond that model is a false alarm (J. Theiler and others, Physica D 58, 1992: surrogate data).

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::Predictor;
use crate::model::Model;

/// Length of the blocks that change places, s: longer than what the errors remember.
const BLOCK: f64 = 0.25;

impl Predictor {
    /// Positions that `model` predicts at a setting, plus its own errors in blocks that changed places and some of them
    /// signs; nothing where the model runs away.
    pub fn surrogate(&self, model: &Model, setting: usize, seed: u64) -> Option<Vec<f64>> {
        let trial = [(model.clone(), setting)];
        let mut errors = Vec::with_capacity(self.time.len());
        self.follow(&trial, |_, step| errors.push(step.error[0])).ok()?;
        if !errors.iter().all(|error| error.is_finite()) {
            return None;
        }
        let mut shuffled = shuffled(&errors, self.samples_in(BLOCK), seed).into_iter();
        let mut positions = self.position.clone();
        let error = |n: usize, shown: &[f64], error: &mut [f64]| {
            error[0] = shuffled.next().unwrap_or_default();
            positions[n] = shown[0] + error[0];
        };
        self.follow_errors(&trial, error, |_, _| ()).ok()?;
        positions.iter().all(|x| x.is_finite()).then_some(positions)
    }

    /// Samples of a time, at least one.
    fn samples_in(&self, time: f64) -> usize {
        let covered: f64 =
            self.segments.iter().map(|s| self.time[s.end - 1] - self.time[s.start]).sum();
        let samples: usize = self.segments.iter().map(|s| s.len() - 1).sum();
        ((time * samples as f64 / covered) as usize).clamp(1, samples)
    }
}

/// `values` in blocks of this length, in another order and with random signs.
fn shuffled(values: &[f64], length: usize, seed: u64) -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut blocks: Vec<&[f64]> = values.chunks(length).collect();
    blocks.shuffle(&mut random);
    let mut signed = |block: &[f64]| -> Vec<f64> {
        let sign = if random.random() { 1.0 } else { -1.0 };
        block.iter().map(|value| sign * value).collect()
    };
    blocks.into_iter().flat_map(&mut signed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_change_places_and_signs_and_nothing_is_lost() {
        let values: Vec<f64> = (1..=103).map(f64::from).collect();
        let mixed = shuffled(&values, 10, 7);
        assert_ne!(mixed, values);
        assert_eq!(shuffled(&values, 10, 7), mixed);
        assert_ne!(shuffled(&values, 10, 8), mixed);
        let mut sizes: Vec<f64> = mixed.iter().map(|value| value.abs()).collect();
        // Within a block the order stays.
        let kept = sizes.windows(2).filter(|pair| (pair[1] - pair[0] - 1.0).abs() < 1e-12).count();
        assert!(kept >= 10 * 9 + 2, "{kept}");
        sizes.sort_by(f64::total_cmp);
        assert_eq!(sizes, values);
        assert!(mixed.iter().any(|value| *value < 0.0) && mixed.iter().any(|value| *value > 0.0));
    }
}
