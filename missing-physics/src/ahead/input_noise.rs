//! Whether what a model leaves is noise of the input that nobody recorded: as large as such a noise makes it, and white.
//!
//! A command is what an amplifier was asked for. What it adds acts on the plant and is in no column, so that a true model
//! errs more than the sensors make it. A filter for such a noise says how large its errors are then
//! ([`Ahead::expected`]), and that they are white (T. Kailath, IEEE Trans. Automatic Control 13, 1968): a noise is told by
//! both. What jitters with the samples is as white, but larger than the filter that suits it says; what any physics leaves
//! lasts longer than a sample.

use super::Ahead;
use super::fit;
use super::law::runs;
use super::node::Node;
use super::statistics::{HUBER, spread};

/// Lengths of the windows over which errors are summed, samples: sums of white errors grow with the root of the length.
const WINDOWS: [usize; 4] = [4, 16, 64, 256];
/// Fewest windows of a length that say something.
const FEWEST: usize = 30;

/// Noise of the input that makes what a model leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputNoise {
    /// Its standard deviation from sample to sample.
    pub deviation: f64,
    /// The prediction error with it.
    pub error: f64,
}

impl InputNoise {
    /// The noise as large as the errors of a model say, at its own rung or one beside it; nothing where they are at none of these like
    /// those of such a noise, to within `factor`.
    pub fn of(ahead: &dyn Ahead, node: &Node, factor: f64) -> Option<Self> {
        let beside = [node.setting.checked_sub(1), Some(node.setting + 1)];
        let other = |setting: usize| {
            let there = fit::evaluated(ahead, node.model.clone(), setting);
            Self::at(ahead, &there, factor)
        };
        let inside = |setting: &usize| *setting < ahead.settings();
        Self::at(ahead, node, factor)
            .or_else(|| beside.into_iter().flatten().filter(inside).find_map(other))
    }

    /// The same at the model's own rung: noise of the next rung below makes smaller errors, of the next one above larger ones, and
    /// sums over windows are as those of white errors. Within a rung they are smaller by the square of its step at most: what
    /// errors of the sensor leave, which the filter then follows, are much smaller.
    fn at(ahead: &dyn Ahead, node: &Node, factor: f64) -> Option<Self> {
        let rung = |setting: usize| {
            let inside = setting < ahead.settings();
            inside.then(|| Some((ahead.expected(setting), ahead.input_noise(setting)?))).flatten()
        };
        let here = rung(node.setting)?;
        let below = rung(node.setting.checked_sub(1)?).filter(|below| below.1 < here.1)?;
        let above = rung(node.setting + 1).filter(|above| above.1 > here.1)?;
        let most = factor * factor;
        let least = most * (here.1 / above.1).powi(2);
        let white = || {
            let ratios = ratios(ahead, &node.errors);
            !ratios.is_empty() && ratios.iter().all(|ratio| (least..=most).contains(ratio))
        };
        if !(below.0..=above.0).contains(&node.scale) || !white() {
            return None;
        }
        let (low, high) = if node.scale < here.0 { (below, here) } else { (here, above) };
        let share = (node.scale - low.0) / (high.0 - low.0).max(f64::MIN_POSITIVE);
        Some(Self { deviation: low.1 + share * (high.1 - low.1), error: node.scale })
    }
}

/// Mean squares of sums over windows of each length, as multiples of what white errors make them.
fn ratios(ahead: &dyn Ahead, errors: &[f64]) -> Vec<f64> {
    let cut = HUBER * spread(errors);
    let tame: Vec<f64> = errors.iter().map(|e| e.clamp(-cut, cut)).collect();
    let runs = runs(ahead.instants());
    let windows = |length: usize| {
        runs.iter().flat_map(|run| tame[run.clone()].chunks_exact(length)).collect::<Vec<_>>()
    };
    let enough = |each: &Vec<&[f64]>| each.len() >= FEWEST;
    let ratio = |each: Vec<&[f64]>| {
        let sums: f64 = each.iter().map(|window| window.iter().sum::<f64>().powi(2)).sum();
        sums / each.iter().flat_map(|window| window.iter()).map(|e| e * e).sum::<f64>()
    };
    WINDOWS.iter().map(|length| windows(*length)).take_while(enough).map(ratio).collect()
}

#[cfg(test)]
pub mod testing {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::family::{Fitted, Trial};

    const SAMPLES: usize = 6000;

    /// Something that a noise moves from sample to sample, seen by a sensor of deviation 1, and its filters for noise of 0.01 to 10.
    pub struct Walk {
        measured: Vec<f64>,
        instants: Vec<(f64, usize)>,
    }

    impl Walk {
        /// One of a noise of the input and of the sensor, under something that is missing.
        pub fn new(seed: u64, (input, sensor): (f64, f64), missing: impl Fn(f64) -> f64) -> Self {
            let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
            let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
            let mut place = 0.0;
            let mut next = |k: usize| {
                place += input * normal() + missing(k as f64);
                place + sensor * normal()
            };
            let measured = (0..SAMPLES).map(&mut next).collect();
            Self { measured, instants: (0..SAMPLES).map(|k| (k as f64, k / 1500)).collect() }
        }

        fn noise(setting: usize) -> f64 {
            0.01 * 3.2_f64.powi(setting as i32)
        }

        /// Gain at a setting, and the deviation of the error that it expects.
        fn filter(setting: usize) -> (f64, f64) {
            let noise = Self::noise(setting);
            let p = noise * noise / 2.0 + noise * (noise * noise / 4.0 + 1.0).sqrt();
            (p / (p + 1.0), (p + 1.0).sqrt())
        }

        /// A model of nothing at the rung that predicts best.
        pub fn best(&self) -> Node {
            let nothing = Fitted { terms: Vec::new(), values: Vec::new() };
            let rungs =
                (0..self.settings()).map(|rung| fit::evaluated(self, nothing.clone(), rung));
            rungs.min_by(|a, b| a.scale.total_cmp(&b.scale)).unwrap()
        }
    }

    impl Ahead for Walk {
        fn settings(&self) -> usize {
            7
        }
        fn expected(&self, setting: usize) -> f64 {
            Self::filter(setting).1
        }
        fn input_noise(&self, setting: usize) -> Option<f64> {
            Some(Self::noise(setting))
        }
        fn budget(&self) -> f64 {
            1.0
        }
        fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
            let one = |(_, setting): &(Fitted, usize)| {
                let (gain, mut place) = (Self::filter(*setting).0, 0.0);
                let next = |measured: &f64| {
                    let error = measured - place;
                    place += gain * error;
                    error
                };
                self.measured.iter().map(next).collect()
            };
            models.iter().map(one).collect()
        }
        fn instants(&self) -> &[(f64, usize)] {
            &self.instants
        }
        fn trials(&self, _model: &Fitted, _term: usize) -> Vec<Trial> {
            Vec::new()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::InputNoise;
    use super::testing::Walk;

    fn told(seed: u64, noise: (f64, f64), missing: impl Fn(f64) -> f64) -> Option<InputNoise> {
        let walk = Walk::new(seed, noise, missing);
        InputNoise::of(&walk, &walk.best(), 1.3)
    }

    #[test]
    fn a_noise_of_the_input_is_told_and_how_large_it_is() {
        // On a rung, beside one, between two.
        for input in [0.33, 0.5, 0.6, 1.0] {
            let told = (0..20).map(|seed| told(seed, (input, 1.0), |_| 0.0));
            let told: Vec<f64> = told.flatten().map(|noise| noise.deviation).collect();
            assert!(told.len() >= 19, "{input}: {told:?}");
            assert!(told.iter().all(|sd| (sd / input - 1.0).abs() < 0.25), "{input}: {told:?}");
        }
    }

    #[test]
    fn neither_a_sensor_that_errs_more_nor_what_lasts_longer_than_a_sample_is_one() {
        for seed in 0..20 {
            assert_eq!(told(seed, (0.0, 2.0), |_| 0.0), None, "{seed}");
            assert_eq!(told(seed, (0.2, 3.0), |_| 0.0), None, "{seed}");
            let slow = |k: f64| 0.4 * (0.02 * k).sin();
            assert_eq!(told(seed, (0.0, 1.0), slow), None, "{seed}");
            assert_eq!(told(seed, (0.33, 1.0), slow), None, "{seed}");
        }
    }
}
