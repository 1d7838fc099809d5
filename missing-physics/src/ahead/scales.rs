//! Parameters on the scales on which they are fitted: logarithms, or multiples of a typical size.

use aep_core::Scale;

use crate::family::{Fitted, ModelFamily, TermParameter};

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
    parameter: TermParameter,
    value: f64,
    /// One unit of the fit, for a linear parameter.
    scale: f64,
    known: bool,
}

/// The parameters of a model as they are moved.
pub fn of(family: &dyn ModelFamily, model: &Fitted) -> Vec<Moved> {
    let parameters = model.parameters(family);
    parameters
        .zip(&model.values)
        .map(|((term, p), value)| Moved::new(p, *value, term.always))
        .collect()
}

impl Moved {
    fn new(parameter: &TermParameter, value: f64, always: bool) -> Self {
        let typical = SHARE * parameter.start.abs();
        // What every model has is known (an inertia): its own size is its scale.
        let known = always && parameter.lower > 0.0;
        let scale = if known { value.abs() } else { value.abs().max(typical) };
        Self { parameter: parameter.clone(), value, scale: scale.max(f64::MIN_POSITIVE), known }
    }

    /// One unit of the fit; 1 for a logarithm's own.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Whether every model has it, and more than none of it: an inertia.
    pub fn is_known(&self) -> bool {
        self.known
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
        let near =
            |limit: f64| limit != 0.0 && (self.value - limit).abs() <= AT_LIMIT * limit.abs();
        near(self.parameter.lower) || near(self.parameter.upper)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::testing::{PUSH, Plant, TONE, TONES};

    /// A push of this size and a tone of this frequency.
    fn moved(push: f64, omega: f64) -> (Moved, Moved) {
        let plant = Plant::new(1, &[]);
        let model = Plant::model(&[(PUSH, &[push]), (TONE, &[0.1, omega])]);
        let all = of(&plant, &model);
        (all[1].clone(), all[3].clone())
    }

    #[test]
    fn steps_stay_within_the_limits() {
        let (push, tone) = moved(0.02, 4.0);
        assert_eq!(push.by(-1e9), 0.0);
        assert_eq!(push.by(1e9), 10.0);
        assert_eq!((tone.by(-9.0), tone.by(9.0)), TONES);
        assert!((tone.by(0.1) / 4.0 - 0.1f64.exp()).abs() < 1e-12);
    }

    #[test]
    fn a_difference_is_taken_to_the_side_where_there_is_room() {
        let (push, tone) = moved(0.0, TONES.1);
        assert!(push.difference() > 0.0 && push.by(push.difference()) > 0.0);
        assert!(tone.difference() < 0.0 && tone.by(tone.difference()) < TONES.1);
    }

    #[test]
    fn a_small_amplitude_moves_in_shares_of_its_typical_size() {
        assert_eq!(moved(0.0, 4.0).0.scale(), SHARE * 0.05);
        assert_eq!(moved(3.0, 4.0).0.scale(), 3.0);
    }

    #[test]
    fn the_end_of_a_search_is_known_and_holds_only_what_pushes_against_it() {
        let (push, tone) = moved(0.0, TONES.0);
        // An amplitude of 0 is none: no search ended there.
        assert!(!push.is_at_far_limit() && tone.is_at_far_limit());
        assert!(push.is_held(-1.0) && !push.is_held(1.0));
        assert!(tone.is_held(-1.0) && !tone.is_held(1.0));
        let (push, tone) = moved(0.05, 1.01 * TONES.0);
        assert!(!push.is_at_far_limit() && !tone.is_at_far_limit());
        assert!(!push.is_held(-1.0) && !tone.is_held(-1.0));
        assert!(moved(0.05, TONES.1).1.is_held(1.0));
    }
}
