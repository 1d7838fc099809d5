//! One descent on residuals: Levenberg-Marquardt with few evaluations.
//!
//! Slopes are made by one difference a component, then corrected by every step that leads down (Broyden), and made anew
//! where that no longer does. Positions are shares of the domain's width.
//!
//! References: C. G. Broyden, Mathematics of Computation 19, 1965; K. Madsen, H. B. Nielsen, O. Tingleff, "Methods for
//! non-linear least squares problems", 2004 (secant version, and how the damping follows the gain).

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// First way of a difference, as a share of the domain's width, and the last one: wide ones see over roughness and
/// noise, narrow ones are exact.
const WIDTHS: (f64, f64) = (2e-2, 1e-6);
/// By what a difference narrows where it no longer leads down.
const NARROWER: f64 = 0.1;
/// Damping of the first step, and the least one.
const DAMPING: (f64, f64) = (0.1, 1e-9);
/// Longest change of a component in one step, as a share of the domain's width: slopes do not hold farther, and a longer step
/// is shortened.
const LONGEST: f64 = 0.2;
/// Relative fall of the cost that counts as leading down.
const WORTHWHILE: f64 = 1e-3;
/// Share of the promised fall below which slopes are made anew by differences.
const POOR: f64 = 0.25;
/// Steps with ever more damping that may fail before the differences are narrowed.
const FAILURES: u32 = 4;
/// A descent is given up where its slopes promise less than this share of what it is behind the best.
const HOPELESS: f64 = 0.1;
/// Distance of the farthest component, as a share of the domain's width, within which a descent goes where an earlier one
/// has ended.
const NEAR: f64 = 1e-2;

/// Where an earlier descent has ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct End {
    pub at: Vec<f64>,
    pub cost: f64,
}

/// Rows of shares that are to be evaluated.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Asked {
    /// Places, of which the best one is the start.
    Places(Vec<f64>),
    /// One component moved in each row.
    Differences(Vec<f64>),
    /// A step, and how much lower the cost should be there.
    Step { to: Vec<f64>, promised: f64 },
    /// It has ended.
    Nothing,
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
            damping: DAMPING.0,
            growth: 2.0,
            width: WIDTHS.0,
            failures: 0,
            asked: Asked::Places(places),
        }
    }

    pub fn asked(&self) -> &[f64] {
        match &self.asked {
            Asked::Places(points) | Asked::Differences(points) => points,
            Asked::Step { to, .. } => to,
            Asked::Nothing => &[],
        }
    }

    pub fn ended(&self) -> bool {
        matches!(self.asked, Asked::Nothing)
    }

    /// Where it stands; nowhere if no place had a cost.
    pub fn end(&self) -> Option<End> {
        self.cost.is_finite().then(|| End { at: self.at.clone(), cost: self.cost })
    }

    /// Takes the costs and residuals of what was asked; an empty row of residuals is a failure. `lowest` is the
    /// lowest cost of the run.
    pub fn tell(&mut self, costs: &[f64], residuals: &[Vec<f64>], lowest: f64, ends: &[End]) {
        match std::mem::replace(&mut self.asked, Asked::Nothing) {
            Asked::Places(places) if self.take_best(&places, costs, residuals) => self.differ(),
            Asked::Places(_) | Asked::Nothing => {}
            Asked::Differences(points) => {
                self.set_slopes(&points, costs, residuals);
                self.take_best(&points, costs, residuals);
                if !self.is_over(lowest, ends) {
                    self.go_on();
                }
            }
            Asked::Step { to, promised } => {
                let gain = self.cost - costs[0];
                if gain > 0.0 && residuals[0].len() == self.residuals.len() {
                    let small = gain < WORTHWHILE * self.cost;
                    let narrow = small && self.fresh;
                    self.accept(to, costs[0], &residuals[0], promised);
                    if narrow {
                        self.narrow();
                    } else if small || gain < POOR * promised {
                        self.differ();
                    } else {
                        self.go_on();
                    }
                } else {
                    self.fail();
                }
            }
        }
    }

    /// A step has not led down: more damping, or, where the slopes are not those of here, other slopes.
    fn fail(&mut self) {
        if !self.fresh {
            self.differ();
            return;
        }
        self.damping *= self.growth;
        self.growth *= 2.0;
        self.failures += 1;
        if self.failures >= FAILURES { self.narrow() } else { self.go_on() }
    }

    fn set_slopes(&mut self, points: &[f64], costs: &[f64], residuals: &[Vec<f64>]) {
        let (m, n) = (self.residuals.len(), self.at.len());
        self.slopes = DMatrix::zeros(m, n);
        for (j, found) in residuals.iter().enumerate() {
            // Where it fails a component is left where it is.
            if found.len() == m && costs[j].is_finite() {
                let moved = points[j * n + j] - self.at[j];
                let change = DVector::from_column_slice(found) - &self.residuals;
                self.slopes.set_column(j, &(change / moved));
            }
        }
        self.fresh = true;
        self.failures = 0;
    }

    /// Whether the slopes here promise too little: beside what it is behind the lowest cost, or to get below the end of
    /// an earlier descent.
    fn is_over(&self, lowest: f64, ends: &[End]) -> bool {
        let promised = self.step(DAMPING.1).map_or(0.0, |(_, promised)| promised);
        let hopeless = self.cost > lowest && promised < HOPELESS * (self.cost - lowest);
        let bottom = self.cost - promised;
        hopeless
            || ends.iter().any(|end| self.is_near(end) && bottom >= end.cost * (1.0 - WORTHWHILE))
    }

    fn is_near(&self, end: &End) -> bool {
        self.at.iter().zip(&end.at).all(|(here, there)| (here - there).abs() < NEAR)
    }

    /// Goes to the best of `points` if that is lower; whether it is.
    fn take_best(&mut self, points: &[f64], costs: &[f64], residuals: &[Vec<f64>]) -> bool {
        let n = self.at.len();
        // Slopes and residuals are of one length; the first place that has any says which.
        let count = self.residuals.len();
        let fits = |row: &Vec<f64>| !row.is_empty() && (count == 0 || row.len() == count);
        let usable = (0..costs.len()).filter(|i| fits(&residuals[*i]) && costs[*i] < self.cost);
        let Some(best) = usable.min_by(|a, b| costs[*a].total_cmp(&costs[*b])) else {
            return false;
        };
        self.at = points[best * n..(best + 1) * n].to_vec();
        self.cost = costs[best];
        self.residuals = DVector::from_column_slice(&residuals[best]);
        true
    }

    /// Takes a step that has led down, and corrects slopes and damping by it.
    fn accept(&mut self, to: Vec<f64>, cost: f64, residuals: &[f64], promised: f64) {
        let residuals = DVector::from_column_slice(residuals);
        let step =
            DVector::from_iterator(to.len(), to.iter().zip(&self.at).map(|(to, at)| to - at));
        let unforeseen = &residuals - &self.residuals - &self.slopes * &step;
        self.slopes += unforeseen * step.transpose() / step.norm_squared();
        let ratio = (self.cost - cost) / promised;
        self.damping =
            (self.damping * (1.0 - (2.0 * ratio - 1.0).powi(3)).max(1.0 / 3.0)).max(DAMPING.1);
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

    /// Narrower differences, unless they are narrow enough: then it has ended.
    fn narrow(&mut self) {
        self.width *= NARROWER;
        self.damping = self.damping.min(DAMPING.0);
        self.growth = 2.0;
        if self.width >= WIDTHS.1 {
            self.differ();
        }
    }

    /// Asks for a step, or for other slopes where none is promised.
    fn go_on(&mut self) {
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
        let shorter = (LONGEST / change.amax()).min(1.0);
        let mut to = self.at.clone();
        for (j, change) in active.iter().zip(change.iter()) {
            to[*j] = (to[*j] + shorter * change).clamp(0.0, 1.0);
        }
        let moved =
            DVector::from_iterator(to.len(), to.iter().zip(&self.at).map(|(to, at)| to - at));
        let expected = (&self.residuals + &self.slopes * moved).norm_squared();
        let now = self.residuals.norm_squared();
        let promised = self.cost * (1.0 - expected / now);
        (promised.is_finite() && promised > 1e-12 * self.cost).then_some((to, promised))
    }
}
