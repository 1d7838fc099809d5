//! The normal distribution that CMA-ES samples and adapts.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use serde::{Deserialize, Serialize};

use crate::random::{self, Stream};

/// Condition number of C beyond which a distribution counts as degenerate.
const MOST_CONDITION: f64 = 1e14;
/// Step, in widths of the domain, below which the distribution has converged.
const LEAST_STEP: f64 = 1e-13;

#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Distribution {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    /// Eigenvectors of the covariance.
    axes: DMatrix<f64>,
    /// Square roots of its eigenvalues.
    lengths: DVector<f64>,
    /// Path of the covariance, `p_c`.
    path: DVector<f64>,
    /// Path of the step size, `p_sigma`.
    step_path: DVector<f64>,
    generation: u64,
    /// Generation of the last eigendecomposition.
    decomposed: u64,
    /// Best costs of the last generations, for the test of convergence.
    history: Vec<f64>,
    lambda: usize,
}

/// The constants of the tutorial's table 1.
struct Constants {
    weights: Vec<f64>,
    mu_eff: f64,
    c_sigma: f64,
    d_sigma: f64,
    c_c: f64,
    c_1: f64,
    c_mu: f64,
    /// Expected length of a standard normal vector.
    chi: f64,
}

impl Constants {
    fn new(n: f64, lambda: usize) -> Self {
        let half = f64::midpoint(lambda as f64, 1.0);
        let raw: Vec<f64> = (1..=lambda / 2).map(|i| half.ln() - (i as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|w| w / sum).collect();
        let mu_eff = 1.0 / weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (mu_eff + 2.0) / (n + mu_eff + 5.0);
        let d_sigma = 1.0 + 2.0 * (((mu_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_c = (4.0 + mu_eff / n) / (n + 4.0 + 2.0 * mu_eff / n);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu_eff);
        let c_mu = 2.0 * (mu_eff - 2.0 + 1.0 / mu_eff) / ((n + 2.0).powi(2) + mu_eff);
        let c_mu = c_mu.min(1.0 - c_1);
        let chi = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        Self { weights, mu_eff, c_sigma, d_sigma, c_c, c_1, c_mu, chi }
    }
}

impl Distribution {
    /// Whether it is one of so many components and candidates.
    pub(super) fn fits(&self, n: usize, lambda: usize) -> bool {
        let vectors = [&self.mean, &self.lengths, &self.path, &self.step_path];
        let matrices = [&self.covariance, &self.axes];
        self.lambda == lambda
            && vectors.iter().all(|vector| vector.len() == n)
            && matrices.iter().all(|matrix| matrix.shape() == (n, n))
    }

    pub(super) fn new(mean: Vec<f64>, sigma: f64, lambda: usize) -> Self {
        let n = mean.len();
        Self {
            mean: DVector::from_vec(mean),
            sigma,
            covariance: DMatrix::identity(n, n),
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
            path: DVector::zeros(n),
            step_path: DVector::zeros(n),
            generation: 0,
            decomposed: 0,
            history: Vec::new(),
            lambda,
        }
    }

    pub(super) fn sample(&self, rng: &mut Stream) -> Vec<f64> {
        let n = self.mean.len();
        let scaled = DVector::from_fn(n, |i, _| self.lengths[i] * random::normal::<f64>(rng));
        let z = &self.mean + self.sigma * (&self.axes * scaled);
        z.data.into()
    }

    pub(super) fn update(&mut self, candidates: &[Vec<f64>], costs: &[f64]) {
        let mut order: Vec<usize> = (0..costs.len()).collect();
        order.sort_by(|&a, &b| costs[a].total_cmp(&costs[b]));
        self.generation += 1;
        let Some(&best) = order.first().filter(|&&best| costs[best].is_finite()) else { return };
        self.history.push(costs[best]);
        let constants = Constants::new(self.mean.len() as f64, self.lambda);
        let steps: Vec<DVector<f64>> = order[..constants.weights.len()]
            .iter()
            .map(|&i| (DVector::from_column_slice(&candidates[i]) - &self.mean) / self.sigma)
            .collect();
        let mut step = DVector::zeros(self.mean.len());
        for (weight, y) in constants.weights.iter().zip(&steps) {
            step.axpy(*weight, y, 1.0);
        }
        self.mean.axpy(self.sigma, &step, 1.0);
        let steady = self.follow_paths(&constants, &step);
        self.adapt(&constants, &steps, steady);
        self.decompose(&constants);
    }

    /// Both evolution paths and the step size; returns `h_sigma`.
    fn follow_paths(&mut self, k: &Constants, step: &DVector<f64>) -> bool {
        let n = self.mean.len() as f64;
        let mut whitened = self.axes.tr_mul(step);
        whitened.component_div_assign(&self.lengths);
        let whitened = &self.axes * whitened;
        let gain = (k.c_sigma * (2.0 - k.c_sigma) * k.mu_eff).sqrt();
        self.step_path.axpy(gain, &whitened, 1.0 - k.c_sigma);
        let length = self.step_path.norm();
        let faded = 1.0 - (1.0 - k.c_sigma).powf(2.0 * self.generation as f64);
        let steady = length / faded.sqrt() < (1.4 + 2.0 / (n + 1.0)) * k.chi;
        let gain = if steady { (k.c_c * (2.0 - k.c_c) * k.mu_eff).sqrt() } else { 0.0 };
        self.path.axpy(gain, step, 1.0 - k.c_c);
        let growth = k.c_sigma / k.d_sigma * (length / k.chi - 1.0);
        self.sigma *= growth.min(1.0).exp();
        steady
    }

    /// Rank-one and rank-mu update of the covariance.
    fn adapt(&mut self, k: &Constants, steps: &[DVector<f64>], steady: bool) {
        let lost = if steady { 0.0 } else { k.c_c * (2.0 - k.c_c) };
        self.covariance *= 1.0 - k.c_1 - k.c_mu + k.c_1 * lost;
        self.covariance.ger(k.c_1, &self.path, &self.path, 1.0);
        for (weight, y) in k.weights.iter().zip(steps) {
            self.covariance.ger(k.c_mu * weight, y, y, 1.0);
        }
    }

    /// Eigenvectors and eigenvalues, as rarely as the learning rates allow.
    fn decompose(&mut self, k: &Constants) {
        let n = self.mean.len() as f64;
        let pause = (1.0 / ((k.c_1 + k.c_mu) * n * 10.0)).floor() as u64;
        if self.generation - self.decomposed <= pause {
            return;
        }
        self.decomposed = self.generation;
        self.covariance = (&self.covariance + self.covariance.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(self.covariance.clone());
        self.axes = eigen.eigenvectors;
        self.lengths = eigen.eigenvalues.map(|value| value.max(1e-300).sqrt());
    }

    /// Why sampling on is pointless, by the usual criteria of cost, step and condition.
    pub(super) fn converged(&self) -> Option<&'static str> {
        let n = self.mean.len();
        let window = 10 + 30 * n / self.lambda;
        let (least, most) = (self.lengths.min(), self.lengths.max());
        if !(self.sigma.is_finite() && most.is_finite()) {
            return Some("the distribution is no longer finite");
        }
        if (most / least).powi(2) > MOST_CONDITION {
            return Some("the covariance is degenerate");
        }
        if self.sigma * most < LEAST_STEP {
            return Some("steps have become too small to matter");
        }
        let recent = self.history.len().checked_sub(window).map(|from| &self.history[from..])?;
        let (low, high) = recent
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| (low.min(*c), high.max(*c)));
        let flat = high - low <= 1e-12 * low.abs().min(1.0);
        flat.then_some("costs no longer differ")
    }
}
