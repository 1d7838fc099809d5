//! Which of two readings of a recording stands: the one in which the best model with one effect predicts better.
//!
//! What the simplest model lacks can hide how an input acts between samples. And a wrong reading (an input that was
//! held taken as sampled, or the other way round) takes an effect of its own to make up for it, so that fewer effects
//! count for it where both predict alike.

use std::cmp::Ordering;

use super::node::Node;

/// Whether the best model of one reading, and its number of effects, is to be preferred to that of the other; less than
/// `better` nats are no difference.
pub fn is_better(here: (&Node, usize), there: (&Node, usize), better: f64) -> bool {
    let ((here, effects), (there, others)) = (here, there);
    let points = here.errors.len() as f64 / here.correlation();
    let nats = points * (there.scale / here.scale).ln();
    match effects.cmp(&others) {
        Ordering::Less => nats > -better,
        Ordering::Greater => nats > better,
        Ordering::Equal => nats > 0.0,
    }
}
