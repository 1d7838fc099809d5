//! A model found elsewhere, with what belongs to a recording fitted to this one.

use crate::ahead::node::CUT;
use crate::ahead::statistics;
use crate::family::{Ahead, Fitted, Own};

/// Times that all of the numbers are looked at in turn.
const ROUNDS: usize = 2;
/// Values that an interval is divided by, and how often.
const PARTS: usize = 8;
const ZOOMS: usize = 3;

/// The model as it stands here, and the numbers that were fitted for that, in the order of [`Ahead::own`].
pub fn adapted(ahead: &dyn Ahead, model: &Fitted, setting: usize) -> (Fitted, Vec<(Own, f64)>) {
    let owns = ahead.own(model);
    let mut values: Vec<f64> = owns.iter().map(|own| own.neutral).collect();
    let best = |values: &[f64], k: usize, tried: &[f64]| -> usize {
        let with = |value: &f64| {
            let mut values = values.to_vec();
            values[k] = *value;
            (ahead.with_own(model, &values), setting)
        };
        let models: Vec<(Fitted, usize)> = tried.iter().map(with).collect();
        let errors = ahead.errors(&models);
        let sizes: Vec<f64> = errors.iter().map(|e| statistics::rms(e, CUT)).collect();
        (0..sizes.len()).min_by(|a, b| sizes[*a].total_cmp(&sizes[*b])).unwrap_or(0)
    };
    for round in 0..ROUNDS {
        // One number has been found in the first round.
        if round > 0 && owns.len() < 2 {
            break;
        }
        for (k, own) in owns.iter().enumerate() {
            let mut tried = own.trials.clone();
            for _ in 0..=ZOOMS {
                let place = best(&values, k, &tried);
                values[k] = tried[place];
                let lower = tried[place.saturating_sub(1)];
                let upper = tried[(place + 1).min(tried.len() - 1)];
                let part = (upper - lower) / PARTS as f64;
                tried = (0..=PARTS).map(|i| lower + part * i as f64).collect();
            }
        }
    }
    (ahead.with_own(model, &values), owns.into_iter().zip(values).collect())
}
