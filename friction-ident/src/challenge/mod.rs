//! Recordings with a hidden effect: a simulated ball-screw table whose full model is the truth.
//!
//! The generator only simulates. How large the hidden effect is, is measured by the force that it
//! adds beyond what coulomb, viscous, offset and the mass can imitate, against the error with which
//! a force can be known from the recording at all.

mod draw;
mod excitation;
mod size;

use missing_physics::Recording;
use serde::{Deserialize, Serialize};

pub use excitation::excitation;

use crate::closed_loop::{ClosedLoopError, Pd, Run, Setup, closed_loop};
use crate::effects::UnknownEffect;
use crate::model::{Model, ModelError};

/// Resolution of the table's encoder, m.
pub const ENCODER: f64 = 1e-6;
/// Standard deviation of the recorded force's noise, N.
pub const FORCE_NOISE: f64 = 0.15;
/// Sampling time, s.
pub const SAMPLE_TIME: f64 = 1e-3;
/// Stroke of the table, m.
pub const STROKE: f64 = 0.12;

/// What to hide.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Hide {
    /// Nothing: the base model is the truth.
    Nothing,
    /// Any effect that is not part of the base model.
    Random,
    /// This one.
    Effect(String),
}

impl Hide {
    /// From text: `nothing`, `random` or the name of an effect.
    pub fn parse(text: &str) -> Self {
        match text {
            "nothing" | "none" => Self::Nothing,
            "random" => Self::Random,
            name => Self::Effect(name.to_owned()),
        }
    }
}

/// How large the hidden effect is: its force against the noise of a force estimate, or, for a
/// contact, the distance up to breakaway against the resolution of the encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// 1 to 3 times.
    Faint,
    /// 3 to 10 times.
    Moderate,
    /// 10 to 20 times.
    #[default]
    Clear,
}

impl Level {
    fn range(self) -> (f64, f64) {
        match self {
            Self::Faint => (1.0, 3.0),
            Self::Moderate => (3.0, 10.0),
            Self::Clear => (10.0, 20.0),
        }
    }
}

/// What the recording was made with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// The effect that the base model lacks, if any.
    pub hidden: Option<String>,
    /// The size asked for.
    pub level: Level,
    /// Force that the hidden effect adds beyond the base model's reach, N: rms of the 5 % of the
    /// samples where it is largest.
    pub hidden_force: f64,
    /// Error with which the force on the mass is known at a sample, N.
    pub noise_force: f64,
    /// Seed.
    pub seed: u64,
    /// The full model.
    pub model: Model,
}

/// A recording and its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Challenge {
    /// What discovery may see.
    pub recording: Recording,
    /// What it may not.
    pub truth: Truth,
}

/// Why there is no challenge.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ChallengeError {
    /// No effect of that name.
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    /// The effect is part of the base model.
    #[error(
        "'{0}' is part of the base model and cannot hide\nhide another effect, random or nothing"
    )]
    Base(String),
    /// The effect needs another machine.
    #[error(
        "'{0}' cannot hide in a simulated ball-screw table\nhide another effect, random or nothing"
    )]
    NotHere(String),
    /// The full model is not a model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The simulation failed.
    #[error(transparent)]
    Run(#[from] ClosedLoopError),
}

/// Makes a challenge. The same arguments give the same challenge.
///
/// # Errors
/// The effect to hide is unknown or cannot hide.
pub fn generate(hide: &Hide, seed: u64, level: Level) -> Result<Challenge, ChallengeError> {
    let mut draw = draw::Draw::new(seed);
    let base = draw.base()?;
    let hidden = draw.hidden(hide)?;
    let ratio = draw.ratio(level);
    let (model, hidden_force) = match hidden {
        None => (base, 0.0),
        Some(effect) => {
            let base = draw.companion(base, effect)?;
            let full = draw.full(&base, effect)?;
            size::scaled(&base, &full, effect, ratio, seed)?
        }
    };
    let run = record(&model, seed)?;
    let truth = Truth {
        hidden: hidden.map(|effect| effect.about().name.to_owned()),
        level,
        hidden_force,
        noise_force: size::noise_force(model.mass()),
        seed,
        model,
    };
    Ok(Challenge { recording: run.recording, truth })
}

/// The table under its controller, tuned for a table of average mass.
fn record(model: &Model, seed: u64) -> Result<Run, ClosedLoopError> {
    let (mass, bandwidth, damping) = (40.0, 110.0, 0.8);
    let mut pd = Pd::new(mass * bandwidth * bandwidth, 2.0 * damping * mass * bandwidth)
        .with_feedforward(mass)
        .with_smoothing(0.35);
    let setup = Setup {
        encoder_resolution: ENCODER,
        force_limit: 600.0,
        force_noise: FORCE_NOISE,
        seed,
        ..Setup::default()
    };
    closed_loop(model, &excitation(), &mut pd, &setup)
}

#[cfg(test)]
mod tests;
