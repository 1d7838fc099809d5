//! A fitted model with its prediction errors.

use std::sync::OnceLock;

use super::law::{Law, ORDER};
use super::predictive::Cost;
use super::{Ahead, scales, statistics};
use crate::family::{Fitted, ModelFamily, Series};

/// A cut for robust squares: those beyond this many times their mean count as that.
pub const CUT: f64 = 16.0;

/// A model, its setting of the process noise, and what it leaves.
#[derive(Clone, Debug)]
pub struct Node {
    /// Terms and values.
    pub model: Fitted,
    /// Setting of the process noise.
    pub setting: usize,
    /// Prediction errors.
    pub errors: Vec<f64>,
    /// Robust rms of the errors.
    pub scale: f64,
    /// What colours them.
    pub law: Law,
    /// What it leaves of them.
    pub innovations: Vec<f64>,
    /// Robust rms of that.
    pub deviation: f64,
    held: bool,
    jacobian: OnceLock<Vec<Vec<f64>>>,
    cost: OnceLock<Cost>,
    correlation: OnceLock<f64>,
    missing_force: OnceLock<Option<Series>>,
}

impl Node {
    /// A model with its errors.
    pub fn new(ahead: &dyn Ahead, model: Fitted, setting: usize, errors: Vec<f64>) -> Self {
        let size = |errors: &[f64]| statistics::rms(errors, CUT).max(f64::MIN_POSITIVE);
        let law = if ahead.is_coloured() {
            Law::of(&errors, ahead.instants(), ORDER)
        } else {
            Law::none()
        };
        let innovations = law.left(&errors, ahead.instants());
        let (scale, deviation) = (size(&errors), size(&innovations));
        Self {
            model,
            setting,
            errors,
            scale,
            law,
            innovations,
            deviation,
            held: false,
            jacobian: OnceLock::new(),
            cost: OnceLock::new(),
            correlation: OnceLock::new(),
            missing_force: OnceLock::new(),
        }
    }

    /// The same; with `held` nothing moves what every model has: its derivatives are 0.
    #[must_use]
    pub fn holding(self, held: bool) -> Self {
        Self { held, ..self }
    }

    /// Whether its prediction error is below that of another. A likelihood gains by another share of noise, too: what a
    /// model explains it foretells.
    pub fn foretells_more(&self, than: &Self) -> bool {
        self.scale < than.scale
    }

    /// Whether what every model has is held.
    pub fn is_held(&self) -> bool {
        self.held
    }

    /// Derivatives of the errors with respect to the parameters on their scales.
    pub fn jacobian(&self, family: &dyn ModelFamily, ahead: &dyn Ahead) -> &[Vec<f64>] {
        self.jacobian.get_or_init(|| {
            let moved = scales::of(family, &self.model);
            let trials: Vec<Fitted> = (0..moved.len())
                .map(|k| {
                    let mut model = self.model.clone();
                    model.values[k] = moved[k].by(moved[k].difference());
                    model
                })
                .collect();
            let mut columns = ahead.errors_beside(&self.model, self.setting, &trials);
            for (column, moved) in columns.iter_mut().zip(&moved) {
                let step = moved.difference();
                let held = self.held && moved.is_known();
                for (new, old) in column.iter_mut().zip(&self.errors) {
                    *new = if held { 0.0 } else { (*new - old) / step };
                }
            }
            columns
        })
    }

    /// What its fitted parameters cost where models are compared, found once by `find`.
    pub fn cost(&self, find: impl FnOnce() -> Cost) -> Cost {
        *self.cost.get_or_init(find)
    }

    /// How many errors say as much as an independent one.
    pub fn correlation(&self) -> f64 {
        *self.correlation.get_or_init(|| statistics::correlation(&self.innovations))
    }

    /// The force that the model lacks, where the family can tell.
    pub fn missing_force(&self, ahead: &dyn Ahead) -> Option<&Series> {
        let find = || ahead.missing_force(&self.model, self.setting);
        self.missing_force.get_or_init(find).as_ref()
    }

    /// Its rms and that of the half-widths of its band.
    pub fn lacks(&self, ahead: &dyn Ahead) -> Option<(f64, f64)> {
        self.missing_force(ahead).and_then(Series::size)
    }

    /// One that lacks this force.
    #[cfg(test)]
    #[must_use]
    pub fn lacking(self, force: Series) -> Self {
        Self { missing_force: OnceLock::from(Some(force)), ..self }
    }

    /// The scale at which errors are weighed: at least what is expected, and what most or all of them are.
    pub fn weighing(&self, expected: f64) -> f64 {
        expected
            .max(statistics::spread(&self.errors))
            .max(0.4 * statistics::rms(&self.errors, f64::INFINITY))
    }

    /// Terms that a base model does not have, in the order of this one.
    pub fn added_to(&self, base: &Self) -> Vec<usize> {
        self.model.terms.iter().copied().filter(|t| !base.model.terms.contains(t)).collect()
    }

    /// Terms without those that every model has.
    pub fn effects(&self, family: &dyn ModelFamily) -> Vec<usize> {
        self.model.terms.iter().copied().filter(|t| !family.terms()[*t].always).collect()
    }

    /// Their names.
    pub fn names(&self, family: &dyn ModelFamily) -> Vec<String> {
        self.effects(family).iter().map(|t| family.terms()[*t].name.clone()).collect()
    }
}
