//! What keeps a model incomplete, and why effects that fit are not the cause.

use serde::{Deserialize, Serialize};

use super::course::Course;
use super::place::Where;
use super::refusal::Refusal;

/// What is wrong with the recording itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Fault {
    /// Samples repeat the one before them although something moves: they were dropped, or the recorder reads slower than
    /// it writes. They are left out.
    Repeated {
        /// Share of all samples, 0..1.
        share: f64,
    },
    /// Most of the squared error is in a few samples that stand alone.
    Isolated {
        /// Share of the squared error, 0..1.
        share: f64,
    },
}

/// A parameter of every model that is far larger or smaller than the balance with the same effects makes it: a mass so large
/// that the measured input hardly matters, or so small that nothing has to be accelerated. Such a model says little of what the
/// input does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Astray {
    /// The parameter: `mass`.
    pub parameter: String,
    /// Its value, in `unit`.
    pub value: f64,
    /// What least squares of the balance make of it.
    pub balance: f64,
    /// SI unit of both.
    pub unit: String,
}

impl Astray {
    /// Factor by which it may be away from the balance.
    pub const FAR: f64 = 3.0;

    /// Whether it is far larger.
    pub fn is_too_large(&self) -> bool {
        self.value > Self::FAR * self.balance
    }

    /// Whether it is far smaller.
    pub fn is_too_small(&self) -> bool {
        self.value < self.balance / Self::FAR
    }
}

/// Something that a model leaves: with it no model is complete, however small its errors are on the whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Remains {
    /// What stands for no effect does what effects would do.
    Rival {
        /// What it is: `a friction level that varies freely with time`.
        rival: String,
        /// The effects that are not named for it; none where nothing else was found.
        instead_of: Vec<String>,
        /// What it gains over the last model, nats.
        nats: f64,
        /// What it was found to be; nothing where what every model has (an inertia), which it is measured in, ended at the
        /// limit of its search.
        course: Option<Course>,
    },
    /// A model that is not what it is called predicts better than effects that would be named.
    Outdone {
        /// Its effects.
        by: Vec<String>,
        /// Why it is not what it is called.
        refusal: Refusal,
        /// The effects that are not named for it; none where nothing else was found.
        instead_of: Vec<String>,
        /// What it gains over the model with them, nats.
        nats: f64,
    },
    /// The search was cut: what stood then, and what might have taken it back was not asked any more.
    SoFar {
        /// The effects.
        effects: Vec<String>,
        /// What they gain over the base model, nats.
        nats: f64,
        /// Prediction error with them, in multiples of what the sensors make.
        last: f64,
    },
    /// It lacks a force beyond doubt.
    MissingForce {
        /// Root mean square of it.
        rms: f64,
        /// Root mean square of the half-widths of its 95 % bands.
        band: f64,
        /// SI unit of both.
        unit: String,
    },
    /// Whether it lacks a force is not known at any instant: the errors are those of a force that wanders as fast as the recorded
    /// one is large, so that the sensor alone predicts.
    UnknownForce {
        /// Root mean square of the recorded force: nowhere is the missing one known to a tenth of it.
        recorded: f64,
        /// SI unit.
        unit: String,
    },
    /// The recording has a fault.
    Faulty {
        /// Which.
        fault: Fault,
    },
    /// It errs more at one place.
    ErrorNear {
        /// Time or a coordinate.
        coordinate: String,
        /// The place, in `unit`.
        at: f64,
        /// SI unit of the coordinate.
        unit: String,
        /// Error there in multiples of what the sensors make.
        times: f64,
    },
    /// What it leaves depends on a coordinate.
    Structure {
        /// On which, and how.
        place: Where,
    },
    /// What every model has is far from what the balance makes it.
    Astray {
        /// How far.
        astray: Astray,
    },
    /// Its own output is as quick as what it leaves: noise that nobody stated is not known.
    TooCoarse,
    /// What it leaves changes more slowly than noise does.
    Slow {
        /// Root mean square of what it leaves.
        rms: f64,
        /// Root mean square of the noise.
        noise: f64,
        /// SI unit of both.
        unit: String,
    },
}

/// Why effects that a model has are not the cause of what the base model lacks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum NoCause {
    /// What every model has is far from what the balance makes it.
    Astray {
        /// How far.
        astray: Astray,
    },
    /// Something over time that is no effect does more.
    PlainDoesMore {
        /// What.
        place: Where,
    },
    /// An autoregression of the base model's errors foretells what they gain: counts that beat with the samples.
    Foretold,
    /// Most of what depended on a coordinate still does.
    MostIsLeft {
        /// The coordinate.
        coordinate: String,
    },
    /// The last model hardly errs more than the sensors, and some of the force that it lacks is lacking with the effects, too.
    LeavesForce {
        /// Root mean square of the half-widths of its 95 % bands.
        band: f64,
    },
}
