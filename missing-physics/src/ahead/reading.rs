//! Which of two readings of a recording stands: the one in which the best model with one effect predicts better.
//!
//! What the simplest model lacks can hide how an input acts between samples. And a wrong reading (an input that was
//! held taken as sampled, or the other way round) takes an effect of its own to make up for it, so that fewer effects
//! count for it where both predict alike.

use super::fit::Fitter;
use super::found::Found;
use super::node::Node;
use crate::family::ModelFamily;

/// Steps of a fit in the other reading.
const STEPS: usize = 6;

/// By how many nats the best model of one reading is to be preferred to that of the other, each with its number of
/// effects: one with fewer is allowed to lose `better`.
pub fn nats(here: (&Node, usize), there: (&Node, usize), better: f64) -> f64 {
    let ((here, effects), (there, others)) = (here, there);
    let nats = gain(there, here);
    match effects.cmp(&others) {
        std::cmp::Ordering::Less => nats + better,
        std::cmp::Ordering::Equal => nats,
        std::cmp::Ordering::Greater => nats - better,
    }
}

/// Whether the other reading, whose `fitter` this is, does as well without one of the effects that were found.
pub fn needs_less<F: ModelFamily + ?Sized>(
    found: &Found,
    other: &F,
    fitter: &Fitter<'_, F>,
    better: f64,
) -> bool {
    let (top, effects) = found.top();
    if effects == 0 {
        return false;
    }
    let all = fitter.refit(top.model.clone(), top.setting, STEPS);
    found.added.iter().any(|term| {
        let without = fitter.refit(all.model.without(other, *term), all.setting, STEPS);
        gain(&without, top) < better
    })
}

/// Gain in log-likelihood from one model to another, each with errors of its own size.
fn gain(from: &Node, to: &Node) -> f64 {
    to.errors.len() as f64 / to.correlation() * (from.deviation / to.deviation).ln()
}
