//! What each rank of a generation counts, and the learning rates that follow from it.

use super::Ingredient;
use super::Lineages;

/// The constants of Hansen's tutorial (arXiv:1604.00772, table 1), negative weights included.
#[derive(Clone, Debug)]
pub(super) struct Weights {
    /// Of the better half, best first; they sum to 1.
    pub recombination: Vec<f64>,
    /// Of the ranks in the update of the covariance.
    pub covariance: Vec<f64>,
    /// Variance effective number of the better half, `mu_eff`.
    pub effective: f64,
    pub c_sigma: f64,
    pub d_sigma: f64,
    pub c_c: f64,
    pub c_1: f64,
    pub c_mu: f64,
    /// Expected length of a standard normal vector.
    pub chi: f64,
    /// Generations from one factorisation to the next.
    pub pause: u64,
}

impl Weights {
    pub fn new(config: &Lineages, dimension: usize, lambda: usize) -> Self {
        let n = dimension as f64;
        let half = f64::midpoint(lambda as f64, 1.0);
        let raw: Vec<f64> = (1..=lambda).map(|i| half.ln() - (i as f64).ln()).collect();
        let (better, worse) = raw.split_at(lambda / 2);
        let mu = effective(better);
        let sum: f64 = better.iter().sum();
        let recombination: Vec<f64> = better.iter().map(|w| w / sum).collect();
        let c_sigma = (mu + 2.0) / (n + mu + 5.0);
        let d_sigma = 1.0 + 2.0 * (((mu - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_c = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + mu);
        let c_mu = 2.0 * (mu - 1.75 + 1.0 / mu) / ((n + 2.0).powi(2) + mu);
        let c_mu = c_mu.min(1.0 - c_1);
        let mut covariance = recombination.clone();
        if config.uses(Ingredient::NegativeWeights) {
            let most = (1.0 + c_1 / c_mu)
                .min(1.0 + 2.0 * effective(worse) / (mu + 2.0))
                .min((1.0 - c_1 - c_mu) / (n * c_mu));
            let sum: f64 = worse.iter().map(|w| w.abs()).sum();
            covariance.extend(worse.iter().map(|w| most * w / sum));
        }
        let c_1 = if config.uses(Ingredient::Direction) { c_1 } else { 0.0 };
        let chi = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let pause = (1.0 / ((c_1 + c_mu) * n * 10.0)).max(1.0) as u64;
        Self {
            recombination,
            covariance,
            effective: mu,
            c_sigma,
            d_sigma,
            c_c,
            c_1,
            c_mu,
            chi,
            pause,
        }
    }
}

/// (sum w)^2 / sum w^2.
fn effective(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    sum * sum / weights.iter().map(|w| w * w).sum::<f64>()
}
