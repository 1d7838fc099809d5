//! A task as a problem.

use aep_core::random::{self, Stream};
use aep_core::{Batch, Domain, LeastSquares, Problem};

use super::{Model, Task};
use crate::noise::stream_at;

/// An identification task with its recording: a [`Problem`], and a sum of squares.
///
/// A cost is NaN where the simulation fails. The noise of a simulator, where the task has it, is a
/// function of the position, so that a noisy run can be repeated too.
pub struct Identification {
    task: &'static Task,
    domain: Domain,
    model: Box<dyn Model>,
    recording: Vec<f64>,
    /// Of the simulator, see [`Task::noise`].
    noise: f64,
}

/// Adds numbers from N(0, `deviation`^2).
pub(super) fn disturb(values: &mut [f64], deviation: f64, rng: &mut Stream) {
    for value in values {
        *value += deviation * random::normal::<f64>(rng);
    }
}

impl Identification {
    pub(super) fn new(task: &'static Task) -> Self {
        let model = (task.model)();
        let recording = model.recording().unwrap_or_else(|| {
            let mut recording = Vec::new();
            model.predict(&task.truth(), &mut recording);
            disturb(&mut recording, 1.0, &mut stream_at(1, &task.truth()));
            recording
        });
        Self { task, domain: task.domain(), model, recording, noise: task.noise }
    }

    /// What is known of the task.
    pub fn task(&self) -> &'static Task {
        self.task
    }

    /// The cost at which a run counts as successful.
    pub fn target(&self) -> f64 {
        self.task.best.cost * (1.0 + self.task.tolerance)
    }

    /// The same with a simulator that gives the same again.
    #[must_use]
    pub fn without_noise(self) -> Self {
        Self { noise: 0.0, ..self }
    }

    /// Whether the simulator gives other predictions at each position.
    pub fn is_noisy(&self) -> bool {
        self.noise > 0.0
    }

    /// The cost without the noise of the simulator: what decides whether a run is successful.
    pub fn exact(&self, x: &[f64]) -> f64 {
        let mut residuals = Vec::with_capacity(self.recording.len());
        self.write_exact(x, &mut residuals);
        sum_of_squares(&residuals)
    }

    fn write_exact(&self, x: &[f64], residuals: &mut Vec<f64>) {
        residuals.clear();
        self.model.predict(x, residuals);
        for (residual, recorded) in residuals.iter_mut().zip(&self.recording) {
            *residual -= recorded;
        }
    }

    fn write_residuals(&self, x: &[f64], residuals: &mut Vec<f64>) {
        self.write_exact(x, residuals);
        if self.noise > 0.0 {
            disturb(residuals, self.noise, &mut stream_at(0, x));
        }
    }
}

/// Whatever kind of NaN a simulation ended in, the cost is the one that sorts behind all others.
fn sum_of_squares(residuals: &[f64]) -> f64 {
    let sum: f64 = residuals.iter().map(|residual| residual * residual).sum();
    if sum.is_nan() { f64::NAN } else { sum }
}

impl LeastSquares for Identification {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let mut residuals = Vec::with_capacity(self.recording.len());
        self.write_residuals(x, &mut residuals);
        residuals
    }

    fn cost(&self, residuals: &[f64]) -> f64 {
        sum_of_squares(residuals)
    }

    fn objective_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        let mut residuals = Vec::with_capacity(self.recording.len());
        for (x, cost) in points.rows().zip(costs) {
            self.write_residuals(x, &mut residuals);
            *cost = sum_of_squares(&residuals);
        }
    }
}

impl Problem for Identification {
    fn domain(&self) -> &Domain {
        &self.domain
    }

    fn evaluate(&self, x: &[f64]) -> f64 {
        self.objective(x)
    }

    fn evaluate_batch(&self, points: Batch<'_>, costs: &mut [f64]) {
        self.objective_batch(points, costs);
    }

    fn batch_size(&self) -> usize {
        4
    }

    fn as_least_squares(&self) -> Option<&dyn LeastSquares> {
        Some(self)
    }

    fn identity(&self) -> String {
        self.task.name.into()
    }
}
