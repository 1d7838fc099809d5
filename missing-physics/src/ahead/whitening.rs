//! Residuals as prediction errors: each from those before it.
//!
//! A model that says at once what a whole recording should be leaves a residual that resembles its neighbours. One sample
//! ahead it errs by what an [`Autoregression`] of that residual leaves; its order takes the place of the process noise.
//! The filter is monic, so that errors of all orders are errors of the same quantity (L. Ljung, System Identification,
//! 1999, ch. 3.2): each model is judged at the order that suits it best.

use std::ops::Range;

use rayon::prelude::*;

use super::autoregression::Autoregression;
use super::{quick, statistics};
use crate::statistics::basis::dot;

/// Orders that a model may be judged at, the plainest first.
pub const ORDERS: [usize; 6] = [0, 1, 2, 3, 4, 6];
/// Residuals beyond this many standard deviations count as that much where colour is learned.
const CUT: f64 = 5.0;
/// Largest reflection.
const MOST: f64 = 0.999;

/// See the module.
#[derive(Clone, Debug, Default)]
pub struct Whitening {
    /// Points that follow each other without a gap.
    runs: Vec<Range<usize>>,
    /// Noise that is added to every residual.
    dither: Vec<f64>,
    /// Standard deviation of what noise leaves.
    pub budget: f64,
}

impl Whitening {
    /// For residuals of `target`; `residual` is one that shows the noise, `colour` the autocorrelation of that from lag 1.
    /// Below `floor`, as a share of the target's root mean square, nothing is looked for.
    pub fn of(
        target: &[f64],
        residual: &[f64],
        runs: Vec<Range<usize>>,
        colour: &[f64],
        floor: f64,
    ) -> Self {
        let size = (dot(target, target) / target.len().max(1) as f64).sqrt();
        let floor = floor * size;
        let dither = dither(target.len()).into_iter().map(|z| floor * z).collect();
        let budget = quick::noise(residual, &runs, colour).hypot(floor);
        Self { runs, dither, budget }
    }

    /// The order of a setting.
    pub fn order(setting: usize) -> usize {
        ORDERS[setting.min(ORDERS.len() - 1)]
    }

    /// One-step prediction errors of a residual at a setting: of each point from those before it in its run.
    pub fn errors(&self, residual: &[f64], setting: usize) -> Vec<f64> {
        let noisy = self.noisy(residual);
        self.filtered(&noisy, &self.law(&noisy, setting))
    }

    /// A change of a residual, filtered as the errors of `residual` are.
    pub fn change(
        &self,
        residual: &[f64],
        setting: usize,
    ) -> impl Fn(&[f64]) -> Vec<f64> + Sync + '_ {
        let law = self.law(&self.noisy(residual), setting);
        move |change| self.filtered(change, &law)
    }

    /// The errors of other residuals as the filter of `residual` sees them.
    pub fn errors_beside(
        &self,
        residual: &[f64],
        setting: usize,
        others: &[Vec<f64>],
    ) -> Vec<Vec<f64>> {
        if !residual.iter().all(|r| r.is_finite()) {
            return vec![vec![f64::MAX; residual.len()]; others.len()];
        }
        let errors = self.errors(residual, setting);
        let filtered = self.change(residual, setting);
        let each = others.par_iter().map(|other| {
            let change: Vec<f64> = other.iter().zip(residual).map(|(new, old)| new - old).collect();
            if !change.iter().all(|change| change.is_finite()) {
                return vec![f64::MAX; residual.len()];
            }
            filtered(&change).iter().zip(&errors).map(|(change, error)| error + change).collect()
        });
        each.collect()
    }

    fn noisy(&self, residual: &[f64]) -> Vec<f64> {
        residual.iter().zip(&self.dither).map(|(r, d)| r + d).collect()
    }

    fn law(&self, noisy: &[f64], setting: usize) -> Autoregression {
        let cut = CUT * statistics::spread(noisy);
        let tame: Vec<f64> = noisy.iter().map(|r| r.clamp(-cut, cut)).collect();
        Autoregression::of(&tame, &self.runs, Self::order(setting), MOST)
    }

    /// What a law leaves; where a run begins, errors are brought to the size of those of the full order.
    fn filtered(&self, values: &[f64], law: &Autoregression) -> Vec<f64> {
        let mut errors = law.left(values, &self.runs);
        let full = law.with_before(law.order()).left;
        for run in &self.runs {
            for (known, error) in errors[run.clone()].iter_mut().take(law.order()).enumerate() {
                *error *= (full / law.with_before(known).left).sqrt();
            }
        }
        errors
    }
}

/// Standard normal numbers, the same ones always (sums of twelve uniform ones of a congruential generator).
fn dither(count: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A residual that is what a law with one past value makes of even noise.
    fn residual() -> Vec<f64> {
        let mut last = 0.0;
        let next = |noise: f64| {
            last = 0.8 * last + noise;
            last
        };
        dither(5000).into_iter().map(next).collect()
    }

    #[test]
    fn an_order_that_suits_leaves_the_noise_and_none_leaves_the_residual() {
        let residual = residual();
        let runs: Vec<Range<usize>> = vec![0..2000, 2000..5000];
        let whitening = Whitening::of(&residual, &residual, runs, &[], 1e-9);
        let size = |setting| statistics::rms(&whitening.errors(&residual, setting), f64::INFINITY);
        assert!((size(0) * 0.6 - 1.0).abs() < 0.05 && (size(1) - 1.0).abs() < 0.03);
        assert!((size(5) - 1.0).abs() < 0.03 && (size(99) - size(5)).abs() < 1e-12);
        // The first of a run is as large as the others, on the whole.
        let errors = whitening.errors(&residual, 1);
        assert!((errors[2000] / residual[2000] - 0.6).abs() < 0.02);
    }

    #[test]
    fn a_change_passes_the_filter_of_the_residual() {
        let residual = residual();
        let whitening = Whitening::of(&residual, &residual, vec![0..3000, 3000..5000], &[], 1e-9);
        let step: Vec<f64> = (0..5000).map(|k| f64::from(u8::from(k >= 100))).collect();
        let change = whitening.change(&residual, 1)(&step);
        assert!(change[99] == 0.0 && (change[100] - 1.0).abs() < 1e-12);
        assert!((change[101] - 0.2).abs() < 0.03, "{}", change[101]);
    }
}
