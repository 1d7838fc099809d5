//! Parameters on the scales on which they are fitted: logarithms, or multiples of a typical size.

use aep_core::Scale;

use crate::family::{Fitted, ModelFamily, Parameter};

/// Size of an amplitude that counts as its scale, as a share of its typical size, where its value is less.
const SHARE: f64 = 0.2;
/// Half-widths of differences: of logarithms, and in scales.
const DIFFERENCE: (f64, f64) = (2e-3, 5e-3);
/// Largest step of a logarithm.
const LEAP: f64 = 1.5;
/// Standard deviation of the weak prior on a logarithm, and on a linear parameter in scales.
const PRIOR: (f64, f64) = (2.0, 3.0);
/// A value this near to a limit is at it, as a share of the limit's size.
const AT_LIMIT: f64 = 1e-3;

/// A parameter, its value, and how it is moved.
#[derive(Clone, Debug)]
pub struct Moved {
    parameter: Parameter,
    value: f64,
    /// One unit of the fit, for a linear parameter.
    scale: f64,
}

/// The parameters of a model as they are moved.
pub fn of<F: ModelFamily + ?Sized>(family: &F, model: &Fitted) -> Vec<Moved> {
    let parameters = model.parameters(family);
    parameters
        .zip(&model.values)
        .map(|((term, p), value)| Moved::new(p, *value, term.always))
        .collect()
}

impl Moved {
    fn new(parameter: &Parameter, value: f64, always: bool) -> Self {
        let typical = SHARE * parameter.start.abs();
        // What every model has is known: its own size is its scale.
        let scale = if always { value.abs() } else { value.abs().max(typical) };
        Self { parameter: parameter.clone(), value, scale: scale.max(f64::MIN_POSITIVE) }
    }

    /// One unit of the fit; 1 for a logarithm's own.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    fn is_log(&self) -> bool {
        self.parameter.scale == Scale::Log
    }

    /// The value after a step on this scale, within its limits.
    pub fn by(&self, step: f64) -> f64 {
        let value = if self.is_log() {
            self.value * step.clamp(-LEAP, LEAP).exp()
        } else {
            self.value + step * self.scale
        };
        value.clamp(self.parameter.lower, self.parameter.upper)
    }

    /// A small step that stays within the limits.
    pub fn difference(&self) -> f64 {
        let step = if self.is_log() { DIFFERENCE.0 } else { DIFFERENCE.1 };
        if self.by(step) > self.value { step } else { -step }
    }

    /// Curvature of the weak prior, 1 over variance.
    pub fn prior(&self) -> f64 {
        let deviation = if self.is_log() { PRIOR.0 } else { PRIOR.1 };
        1.0 / (deviation * deviation)
    }

    /// Whether it sits at a limit and `push` (a positive one raises it) goes beyond.
    pub fn is_held(&self, push: f64) -> bool {
        (self.value <= self.parameter.lower && push < 0.0)
            || (self.value >= self.parameter.upper && push > 0.0)
    }

    /// Whether it ended at a limit of its search that is not 0.
    pub fn is_at_far_limit(&self) -> bool {
        let near = |limit: f64| limit != 0.0 && (self.value - limit).abs() <= AT_LIMIT * limit.abs();
        near(self.parameter.lower) || near(self.parameter.upper)
    }
}
