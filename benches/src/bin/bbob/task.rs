//! A function that counts.

use coco_rs::Problem;

/// A BBOB function of which a limited number of evaluations is counted.
pub struct Task<'a> {
    problem: Problem<'a>,
    budget: u64,
    used: u64,
    solved: Option<u64>,
}

impl<'a> Task<'a> {
    pub fn new(problem: Problem<'a>, budget: u64) -> Self {
        Self { problem, budget, used: 0, solved: None }
    }

    /// The cost at `x`; the target itself once the task is over, so that whoever asks on stops.
    pub fn evaluate(&mut self, x: &[f64]) -> f64 {
        if self.is_over() {
            return self.target();
        }
        let mut cost = [f64::INFINITY];
        self.problem.evaluate_function(x, &mut cost);
        self.used += 1;
        if self.problem.final_target_hit() {
            self.solved = Some(self.used);
        }
        cost[0]
    }

    pub fn is_over(&self) -> bool {
        self.solved.is_some() || self.used >= self.budget
    }

    pub fn target(&self) -> f64 {
        self.problem.final_target_value()
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

    pub fn limits(&self) -> (Vec<f64>, Vec<f64>) {
        let ranges = self.problem.ranges_of_interest();
        ranges.iter().map(|range| (*range.start(), *range.end())).unzip()
    }
}
