//! Intervals of a model's parameters from its prediction errors.

use std::collections::BTreeMap;

use aep_core::Scale;

use super::node::Node;
use super::{Ahead, scales};
use crate::family::ModelFamily;
use crate::fit::{Fit, uncertainty};
use crate::report::Estimate;

/// Every parameter of a model by its key, with its 95 % interval.
pub fn of<F: ModelFamily + ?Sized>(
    (family, ahead): (&F, &dyn Ahead),
    node: &Node,
) -> BTreeMap<String, Estimate> {
    of_fit(family, &as_prediction((family, ahead), node))
}

/// The same where these parameters, by their places, are known.
pub fn where_known<F: ModelFamily + ?Sized>(
    (family, ahead): (&F, &dyn Ahead),
    node: &Node,
    known: impl IntoIterator<Item = usize>,
) -> BTreeMap<String, Estimate> {
    let mut fit = as_prediction((family, ahead), node);
    // What changes nothing is not moved.
    known.into_iter().for_each(|k| fit.jacobian[k].fill(0.0));
    of_fit(family, &fit)
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
