//! A function that counts.

use aep_core::Whole;
use coco_rs::Problem;

use crate::Result;
use crate::noise::Noise;

/// A function of COCO of which a limited number of evaluations is counted.
pub struct Task<'a> {
    problem: Problem<'a>,
    noise: Option<Noise>,
    limits: (Vec<f64>, Vec<f64>),
    whole: Whole,
    /// How many numbers each of the first components can be: the whole ones.
    counts: Vec<u32>,
    budget: u64,
    used: u64,
    solved: Option<u64>,
}

impl<'a> Task<'a> {
    pub fn new(problem: Problem<'a>, budget: u64, noise: Option<Noise>) -> Result<Self> {
        let ranges = problem.ranges_of_interest();
        let (mut lower, mut upper): (Vec<f64>, Vec<f64>) =
            ranges.iter().map(|range| (*range.start(), *range.end())).unzip();
        // COCO has them first.
        let integers = problem.number_of_integer_variables();
        let is_whole: Vec<bool> = (0..ranges.len()).map(|k| k < integers).collect();
        let whole = Whole::widening(&mut lower, &mut upper, &is_whole)?;
        let count = |k: usize| (upper[k] - lower[k]).round() as u32;
        let counts = (0..integers).map(count).collect();
        let limits = (lower, upper);
        Ok(Self { problem, noise, limits, whole, counts, budget, used: 0, solved: None })
    }

    /// The cost at `x`; the target itself once the task is over, so that whoever asks on stops.
    pub fn evaluate(&mut self, x: &[f64]) -> f64 {
        if self.is_over() {
            return self.target();
        }
        let mut x = x.to_vec();
        self.whole.round(&mut x);
        let mut cost = [f64::INFINITY];
        self.problem.evaluate_function(&x, &mut cost);
        self.used += 1;
        // By what is, not by what is seen.
        if self.problem.final_target_hit() {
            self.solved = Some(self.used);
        }
        let optimum = self.target() - PRECISION;
        self.noise.as_mut().map_or(cost[0], |noise| optimum + noise.of(cost[0] - optimum))
    }

    /// The cost at a position in the cube of width 1.
    pub fn evaluate_in_cube(&mut self, unit: &[f64]) -> f64 {
        let limits = self.limits.0.iter().zip(&self.limits.1);
        let x: Vec<f64> = unit.iter().zip(limits).map(|(u, (lo, hi))| lo + u * (hi - lo)).collect();
        self.evaluate(&x)
    }

    pub fn is_over(&self) -> bool {
        self.solved.is_some() || self.used >= self.budget
    }

    pub fn target(&self) -> f64 {
        self.problem.final_target_value()
    }

    /// Whether a cost is what it seems.
    pub fn is_exact(&self) -> bool {
        self.noise.is_none()
    }

    pub fn budget(&self) -> u64 {
        self.budget
    }

    pub fn used(&self) -> u64 {
        self.used
    }

    /// Evaluations up to the target, if it was hit.
    pub fn solved(&self) -> Option<u64> {
        self.solved
    }

    /// What is searched: half a number more than whole numbers reach.
    pub fn limits(&self) -> (Vec<f64>, Vec<f64>) {
        self.limits.clone()
    }

    /// Components that are whole numbers, and how many each can be.
    pub fn whole(&self) -> Vec<(usize, u32)> {
        self.counts.iter().copied().enumerate().collect()
    }
}

/// The target above the optimum.
const PRECISION: f64 = 1e-8;
