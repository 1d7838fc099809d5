//! Whether what an effect gains is foretold by the errors themselves.
//!
//! Counts of an encoder beat with the samples: at an even speed the error of rounding swings, and what rings at that
//! frequency, or follows the force of a controller that answers the counts, predicts it. So does an autoregression of the
//! errors, of whatever model. What an effect explains it gains beside that one, too: a filter that is monic has the
//! likelihood of the errors that it is put behind (G. E. P. Box and G. M. Jenkins, 1970).

use super::law::Law;
use super::node::{CUT, Node};
use super::{Ahead, statistics};

/// Errors before one that may foretell it: at 4 kHz those of a beat of 200 Hz need more than 8.
const ORDER: usize = 16;
/// Each stretch of so many errors has a law of its own, as a beat has the frequency of its speed,
const LEAST: usize = 500;
/// and lasts so long, s.
const STRETCH: f64 = 0.5;
/// Share of what an effect gains that is enough where it must gain less.
const SHARE: f64 = 0.15;

/// Whether a model gains less than `better` over another that errs no more than the sensors, or less than a part of `nats`,
/// once the errors of either are foretold from those before them. Of larger errors what is missing makes them alike, too.
pub fn is_foretold(ahead: &dyn Ahead, from: &Node, to: &Node, nats: f64, better: f64) -> bool {
    let within = ahead.has_shares() && from.scale <= ahead.budget();
    within && nats > 0.0 && gain(ahead, from, to) < better.min(SHARE * nats)
}

/// Whether a model with an effect that rings gains less than `better` over one without it, whatever that errs, once the
/// errors of either are foretold: a noise of a colour rings, too.
pub fn is_colour(ahead: &dyn Ahead, from: &Node, to: &Node, better: f64) -> bool {
    gain(ahead, from, to) < better
}

/// Whether a model that leaves nothing predicts worse than one that lacks all it has, whatever that errs, once the errors of
/// either are foretold.
pub fn is_loss(ahead: &dyn Ahead, from: &Node, to: &Node) -> bool {
    ahead.has_shares() && gain(ahead, from, to) < 0.0
}

/// What a model gains over another by what is left of its errors, nats.
fn gain(ahead: &dyn Ahead, from: &Node, to: &Node) -> f64 {
    let (from, to) = (left(ahead, from), left(ahead, to));
    let size = |left: &[f64]| statistics::rms(left, CUT).max(f64::MIN_POSITIVE);
    let better = if size(&to) < size(&from) { &to } else { &from };
    let scale = size(better);
    let loss = |left: &[f64]| left.iter().map(|e| statistics::loss(e / scale)).sum::<f64>();
    (loss(&from) - loss(&to)) / statistics::correlation(better)
}

/// What the law of each stretch leaves of the errors of a model.
fn left(ahead: &dyn Ahead, node: &Node) -> Vec<f64> {
    let instants = ahead.instants();
    let mut left = Vec::with_capacity(node.errors.len());
    for piece in instants.chunk_by(|a, b| a.1 == b.1) {
        let lasts = piece[piece.len() - 1].0 - piece[0].0;
        let stretches = (piece.len() / LEAST).min((lasts / STRETCH) as usize).max(1);
        for stretch in piece.chunks(piece.len().div_ceil(stretches)) {
            let errors = &node.errors[left.len()..left.len() + stretch.len()];
            left.extend(Law::of(errors, stretch, ORDER).left(errors, stretch));
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::ahead::compare::Comparison;
    use crate::ahead::testing::{Plant, SAMPLES};

    fn noise(seed: u64) -> Vec<f64> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        (0..SAMPLES).map(|_| StandardNormal.sample(&mut random)).collect()
    }

    /// Whether what a model with errors `to` gains over one with errors `from` is foretold; both in shares of what the sensor
    /// makes.
    fn told(from: &[f64], to: &[f64], share: f64) -> bool {
        let plant = Plant::new(1, &[]);
        let node = |errors: &[f64]| {
            let errors = errors.iter().map(|e| share * plant.budget() * e).collect();
            Node::new(&plant, Plant::model(&[]), 0, errors)
        };
        let (from, to) = (node(from), node(to));
        let nats = Comparison::new(&plant, &plant).unfitted(&from, &to).nats;
        assert!(nats > 100.0, "{nats}");
        is_foretold(&plant, &from, &to, nats, 80.0)
    }

    #[test]
    fn what_rings_in_the_errors_is_foretold_by_them_and_what_a_force_does_is_not() {
        let white = noise(1);
        let (mut rings, mut last) = (Vec::new(), (0.0, 0.0));
        for new in &white {
            last = (new + 0.6 * last.0 - 0.7 * last.1, last.0);
            rings.push(last.0);
        }
        assert!(told(&rings, &white, 0.5));
        // A force that jumps about moves each reading by as much as the noise.
        let forced: Vec<f64> =
            white.iter().zip(noise(2)).map(|(e, force)| e + force.signum()).collect();
        assert!(!told(&forced, &white, 0.5));
        // What is missing beyond the sensors makes errors alike, too.
        assert!(!told(&rings, &white, 2.0));
    }

    #[test]
    fn what_is_missing_predicts_no_less_than_the_errors_do_themselves() {
        let plant = Plant::new(1, &[]);
        let node = |errors: &[f64]| {
            let errors = errors.iter().map(|e| 2.0 * plant.budget() * e).collect();
            Node::new(&plant, Plant::model(&[]), 0, errors)
        };
        let white = noise(1);
        let mut last = 0.0;
        let alike: Vec<f64> = white
            .iter()
            .map(|new| {
                last = new + 0.8 * last;
                last
            })
            .collect();
        let larger: Vec<f64> = noise(2).iter().map(|e| 1.2 * e).collect();
        assert!(is_loss(&plant, &node(&alike), &node(&larger)));
        assert!(!is_loss(&plant, &node(&larger), &node(&white)));
    }
}
