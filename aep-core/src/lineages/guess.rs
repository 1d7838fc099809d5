//! What a model of the cost is trusted with.

use serde::{Deserialize, Serialize};

use super::archive::Archive;
use super::distribution::Distribution;
use super::model::{Model, coefficients};

/// Components beyond which a model costs more time than most evaluations.
const MOST_COMPONENTS: usize = 20;
/// Kendall's rank correlation with evaluated costs from which on a model is believed.
const BELIEVED: f64 = 0.8;
/// Entries that a belief is founded on, at least.
const FOUNDED: usize = 15;
/// Third power of its coefficients, about the multiplications of a fit, that each entry pays for: a model is fitted again
/// once there are enough new ones.
const WORK_PER_ENTRY: u64 = 16_000;
/// Evaluations with a model that a run has at the start, per component, ...
const FIRST_RATION: f64 = 200.0;
/// ... and what each evaluation adds.
const EARNED: f64 = 0.01;

/// The evaluations that a run still may accompany with fits. A fit takes far longer than drawing a child:
/// without a limit it would be what a run on a cheap cost spends its time on, long after the model has ceased to
/// pay.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Ration {
    left: f64,
}

impl Ration {
    pub fn new(dimension: usize) -> Self {
        Self { left: FIRST_RATION * dimension as f64 }
    }

    pub fn earn(&mut self, evaluations: usize) {
        self.left += EARNED * evaluations as f64;
    }

    fn is_left(&self) -> bool {
        self.left > 0.0
    }

    fn take(&mut self, evaluations: u64) {
        self.left -= evaluations as f64;
    }
}

/// The archive of a lineage and the model fitted to it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Guess {
    archive: Archive,
    model: Option<Model>,
    /// Entries noted when the model was fitted.
    fitted: u64,
    /// What the model makes of the latest entries, once it was asked.
    #[serde(skip)]
    values: Vec<f64>,
}

impl Guess {
    /// Whether a model pays in lineages of `lambda` children.
    pub fn pays(dimension: usize, lambda: usize) -> bool {
        dimension <= MOST_COMPONENTS && lambda < 4 * dimension
    }

    pub fn note(&mut self, position: &[f64], cost: f64) {
        if !cost.is_finite() {
            return;
        }
        self.archive.note(position, cost, entries(position.len()));
        if let Some(model) = self.model.as_ref().filter(|_| !self.values.is_empty()) {
            self.values.push(model.value(position));
        }
    }

    /// The model, and to how many entries it was fitted; none where there is too little, or the ration is used up.
    pub fn model(&mut self, frame: &Distribution, ration: &mut Ration) -> Option<(&Model, u64)> {
        let pause = |model: &Model| 1 + (model.coefficients() as u64).pow(3) / WORK_PER_ENTRY;
        let new = self.archive.noted() - self.fitted;
        if new >= self.model.as_ref().map_or(1, pause) {
            self.fitted = self.archive.noted();
            self.values.clear();
            let latest = self.archive.latest(entries(frame.dimension()));
            self.model = if ration.is_left() { Model::fit(frame, latest) } else { None };
            ration.take(self.model.as_ref().map_or(0, pause));
        }
        self.model.as_ref().map(|model| (model, self.fitted))
    }

    /// Whether the model ranks what was evaluated last as it is, `evaluated` of them in this generation
    /// of `lambda`.
    pub fn is_believed(&mut self, evaluated: usize, lambda: usize) -> bool {
        let Some(model) = &self.model else { return false };
        let recent = (1.2 * evaluated as f64).min(0.75 * lambda as f64) as usize;
        let latest: Vec<_> = self.archive.latest(recent.max(FOUNDED)).collect();
        if self.values.len() < latest.len() {
            self.values = latest.iter().map(|(position, _)| model.value(position)).collect();
        }
        let costs: Vec<f64> = latest.iter().map(|(_, cost)| *cost).collect();
        kendall(&costs, &self.values[self.values.len() - latest.len()..]) >= BELIEVED
    }
}

/// Entries that are kept for a fit.
fn entries(n: usize) -> usize {
    3 * coefficients(n)
}

/// Kendall's rank correlation of two rows of numbers.
fn kendall(a: &[f64], b: &[f64]) -> f64 {
    let (mut balance, mut pairs) = (0.0, 0.0);
    for i in 0..a.len() {
        for j in 0..i {
            let product = (a[i] - a[j]) * (b[i] - b[j]);
            balance += f64::from(i8::from(product > 0.0) - i8::from(product < 0.0));
            pairs += 1.0;
        }
    }
    if pairs > 0.0 { balance / pairs } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kendall_counts_agreeing_pairs() {
        assert_eq!(kendall(&[1.0, 2.0, 3.0], &[10.0, 20.0, 30.0]), 1.0);
        assert_eq!(kendall(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), -1.0);
        assert!((kendall(&[1.0, 2.0, 3.0], &[1.0, 3.0, 2.0]) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(kendall(&[1.0], &[1.0]), 0.0);
    }
}
