//! Intervals of a model's parameters from its prediction errors.

use std::collections::BTreeMap;

use aep_core::Scale;

use super::node::Node;
use super::{Ahead, scales};
use crate::family::{ModelFamily, Role};
use crate::fit::{Fit, uncertainty};
use crate::report::Estimate;

/// Every parameter of a model by its key, with its 95 % interval.
pub fn of<F: ModelFamily + ?Sized>(
    (family, ahead): (&F, &dyn Ahead),
    node: &Node,
) -> BTreeMap<String, Estimate> {
    of_fit(family, &as_prediction((family, ahead), node))
}

/// The amplitude of an effect that is largest, by its place among the effect's parameters, and its interval where the
/// others of the effect keep their proportion to it and its shapes are known: of several that make up for each other none need be
/// known for the effect to be.
pub fn of_size<F: ModelFamily + ?Sized>(
    (family, ahead): (&F, &dyn Ahead),
    node: &Node,
    place: usize,
) -> Option<(usize, Estimate)> {
    let term = &family.terms()[*node.model.terms.get(place)?];
    let range = node.model.range(family, place);
    let begin = range.start;
    let is_amplitude = |k: &usize| term.parameters[k - begin].role == Role::Amplitude;
    let values = &node.model.values;
    let amplitudes = range.clone().filter(is_amplitude);
    let largest = amplitudes.max_by(|a, b| values[*a].abs().total_cmp(&values[*b].abs()))?;
    let mut fit = as_prediction((family, ahead), node);
    for k in range.filter(|k| *k != largest) {
        let share = values[k] / values[largest];
        // What changes nothing is not moved.
        let column = std::mem::take(&mut fit.jacobian[k]);
        fit.jacobian[k] = vec![0.0; column.len()];
        if is_amplitude(&k) && share.is_finite() {
            let sum = fit.jacobian[largest].iter_mut().zip(&column);
            sum.for_each(|(sum, value)| *sum += share * value);
        }
    }
    let key = term.key(&term.parameters[largest - begin]);
    Some((largest - begin, of_fit(family, &fit).remove(&key)?))
}

fn of_fit<F: ModelFamily + ?Sized>(family: &F, fit: &Fit) -> BTreeMap<String, Estimate> {
    uncertainty::estimates(family, fit, &vec![1.0; fit.residual.len()])
}

/// The node as the estimator of intervals wants it.
fn as_prediction<F: ModelFamily + ?Sized>((family, ahead): (&F, &dyn Ahead), node: &Node) -> Fit {
    let moved = scales::of(family, &node.model);
    let jacobian = node.jacobian(family, ahead).iter().zip(&moved);
    let parameters = node.model.parameters(family);
    let columns = jacobian.zip(parameters).map(|((column, moved), (_, parameter))| {
        let per = if parameter.scale == Scale::Log { 1.0 } else { moved.scale() };
        column.iter().map(|value| -value / per).collect()
    });
    Fit {
        model: node.model.clone(),
        prediction: Vec::new(),
        residual: node.errors.clone(),
        jacobian: columns.collect(),
        cost: 0.0,
    }
}
