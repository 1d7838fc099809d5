//! How large each effect that was not found would have had to be.

use std::collections::BTreeMap;

use crate::climb::grounds::{CONTRADICTION, Grounds, by_key};
use crate::climb::screen::Screened;
use crate::family::shapes::{amplitudes, assemble};
use crate::family::{Fitted, ModelFamily, Role, detection_limit};
use crate::fit::moved;
use crate::report::{DetectionLimit, NamedError};
use crate::statistics::basis::{dot, gram, solve};
use crate::statistics::split::Split;

/// Most steps towards the size that the motion shows.
const STEPS: usize = 6;
/// A size grows by at most this factor in one of them.
const STEP: f64 = 4.0;

/// The size of every effect not in the model at which it would have been found: that which removes
/// as large a share of the error as the largest 5 % of placebos, with the shape that fits best, and,
/// where a view shows nothing but noise, that which the motion shows.
pub fn limits<F: ModelFamily + ?Sized>(
    family: &F,
    split: &Split,
    evidence: &Grounds<'_>,
) -> BTreeMap<String, DetectionLimit> {
    let square: f64 = evidence.last.residual.iter().map(|r| r * r).sum();
    evidence
        .screened
        .iter()
        .filter(|candidate| candidate.p_value > evidence.alpha && candidate.leverage > 0.0)
        .filter_map(|candidate| {
            let term = &family.terms()[candidate.term];
            let amplitude = amplitudes(term).first().copied()?;
            let size = (candidate.needed.max(0.0) * square / candidate.leverage).sqrt();
            let size = shown(family, split, evidence, candidate, size);
            Some((term.name.clone(), detection_limit(term, &candidate.values, amplitude, size)))
        })
        .collect()
}

/// `size`, or the larger one at which every view that shows nothing but noise would grow by the share by which a
/// found effect lowers it. Errors add up in squares: a model without an effect that acts is as wrong as one with
/// an effect that does not.
fn shown<F: ModelFamily + ?Sized>(
    family: &F,
    split: &Split,
    evidence: &Grounds<'_>,
    candidate: &Screened,
    mut size: f64,
) -> f64 {
    if evidence.within_noise.is_empty() {
        return size;
    }
    let wanted = CONTRADICTION.powi(2) - 1.0;
    for _ in 0..STEPS {
        let after = by_key(family.views(&with(family, evidence, candidate, size), split));
        let growth = |(name, before): (&String, &NamedError)| {
            let error = after.get(name)?;
            let share = |error: f64, before: f64| (error / before).powi(2) - 1.0;
            Some(share(error.fit, before.fit).min(share(error.validation, before.validation)))
        };
        let least = evidence.within_noise.iter().filter_map(growth).fold(f64::INFINITY, f64::min);
        if least >= wanted {
            break;
        }
        size *= (wanted / least.max(f64::MIN_POSITIVE)).sqrt().clamp(1.1, STEP);
    }
    size
}

/// The last model with a candidate of this size, its own parameters adapted to first order.
fn with<F: ModelFamily + ?Sized>(
    family: &F,
    evidence: &Grounds<'_>,
    candidate: &Screened,
    size: f64,
) -> Fitted {
    let (fit, term) = (evidence.last, &family.terms()[candidate.term]);
    let shapes = term.parameters.iter().zip(&candidate.values);
    let shape: Vec<f64> = shapes
        .filter(|(parameter, _)| parameter.role == Role::Shape)
        .map(|(_, value)| *value)
        .collect();
    let columns = family.columns(&fit.model, &fit.prediction, candidate.term, &shape);
    let moment: Vec<f64> = fit.jacobian.iter().map(|own| dot(own, &columns[0])).collect();
    let all: Vec<usize> = (0..moment.len()).collect();
    let adapted = solve(&gram(&fit.jacobian), &moment, &all);
    let parameters = fit.model.parameters(family).map(|(_, parameter)| parameter);
    let values = fit.model.values.iter().zip(parameters).zip(&adapted);
    let values = values.map(|((value, parameter), share)| moved(parameter, *value, -size * share));
    let model = Fitted { terms: fit.model.terms.clone(), values: values.collect() };
    model.with(candidate.term, &assemble(term, &shape, &[size]))
}
