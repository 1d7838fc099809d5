//! Whether a fitted effect is that effect.

use super::node::Node;
use super::{Ahead, scales};
use crate::family::{ModelFamily, Role};
use crate::report::Refusal;

/// Share of an amplitude of every model below which nothing of it is left.
const GONE: f64 = 0.001;

/// The effect of a model that is not one as it was fitted, and why, if any: an amplitude ended at the limit of its
/// search, what makes it that effect is gone (a gap of no width), or it left nothing of what every model has (a mass).
pub fn refused<F: ModelFamily + ?Sized>(
    family: &F,
    ahead: &dyn Ahead,
    base: &Node,
    node: &Node,
) -> Option<(usize, Refusal)> {
    let moved = scales::of(family, &node.model);
    for (place, index) in node.model.terms.iter().enumerate() {
        let term = &family.terms()[*index];
        for (k, parameter) in node.model.range(family, place).zip(&term.parameters) {
            if parameter.role != Role::Amplitude {
                continue;
            }
            let key = || term.key(parameter);
            let gone = |before: f64| node.model.values[k].abs() < GONE * before.abs();
            match base.model.values.get(k) {
                Some(before) if term.always && parameter.lower >= 0.0 && gone(*before) => {
                    let last = *node.model.terms.last()?;
                    return Some((last, Refusal::NothingLeft { parameter: key() }));
                }
                None if moved[k].is_at_far_limit() => {
                    return Some((*index, Refusal::AtLimit { parameter: key() }));
                }
                _ => {}
            }
        }
    }
    ahead.vanishes(&node.model)
}
