//! One descent on residuals: Levenberg-Marquardt with few evaluations.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Half the way of a first difference, as a share of the domain's width: wide ones see over roughness and noise, ...
/// ... and the narrowest, exact ones.
fn k(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default)
}
macro_rules! tuned {
    ($name:ident, $env:literal, $default:expr) => {
        #[allow(non_snake_case)]
        fn $name() -> f64 {
            static V: std::sync::OnceLock<f64> = std::sync::OnceLock::new();
            *V.get_or_init(|| k($env, $default))
        }
    };
}
tuned!(FIRST_WIDTH, "K_WIDTH", 1e-2);
tuned!(LEAST_WIDTH, "K_LEAST", 1e-6);
tuned!(NARROWER, "K_NARROWER", 0.1);
tuned!(FIRST_DAMPING, "K_DAMPING", 1e-3);
tuned!(LONGEST, "K_LONGEST", 0.5);
tuned!(WORTHWHILE, "K_WORTH", 1e-3);
tuned!(POOR, "K_POOR", 0.25);
tuned!(FAILURES, "K_FAILURES", 4.0);
tuned!(HOPELESS, "K_HOPELESS", 0.1);
tuned!(NEAR, "K_NEAR", 1e-2);
tuned!(TAKE, "K_TAKE", 1.0);

/// Where an earlier descent has ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct End {
    pub at: Vec<f64>,
    pub cost: f64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum Asked {
    /// Places, of which the best one is the start.
    Places(Vec<f64>),
    Differences(Vec<f64>),
    Step { to: Vec<f64>, promised: f64 },
}

/// Where a descent stands.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Descent {
    at: Vec<f64>,
    cost: f64,
    residuals: DVector<f64>,
    slopes: DMatrix<f64>,
    /// Whether the slopes are those of differences here.
    fresh: bool,
    damping: f64,
    /// By what the damping grows at the next failure.
    growth: f64,
    width: f64,
    failures: u32,
    asked: Asked,
    ended: bool,
}

impl Descent {
    /// From the best of `places`, rows of `n` shares.
    pub fn new(n: usize, places: Vec<f64>) -> Self {
        Self {
            at: vec![0.5; n],
            cost: f64::INFINITY,
            residuals: DVector::zeros(0),
            slopes: DMatrix::zeros(0, 0),
            fresh: false,
            damping: FIRST_DAMPING(),
            growth: 2.0,
            width: FIRST_WIDTH(),
            failures: 0,
            asked: Asked::Places(places),
            ended: false,
        }
    }

    pub fn asked(&self) -> &[f64] {
        match &self.asked {
            Asked::Places(points) | Asked::Differences(points) | Asked::Step { to: points, .. } => points,
        }
    }

    pub fn ended(&self) -> bool {
        self.ended
    }

    /// Where it stands; nowhere if no place had a cost.
    pub fn end(&self) -> Option<End> {
        self.cost.is_finite().then(|| End { at: self.at.clone(), cost: self.cost })
    }

    pub fn tell(&mut self, costs: &[f64], residuals: &[Vec<f64>], lowest: f64, ends: &[End]) {
        let n = self.at.len();
        match std::mem::replace(&mut self.asked, Asked::Places(Vec::new())) {
            Asked::Places(places) => {
                if !self.take_best(&places, costs, residuals) {
                    self.ended = true;
                    return;
                }
                self.differ();
            }
            Asked::Differences(points) => {
                let m = self.residuals.len();
                self.slopes = DMatrix::zeros(m, n);
                for (j, found) in residuals.iter().enumerate() {
                    let moved = points[j * n + j] - self.at[j];
                    if found.len() == m && costs[j].is_finite() {
                        let column = (DVector::from_column_slice(found) - &self.residuals) / moved;
                        self.slopes.set_column(j, &column);
                    }
                }
                self.fresh = true;
                self.failures = 0;
                if TAKE() > 0.0 {
                    self.take_best(&points, costs, residuals);
                }
                if self.cost > lowest {
                    let promised = self.step(1e-9).map_or(0.0, |(_, promised)| promised);
                    if promised < HOPELESS() * (self.cost - lowest) {
                        self.ended = true;
                        return;
                    }
                }
                self.go();
            }
            Asked::Step { to, promised } => {
                let gain = self.cost - costs[0];
                if gain > 0.0 && residuals[0].len() == self.residuals.len() {
                    self.accept(to, costs[0], &residuals[0], promised);
                    if ends.iter().any(|end| self.is_at(end)) {
                        self.ended = true;
                        return;
                    }
                    if gain < WORTHWHILE() * self.cost {
                        self.narrow();
                    } else if gain < POOR() * promised {
                        self.differ();
                    } else {
                        self.go();
                    }
                } else if self.fresh {
                    self.damping *= self.growth;
                    self.growth *= 2.0;
                    self.failures += 1;
                    if self.failures as f64 >= FAILURES() { self.narrow() } else { self.go() }
                } else {
                    self.differ();
                }
            }
        }
    }

    fn is_at(&self, end: &End) -> bool {
        let apart = self.at.iter().zip(&end.at).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart < NEAR() && self.cost >= end.cost * (1.0 - 1e-3)
    }

    fn take_best(&mut self, points: &[f64], costs: &[f64], residuals: &[Vec<f64>]) -> bool {
        let n = self.at.len();
        let usable = (0..costs.len()).filter(|i| !residuals[*i].is_empty() && costs[*i] < self.cost);
        let Some(best) = usable.min_by(|a, b| costs[*a].total_cmp(&costs[*b])) else { return false };
        self.at = points[best * n..(best + 1) * n].to_vec();
        self.cost = costs[best];
        self.residuals = DVector::from_column_slice(&residuals[best]);
        true
    }

    fn accept(&mut self, to: Vec<f64>, cost: f64, residuals: &[f64], promised: f64) {
        let residuals = DVector::from_column_slice(residuals);
        let step = DVector::from_iterator(to.len(), to.iter().zip(&self.at).map(|(to, at)| to - at));
        let unforeseen = &residuals - &self.residuals - &self.slopes * &step;
        self.slopes += unforeseen * step.transpose() / step.norm_squared();
        let ratio = (self.cost - cost) / promised;
        self.damping = (self.damping * (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0)).max(1e-9);
        self.growth = 2.0;
        (self.at, self.cost, self.residuals) = (to, cost, residuals);
        self.fresh = false;
        self.failures = 0;
    }

    /// Asks for differences here.
    fn differ(&mut self) {
        let mut points = self.at.repeat(self.at.len());
        for (j, point) in points.chunks_exact_mut(self.at.len()).enumerate() {
            // Away from the nearer limit.
            point[j] += if self.at[j] > 0.5 { -self.width } else { self.width };
        }
        self.asked = Asked::Differences(points);
    }

    fn narrow(&mut self) {
        self.width *= NARROWER();
        self.damping = self.damping.min(FIRST_DAMPING());
        self.growth = 2.0;
        if self.width < LEAST_WIDTH() { self.ended = true } else { self.differ() }
    }

    /// Asks for a step, or for other slopes where none is promised.
    fn go(&mut self) {
        match self.step(self.damping) {
            Some((to, promised)) => self.asked = Asked::Step { to, promised },
            None if self.fresh => self.narrow(),
            None => self.differ(),
        }
    }

    /// Where a step leads, and how much lower the cost is expected to be there.
    fn step(&self, damping: f64) -> Option<(Vec<f64>, f64)> {
        let moment = -self.slopes.tr_mul(&self.residuals);
        let held = |j: &usize| {
            let at = self.at[*j];
            !(at <= 0.0 && moment[*j] <= 0.0 || at >= 1.0 && moment[*j] >= 0.0)
        };
        let active: Vec<usize> = (0..self.at.len()).filter(held).collect();
        let slopes = self.slopes.select_columns(&active);
        let mut normal = slopes.tr_mul(&slopes);
        let largest = normal.diagonal().iter().fold(0.0_f64, |a, b| a.max(*b));
        for j in 0..active.len() {
            normal[(j, j)] = normal[(j, j)] * (1.0 + damping) + 1e-15 * largest + f64::MIN_POSITIVE;
        }
        let change = normal.cholesky()?.solve(&moment.select_rows(&active));
        let mut to = self.at.clone();
        for (j, change) in active.iter().zip(change.iter()) {
            to[*j] = (to[*j] + change.clamp(-LONGEST(), LONGEST())).clamp(0.0, 1.0);
        }
        let moved = DVector::from_iterator(to.len(), to.iter().zip(&self.at).map(|(to, at)| to - at));
        let expected = (&self.residuals + &self.slopes * moved).norm_squared();
        let now = self.residuals.norm_squared();
        let promised = self.cost * (1.0 - expected / now);
        (promised.is_finite() && promised > 1e-12 * self.cost).then_some((to, promised))
    }
}
