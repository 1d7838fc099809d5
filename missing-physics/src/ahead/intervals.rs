//! Intervals of a model's parameters from its prediction errors.

use std::collections::BTreeMap;

use aep_core::Scale;

use super::node::Node;
use super::{Ahead, scales};
use crate::family::{ModelFamily, Role};
use crate::fit::{Fit, uncertainty};
use crate::report::Estimate;

/// Every parameter of a model by its key, with its 95 % interval.
pub fn of(
    (family, ahead): (&dyn ModelFamily, &dyn Ahead),
    node: &Node,
) -> BTreeMap<String, Estimate> {
    of_fit(family, &as_prediction((family, ahead), node))
}

/// The largest of these amplitudes of an effect (all by their places among its parameters), and its interval where the others
/// of them keep their proportion to it and the effect's shapes are known: of several that make up for each other none need be
/// known for the effect to be.
pub fn of_size(
    (family, ahead): (&dyn ModelFamily, &dyn Ahead),
    node: &Node,
    place: usize,
    amplitudes: &[usize],
) -> Option<(usize, Estimate)> {
    let term = &family.terms()[*node.model.terms.get(place)?];
    let range = node.model.range(family, place);
    let values = &node.model.values[range.clone()];
    let by_size = |a: &&usize, b: &&usize| values[**a].abs().total_cmp(&values[**b].abs());
    let largest = *amplitudes.iter().max_by(by_size)?;
    let mut fit = as_prediction((family, ahead), node);
    let columns = &mut fit.jacobian[range];
    for (k, parameter) in term.parameters.iter().enumerate().filter(|(k, _)| *k != largest) {
        let goes_along = amplitudes.contains(&k);
        if parameter.role == Role::Amplitude && !goes_along {
            continue;
        }
        let share = values[k] / values[largest];
        // What changes nothing is not moved.
        let column = std::mem::take(&mut columns[k]);
        columns[k] = vec![0.0; column.len()];
        if goes_along && share.is_finite() {
            let sum = columns[largest].iter_mut().zip(&column);
            sum.for_each(|(sum, value)| *sum += share * value);
        }
    }
    Some((largest, of_fit(family, &fit).remove(&term.key(&term.parameters[largest]))?))
}

fn of_fit(family: &dyn ModelFamily, fit: &Fit) -> BTreeMap<String, Estimate> {
    uncertainty::estimates(family, fit, &vec![1.0; fit.residual.len()])
}

/// The node as the estimator of intervals wants it.
fn as_prediction((family, ahead): (&dyn ModelFamily, &dyn Ahead), node: &Node) -> Fit {
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
