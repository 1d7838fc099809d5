//! What candidates gain by chance: the prediction errors, shifted in time against the motion.
//!
//! A shift keeps the size, the spikes and the autocorrelation of the errors and breaks their alignment with what a
//! candidate does. Moments at all shifts come from one Fourier transform of each column.

use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use crate::statistics::basis::{dot, solve};

/// Shifts that are looked at, evenly spread: the resolution of a p-value is 1 over this.
pub const SHIFTS: usize = 999;
/// Shortest shift as a share of the recording.
const SHORTEST: f64 = 0.02;
/// A shift at which a column resembles itself more than this is no placebo for it.
const SIMILAR: f64 = 0.3;
/// Chances, of the shifts, between which the gains are taken to fall off as they do beyond: neighbouring shifts resemble
/// each other, so that a short recording has few that are independent, and what is rarer is not counted but foretold.
const FALL: (f64, f64) = (0.5, 0.1);

/// What a trial changes in the errors, freed of the model's own parameters.
pub struct Changed {
    /// One column for each amplitude.
    pub columns: Vec<Vec<f64>>,
    /// Scalar products of the columns.
    pub matrix: Vec<Vec<f64>>,
    /// Whether the amplitude (of a single column) cannot be negative.
    pub positive: bool,
}

/// The null of a screening.
#[derive(Clone, Debug, Default)]
pub struct Chance {
    /// At each shift of the errors the largest gain of any trial, nats, and how many trials there are for each one that
    /// was asked there.
    largest: Vec<(f64, f64)>,
    /// Trials that were ranked for each one that was looked at.
    ranked: f64,
}

impl Chance {
    /// From the trials that were looked at, of `tried` that were ranked.
    pub fn of(left: &[f64], trials: &[Changed], tried: usize) -> Self {
        let ranked = tried as f64 / trials.len().max(1) as f64;
        Self::new(largest(left, trials), ranked.max(1.0))
    }

    fn new(mut largest: Vec<(f64, f64)>, ranked: f64) -> Self {
        largest.sort_by(|a, b| b.0.total_cmp(&a.0));
        Self { largest, ranked }
    }

    /// Gain that so many of the shifts reach.
    fn reached_by(&self, share: f64) -> f64 {
        let place = (share * self.largest.len() as f64) as usize;
        self.largest.get(place).map_or(f64::NAN, |(gain, _)| *gain)
    }

    /// Chance of a gain at least as large, by the shifts: never below one over their number. The trials that were only
    /// ranked, or not asked at a shift, count as so many independent ones (Bonferroni).
    pub fn p_value(&self, gain: f64) -> f64 {
        let as_large = self.largest.iter().filter(|(other, _)| *other >= gain);
        let as_large: f64 = as_large.map(|(_, trials)| trials).sum();
        let share = (as_large + 1.0) / (self.largest.len() + 1) as f64;
        (share * self.ranked.max(1.0)).min(1.0)
    }

    /// The same for a short recording: by how gains fall off among the shifts, where fewer reach them than can be counted.
    pub fn p_value_of_few(&self, gain: f64) -> f64 {
        let [often, seldom] = [FALL.0, FALL.1].map(|share| self.reached_by(share));
        let rate = (FALL.0 / FALL.1).ln() / (seldom - often);
        let foretold = FALL.1 * (-rate * (gain - seldom)).exp();
        // No number where there are no shifts.
        let foretold = if gain > seldom { (self.ranked.max(1.0) * foretold).min(1.0) } else { 0.0 };
        self.p_value(gain).max(foretold)
    }
}

/// The largest gain of any trial at each shift of the errors, nats, and the trials for each one that was asked there.
fn largest(left: &[f64], trials: &[Changed]) -> Vec<(f64, f64)> {
    let points = left.len();
    let shortest = ((points as f64 * SHORTEST) as usize).max(1);
    let span = points.saturating_sub(2 * shortest);
    let shifts: Vec<usize> =
        (0..SHIFTS.min(span)).map(|k| shortest + k * span / SHIFTS.min(span)).collect();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(points), planner.plan_fft_inverse(points));
    let transform = |values: &[f64]| -> Vec<Complex<f64>> {
        let (mut input, mut output) = (values.to_vec(), forward.make_output_vec());
        // Lengths are the planner's own.
        let _ = forward.process(&mut input, &mut output);
        output
    };
    let correlated = |a: &[Complex<f64>], b: &[Complex<f64>]| -> Vec<f64> {
        let mut product: Vec<Complex<f64>> = a.iter().zip(b).map(|(a, b)| a.conj() * b).collect();
        // Both ends of the spectrum of real signals are real.
        for end in [0, product.len() - 1] {
            product[end].im = 0.0;
        }
        let mut out = inverse.make_output_vec();
        let _ = inverse.process(&mut product, &mut out);
        for value in &mut out {
            *value /= points as f64;
        }
        out
    };
    let of_left = transform(left);
    let each = |trial: &Changed| -> Vec<f64> {
        let spectra: Vec<_> = trial.columns.iter().map(|column| transform(column)).collect();
        let moments: Vec<Vec<f64>> = spectra.iter().map(|s| correlated(s, &of_left)).collect();
        let own: Vec<Vec<f64>> = spectra.iter().map(|s| correlated(s, s)).collect();
        let all: Vec<usize> = (0..moments.len()).collect();
        let gain = |shift: &usize| {
            let similar = own.iter().any(|own| own[*shift].abs() > SIMILAR * own[0]);
            if similar {
                return f64::NEG_INFINITY;
            }
            let moment: Vec<f64> = moments.iter().map(|m| -m[*shift]).collect();
            if trial.positive && moment[0] < 0.0 {
                return 0.0;
            }
            0.5 * dot(&solve(&trial.matrix, &moment, &all), &moment) - moment.len() as f64
        };
        shifts.iter().map(gain).collect()
    };
    let gains: Vec<Vec<f64>> = trials.par_iter().map(each).collect();
    let most = |k: usize| {
        let asked = gains.iter().map(|row| row[k]).filter(|gain| gain.is_finite());
        let (count, most) =
            asked.fold((0, f64::NEG_INFINITY), |(n, most), gain| (n + 1, gain.max(most)));
        (count > 0).then(|| (most, gains.len() as f64 / f64::from(count)))
    };
    (0..shifts.len()).filter_map(most).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    #[test]
    fn a_column_that_is_in_the_errors_is_told_from_one_that_is_not() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut noise =
            || -> Vec<f64> { (0..2000).map(|_| random.random_range(-1.0..1.0)).collect() };
        let (there, other, mut left) = (noise(), noise(), noise());
        let columns = |c: &Vec<f64>| Changed {
            columns: vec![c.clone()],
            matrix: vec![vec![dot(c, c)]],
            positive: false,
        };
        crate::statistics::basis::add_scaled(&mut left, -0.3, &there);
        let trials = [columns(&there), columns(&other)];
        let chance = Chance::of(&left, &trials, 2);
        let gain = |c: &[f64]| 0.5 * dot(c, &left).powi(2) / dot(c, c) - 1.0;
        assert!(chance.p_value(gain(&there)) <= 2e-3);
        assert!(chance.p_value(gain(&other)) > 0.01);
    }

    #[test]
    fn a_p_value_is_never_below_the_resolution_of_the_shifts() {
        let chance = Chance::new((0..999).map(|k| (f64::from(k), 1.0)).collect(), 1.0);
        assert_eq!(chance.p_value(f64::INFINITY), 1e-3);
        assert_eq!(chance.p_value(1e5), 1e-3);
        assert_eq!(chance.p_value(0.0), 1.0);
        // Every twentieth shift reaches it, and by how gains fall off more do.
        assert_eq!(chance.p_value(949.0), 0.051);
        let foretold = 0.1 * (-0.125f64 * 5f64.ln()).exp();
        assert!((chance.p_value_of_few(949.0) - foretold).abs() < 1e-9);
        assert_eq!((chance.p_value_of_few(800.0), chance.p_value_of_few(1e5)), (0.2, 1e-3));
        // Where nothing could be shifted nothing is known.
        assert_eq!(Chance::default().p_value(1e9), 1.0);
    }

    #[test]
    fn trials_that_were_only_ranked_count() {
        let chance = Chance::new((0..999).map(|k| (f64::from(k), 1.0)).collect(), 5.0);
        assert!((chance.p_value(f64::INFINITY) - 5e-3).abs() < 1e-12);
        assert_eq!(chance.p_value(500.0), 1.0);
    }

    #[test]
    fn trials_that_are_not_asked_at_a_shift_count() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(6);
        let noise: Vec<f64> = (0..2000).map(|_| random.random_range(-1.0..1.0)).collect();
        let slow: Vec<f64> = (0..2000).map(|k| (f64::from(k) * 0.01).sin()).collect();
        let of = |c: &Vec<f64>| Changed {
            matrix: vec![vec![dot(c, c)]],
            columns: vec![c.clone()],
            positive: false,
        };
        let both = largest(&noise, &[of(&slow), of(&noise)]);
        assert!(both.iter().any(|(_, trials)| *trials == 2.0));
        assert!(both.iter().any(|(_, trials)| *trials == 1.0));
        let chance = Chance::new(vec![(1.0, 4.0); 99], 1.0);
        assert_eq!((chance.p_value(1.0), chance.p_value(2.0)), (1.0, 0.01));
    }

    #[test]
    fn shifts_that_map_a_column_onto_itself_are_left_out() {
        let periodic: Vec<f64> = (0..2000).map(|k| (f64::from(k) * 0.01).sin()).collect();
        let trial = Changed {
            matrix: vec![vec![dot(&periodic, &periodic)]],
            columns: vec![periodic.clone()],
            positive: false,
        };
        let left = vec![0.1; 2000];
        let finite = largest(&left, &[trial]);
        assert!(finite.len() < SHIFTS / 2, "{}", finite.len());
    }
}
