//! Which of two readings of a recording stands: the one in which the best model with one effect predicts better.
//!
//! What the simplest model lacks can hide how an input acts between samples. And a wrong reading (an input that was
//! held taken as sampled, or the other way round) takes an effect of its own to make up for it, so that fewer effects
//! count for it where both predict alike.

use std::cmp::Ordering;

use super::Ahead;
use super::fit::Fitter;
use super::foretold::is_foretold;
use super::node::Node;

/// Steps of a fit in the other reading.
const STEPS: usize = 6;

/// By how many nats the best model of one reading is to be preferred to that of the other, each with its number of
/// effects, as `ahead` sees them: one with fewer is allowed to lose `better`, and what its errors foretell themselves.
pub fn nats(ahead: &dyn Ahead, here: (&Node, usize), there: (&Node, usize), better: f64) -> f64 {
    let ((here, effects), (there, others)) = (here, there);
    let nats = gain(there, here);
    let is_foretold = |from, to, nats| is_foretold(ahead, from, to, nats, better);
    match effects.cmp(&others) {
        Ordering::Less if is_foretold(here, there, -nats) => better,
        Ordering::Less => nats + better,
        Ordering::Equal => nats,
        Ordering::Greater if is_foretold(there, here, nats) => -better,
        Ordering::Greater => nats - better,
    }
}

/// Whether the reading stands whose best model is to be preferred to that of the other one `by` so many nats. One that takes an
/// effect which may be no more than how late the input is read (`of_reading`: this one, the other) must do better by what an effect must gain: either is
/// wrong where the input changes between samples, and a lag is the rest of the way from the one to the other.
pub fn stands(by: f64, of_reading: (bool, bool), better: f64) -> bool {
    let needed = |is: bool| if is { better } else { 0.0 };
    by + needed(of_reading.1) > needed(of_reading.0)
}

/// A model without one of the effects that were `added` to it, where the other reading, whose `fitter` this is, does as
/// well without.
pub fn with_less(top: &Node, added: &[usize], fitter: &Fitter<'_>, better: f64) -> Option<Node> {
    if added.is_empty() {
        return None;
    }
    let all = fitter.refit(top.model.clone(), top.setting, STEPS);
    let without = added.iter().map(|term| {
        let without = fitter.refit(all.model.without(fitter.family(), *term), all.setting, STEPS);
        (gain(&without, top), without)
    });
    let best = without.min_by(|a, b| a.0.total_cmp(&b.0));
    best.filter(|(gain, _)| *gain < better).map(|(_, without)| without)
}

/// Whether a model predicts better in the other reading, whose `fitter` this is.
pub fn is_better(model: &Node, fitter: &Fitter<'_>) -> bool {
    gain(model, &fitter.refit(model.model.clone(), model.setting, STEPS)) > 0.0
}

/// Gain in log-likelihood from one model to another, each with errors of its own size.
fn gain(from: &Node, to: &Node) -> f64 {
    to.errors.len() as f64 / to.correlation() * (from.deviation / to.deviation).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit;
    use crate::ahead::testing::{BEAT, Plant, WAVE};

    fn model(plant: &Plant, terms: &[(usize, &[f64])]) -> Node {
        fit::evaluated(plant, Plant::model(terms), 0)
    }

    #[test]
    fn the_better_prediction_is_preferred_and_one_effect_less_may_cost_what_one_must_gain() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let (good, poor) = (model(&plant, &[(WAVE, &[0.05])]), model(&plant, &[]));
        let alike = nats(&plant, (&good, 1), (&poor, 1), 20.0);
        assert!(alike > 20.0, "{alike}");
        assert_eq!(nats(&plant, (&poor, 1), (&good, 1), 20.0), -gain(&good, &poor).abs());
        assert_eq!(nats(&plant, (&good, 0), (&poor, 1), 20.0), alike + 20.0);
        assert_eq!(nats(&plant, (&good, 2), (&poor, 1), 20.0), alike - 20.0);
        assert_eq!(nats(&plant, (&good, 1), (&good, 2), 20.0), 20.0);
    }

    #[test]
    fn a_reading_that_takes_a_lag_of_its_own_must_do_clearly_better() {
        for (of_reading, least) in [
            ((false, false), 0.0),
            ((true, true), 0.0),
            ((true, false), 80.0),
            ((false, true), -80.0),
        ] {
            assert!(stands(least + 1.0, of_reading, 80.0), "{of_reading:?}");
            assert!(!stands(least - 1.0, of_reading, 80.0), "{of_reading:?}");
        }
    }

    #[test]
    fn a_model_is_better_in_the_reading_that_it_is_true_of() {
        let wave: (usize, &[f64]) = (WAVE, &[0.05]);
        let (with, without) = (Plant::new(2, &[wave, (BEAT, &[0.03])]), Plant::new(2, &[wave]));
        let is_better = |model: &Node, other: &Plant| is_better(model, &Fitter::new(other, other));
        assert!(is_better(&model(&with, &[wave]), &without));
        assert!(!is_better(&model(&without, &[wave]), &with));
    }

    #[test]
    fn a_reading_in_which_an_effect_does_nothing_needs_less() {
        let wave: (usize, &[f64]) = (WAVE, &[0.05]);
        let both = Plant::new(2, &[wave, (BEAT, &[0.03])]);
        let top = model(&both, &[wave, (BEAT, &[0.03])]);
        let less = |added: &[usize], other: &Plant| {
            with_less(&top, added, &Fitter::new(other, other), 20.0)
        };
        // The same noise, and no beat in it.
        let other = Plant::new(2, &[wave]);
        assert_eq!(less(&[WAVE, BEAT], &other).unwrap().effects(&other), [WAVE]);
        assert!(less(&[WAVE, BEAT], &both).is_none());
        assert!(less(&[], &other).is_none());
    }
}
