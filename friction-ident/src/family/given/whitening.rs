//! The colour of what a model leaves, and what noise alone leaves.

use std::ops::Range;

use missing_physics::ModelFamily;
use missing_physics::ahead::statistics;
use missing_physics::statistics::basis::dot;

use super::super::FrictionFamily;

/// Orders of the autoregressive filter that a model may be judged at, the plainest first.
pub(super) const ORDERS: [usize; 6] = [0, 1, 2, 3, 4, 6];
/// Residuals beyond this many standard deviations count as that much where colour is learned.
const CUT: f64 = 5.0;
/// Forces below this share of the recorded one are not looked for: no two programs agree better.
const FLOOR: f64 = 1e-3;

/// See the module.
#[derive(Clone, Debug, Default)]
pub(super) struct Whitening {
    /// Points of the grid that follow each other without a gap.
    runs: Vec<Range<usize>>,
    /// Noise of [`FLOOR`] that is added to every residual.
    dither: Vec<f64>,
    /// Standard deviation of what noise leaves on the grid.
    pub budget: f64,
}

impl Whitening {
    /// For residuals on the grid of `family`; `residual` is that of the given force alone.
    pub fn of(family: &FrictionFamily, residual: &[f64]) -> Self {
        let p = &family.prepared;
        let target = family.target();
        let size = (dot(target, target) / target.len().max(1) as f64).sqrt();
        let floor = FLOOR * size;
        let dither = dither(target.len()).into_iter().map(|z| floor * z).collect();
        let mut runs: Vec<Range<usize>> = Vec::new();
        for k in 0..p.grid.len() {
            match runs.last_mut() {
                Some(run) if p.grid[k] - p.grid[k - 1] == p.stride => run.end = k + 1,
                _ => runs.push(k..k + 1),
            }
        }
        let budget = quick(residual, &runs, &p.colour()).hypot(floor);
        Self { runs, dither, budget }
    }

    /// One-step prediction errors of a residual at an order: of each point from those before it in its run.
    pub fn errors(&self, residual: &[f64], order: usize) -> Vec<f64> {
        let noisy: Vec<f64> = residual.iter().zip(&self.dither).map(|(r, d)| r + d).collect();
        let predictors = self.predictors(&noisy, order);
        self.filtered(&noisy, &predictors)
    }

    /// A change of a residual, filtered as the errors of `residual` are.
    pub fn change(&self, residual: &[f64], order: usize) -> impl Fn(&[f64]) -> Vec<f64> + '_ {
        let noisy: Vec<f64> = residual.iter().zip(&self.dither).map(|(r, d)| r + d).collect();
        let predictors = self.predictors(&noisy, order);
        move |change| self.filtered(change, &predictors)
    }

    fn filtered(&self, values: &[f64], predictors: &[Predictor]) -> Vec<f64> {
        let mut errors = vec![0.0; values.len()];
        for run in &self.runs {
            for k in run.clone() {
                let known = (k - run.start).min(predictors.len() - 1);
                let predictor = &predictors[known];
                let seen = predictor.coefficients.iter().enumerate();
                let expected: f64 = seen.map(|(i, a)| a * values[k - 1 - i]).sum();
                errors[k] = (values[k] - expected) * predictor.relative;
            }
        }
        errors
    }

    /// The best predictors of orders 0 to `order`, by the recursion of Levinson and Durbin.
    fn predictors(&self, residual: &[f64], order: usize) -> Vec<Predictor> {
        let cut = CUT * statistics::spread(residual);
        let tame: Vec<f64> = residual.iter().map(|r| r.clamp(-cut, cut)).collect();
        let moment = |lag: usize| -> f64 {
            self.runs
                .iter()
                .filter(|run| run.len() > lag)
                .map(|run| dot(&tame[run.start + lag..run.end], &tame[run.start..run.end - lag]))
                .sum()
        };
        let moments: Vec<f64> = (0..=order).map(moment).collect();
        let mut power = moments[0].max(f64::MIN_POSITIVE);
        let mut all = vec![(Vec::new(), power)];
        for p in 1..=order {
            let before: &Vec<f64> = &all[p - 1].0;
            let left: f64 = before.iter().enumerate().map(|(i, a)| a * moments[p - 1 - i]).sum();
            let reflection = ((moments[p] - left) / power).clamp(-0.999, 0.999);
            let mut next: Vec<f64> =
                (0..p - 1).map(|i| before[i] - reflection * before[p - 2 - i]).collect();
            next.push(reflection);
            power *= 1.0 - reflection * reflection;
            all.push((next, power));
        }
        all.into_iter()
            .map(|(coefficients, own)| Predictor { coefficients, relative: (power / own).sqrt() })
            .collect()
    }
}

/// What predicts a residual from those before it, the nearest first.
struct Predictor {
    coefficients: Vec<f64>,
    /// Factor that brings its errors to the size of those of the full order.
    relative: f64,
}

/// Noise by its differences of fourth order, in which what acts slowly hardly shows. `colour` are the autocorrelations
/// that the low-pass of the comparison gives to white noise.
fn quick(values: &[f64], runs: &[Range<usize>], colour: &[f64]) -> f64 {
    const BINOMIAL: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
    let differences: Vec<f64> = runs
        .iter()
        .flat_map(|run| values[run.clone()].windows(5))
        .map(|v| dot(v, &BINOMIAL))
        .collect();
    let alike =
        |lag: usize| if lag == 0 { 1.0 } else { colour.get(lag - 1).copied().unwrap_or(0.0) };
    let pairs = (0..5).flat_map(|i| (0..5).map(move |j: usize| (i, j)));
    let square: f64 = pairs.map(|(i, j)| BINOMIAL[i] * BINOMIAL[j] * alike(i.abs_diff(j))).sum();
    statistics::spread(&differences) / square.max(1.0).sqrt()
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
