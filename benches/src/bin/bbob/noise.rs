//! Noise as on BBOB's noisy functions: N. Hansen, S. Finck, R. Ros, A. Auger, "Real-Parameter Black-Box Optimization
//! Benchmarking 2009: Noisy Functions Definitions", INRIA RR-6869.
//!
//! What is disturbed is the excess over the optimum; below the target nothing is. The functions underneath are those of the
//! noiseless suite: there the noisy ones have rotations of their own, and a penalty outside of the box.

use std::ops::RangeInclusive;

use aep_core::random::{Purpose, Stream, Streams, normal, uniform};

/// Numbers of the noisy functions.
pub const FUNCTIONS: RangeInclusive<usize> = 101..=130;
/// Noiseless functions under moderate and under severe noise, each with all three models.
const MODERATE: [usize; 2] = [1, 8];
const SEVERE: [usize; 8] = [1, 8, 7, 10, 14, 17, 19, 21];
/// Excess below which nothing is disturbed, and what is added above it.
const TARGET: f64 = 1e-8;
const ABOVE: f64 = 1.01e-8;

enum Model {
    /// Times exp(beta N).
    Gauss { beta: f64 },
    /// Times U^beta max(1, (1e9/f)^(alpha U)).
    Uniform { alpha: f64, beta: f64 },
    /// Plus alpha 1000, and with a probability alpha times a number that is Cauchy distributed.
    Cauchy { alpha: f64, share: f64 },
}

/// What comes between a function and its method.
pub struct Noise {
    model: Model,
    rng: Stream,
}

/// Number of the noiseless function under a noisy one.
pub fn base(function: usize) -> usize {
    let (place, _) = place(function);
    MODERATE.into_iter().chain(SEVERE).nth(place).unwrap_or(1)
}

/// Which of the functions it is, moderate ones first, and which of the models.
fn place(function: usize) -> (usize, usize) {
    let k = function - FUNCTIONS.start();
    (k / 3, k % 3)
}

impl Noise {
    /// That of a function, drawn from a seed.
    pub fn new(function: usize, dimension: usize, seed: u64) -> Self {
        let (place, model) = place(function);
        let severe = place >= MODERATE.len();
        let spread = 0.49 + 1.0 / dimension as f64;
        let model = match (model, severe) {
            (0, false) => Model::Gauss { beta: 0.01 },
            (0, true) => Model::Gauss { beta: 1.0 },
            (1, false) => Model::Uniform { alpha: 0.01 * spread, beta: 0.01 },
            (1, true) => Model::Uniform { alpha: spread, beta: 1.0 },
            (_, false) => Model::Cauchy { alpha: 0.01, share: 0.05 },
            (_, true) => Model::Cauchy { alpha: 1.0, share: 0.2 },
        };
        Self { model, rng: Streams::new(seed, Purpose::Trial, function as u64).stream(1) }
    }

    /// What is seen of an excess over the optimum.
    pub fn of(&mut self, excess: f64) -> f64 {
        if excess < TARGET {
            return excess;
        }
        let rng = &mut self.rng;
        let seen = match self.model {
            Model::Gauss { beta } => excess * (beta * normal::<f64>(rng)).exp(),
            Model::Uniform { alpha, beta } => {
                let share = uniform::<f64>(rng).powf(beta);
                excess * share * (1e9 / excess).powf(alpha * uniform::<f64>(rng)).max(1.0)
            }
            Model::Cauchy { alpha, share } => {
                let far = if uniform::<f64>(rng) < share {
                    normal::<f64>(rng) / (normal::<f64>(rng).abs() + 1e-199)
                } else {
                    0.0
                };
                excess + alpha * (1000.0 + far).max(0.0)
            }
        };
        seen + ABOVE
    }
}
