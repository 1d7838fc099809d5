//! The normal distribution that the children of a lineage are drawn from.

use serde::{Deserialize, Serialize};

use super::triangular::{self, Lower};
use super::weights::Weights;

/// N(mean, sigma^2 C), C = A A'.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Distribution {
    mean: Vec<f64>,
    sigma: f64,
    covariance: Lower,
    /// A.
    factor: Lower,
    /// The direction of the lineage: a faded sum of the steps of its mean, `p_c`.
    direction: Vec<f64>,
    /// The same in the coordinates of A, whose length tells whether steps are too short or too long.
    step_path: Vec<f64>,
    generation: u64,
    /// Generation of the last factorisation.
    factored: u64,
    /// Whether the covariance could not be factored.
    degenerate: bool,
}

/// A child as the distribution sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranked<'a> {
    /// (position - mean) / sigma.
    pub step: &'a [f64],
    /// The squared length of A^-1 step.
    pub length: f64,
}

impl Distribution {
    pub fn new(mean: Vec<f64>, sigma: f64) -> Self {
        let n = mean.len();
        Self {
            mean,
            sigma,
            covariance: Lower::identity(n),
            factor: Lower::identity(n),
            direction: vec![0.0; n],
            step_path: vec![0.0; n],
            generation: 0,
            factored: 0,
            degenerate: false,
        }
    }

    pub fn dimension(&self) -> usize {
        self.mean.len()
    }

    /// The step of a standard normal `z`.
    pub fn step(&self, z: &[f64], step: &mut [f64]) {
        self.factor.multiply(z, step);
    }

    /// Where a step leads.
    pub fn position<'a>(&'a self, step: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.mean.iter().zip(step).map(|(mean, step)| mean + self.sigma * step)
    }

    /// The z that leads to `position`.
    pub fn whiten(&self, position: &[f64], z: &mut [f64]) {
        self.apart(position, z);
        for share in &mut *z {
            *share /= self.sigma;
        }
        self.factor.solve(z);
    }

    /// `position` less the mean.
    pub fn apart(&self, position: &[f64], apart: &mut [f64]) {
        for ((apart, x), mean) in apart.iter_mut().zip(position).zip(&self.mean) {
            *apart = x - mean;
        }
    }

    /// What takes a position less the mean to `share` of its z.
    pub fn whitening(&self, share: f64) -> Lower {
        let mut whitening = self.factor.inverse();
        whitening.scale(share / self.sigma);
        whitening
    }

    /// Adapts to the children of a generation, the best first.
    pub fn update(&mut self, weights: &Weights, ranked: &[Ranked<'_>]) {
        self.generation += 1;
        let mut shift = vec![0.0; self.mean.len()];
        for (child, weight) in ranked.iter().zip(&weights.recombination) {
            triangular::add_scaled(&mut shift, child.step, *weight);
        }
        triangular::add_scaled(&mut self.mean, &shift, self.sigma);
        let steady = self.follow(weights, shift);
        self.adapt(weights, ranked, steady);
        if self.generation - self.factored >= weights.pause {
            self.factored = self.generation;
            match self.covariance.factored() {
                Some(factor) => self.factor = factor,
                None => self.degenerate = true,
            }
        }
    }

    /// Direction and step size follow the shift of the mean; whether the latter is steady, `h_sigma`.
    fn follow(&mut self, k: &Weights, mut shift: Vec<f64>) -> bool {
        let n = self.mean.len() as f64;
        let direction = shift.clone();
        self.factor.solve(&mut shift);
        let gain = (k.c_sigma * (2.0 - k.c_sigma) * k.effective).sqrt();
        fade(&mut self.step_path, 1.0 - k.c_sigma, &shift, gain);
        let length = triangular::norm(&self.step_path);
        let faded = 1.0 - (1.0 - k.c_sigma).powf(2.0 * self.generation as f64);
        let steady = length / faded.sqrt() < (1.4 + 2.0 / (n + 1.0)) * k.chi;
        let gain = if steady { (k.c_c * (2.0 - k.c_c) * k.effective).sqrt() } else { 0.0 };
        fade(&mut self.direction, 1.0 - k.c_c, &direction, gain);
        self.sigma *= (k.c_sigma / k.d_sigma * (length / k.chi - 1.0)).min(1.0).exp();
        steady
    }

    fn adapt(&mut self, k: &Weights, ranked: &[Ranked<'_>], steady: bool) {
        let n = self.mean.len() as f64;
        let lost = if steady { 0.0 } else { k.c_c * (2.0 - k.c_c) };
        let sum: f64 = k.covariance.iter().sum();
        self.covariance.scale(1.0 + k.c_1 * lost - k.c_1 - k.c_mu * sum);
        self.covariance.add_square(&self.direction, k.c_1);
        for (child, weight) in ranked.iter().zip(&k.covariance) {
            // However long a bad step is, C stays positive definite.
            let shrunk = if *weight < 0.0 { n / child.length.max(f64::MIN_POSITIVE) } else { 1.0 };
            self.covariance.add_square(child.step, k.c_mu * weight * shrunk);
        }
    }

    /// Whether nothing more can be drawn from it.
    pub fn is_degenerate(&self) -> bool {
        self.degenerate || !self.sigma.is_finite()
    }

    /// The largest standard deviation of a component.
    pub fn reach(&self) -> f64 {
        self.sigma * self.covariance.largest_of_diagonal().sqrt()
    }
}

/// `path = keep path + gain new`.
fn fade(path: &mut [f64], keep: f64, new: &[f64], gain: f64) {
    for (path, new) in path.iter_mut().zip(new) {
        *path = keep * *path + gain * new;
    }
}
