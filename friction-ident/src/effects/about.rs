//! What is known of an effect besides its code: name, equation, parameters, fingerprint, source.

pub use aep_core::Scale;
use serde::Deserialize;

use crate::axis::{Axis, Quantity};

/// How a parameter enters the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterRole {
    /// The effect is linear in it and absent where all its amplitudes are 0.
    Amplitude,
    /// Anything else that is fitted: a velocity, a period, a stiffness, a lag.
    Shape,
    /// Not fitted: taken from the data or from the machine's drawing (a stroke, a pole pitch).
    Fixed,
}

/// What of a recording a parameter is taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// Lowest position.
    StrokeBegin,
    /// Highest position.
    StrokeEnd,
    /// Position half way between them.
    StrokeMiddle,
    /// Time of the first sample.
    RecordingBegin,
    /// Time of the last sample.
    RecordingEnd,
    /// Highest speed.
    TopSpeed,
}

/// One parameter of an effect. Bounds and default are those of a small ball-screw table; see
/// [`Parameter::range`] for another axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Symbol, as in files and on the command line.
    pub name: &'static str,
    /// What it is, in words.
    pub meaning: &'static str,
    /// What it measures.
    pub quantity: Quantity,
    /// How it enters the force.
    pub role: ParameterRole,
    /// Smallest value of a search. 0 for a friction level, a stiffness, a lag.
    pub low: f64,
    /// Largest value of a search.
    pub high: f64,
    /// Scale of a search.
    pub scale: Scale,
    /// Typical value.
    pub default: f64,
    /// What of a recording it is, where a comparison takes it from there.
    pub extent: Option<Extent>,
}

/// Where the stroke begins and ends: of a recording that of its own.
pub const STROKE: [Parameter; 2] = [
    place("start", "begin of the stroke", 0.0).taken_from(Extent::StrokeBegin),
    place("end", "end of the stroke", 0.3).taken_from(Extent::StrokeEnd),
];

const fn place(name: &'static str, meaning: &'static str, default: f64) -> Parameter {
    Parameter::fixed(name, meaning, Quantity::Length, (-10.0, 10.0), default)
}

impl Parameter {
    /// A signed amplitude, searched within `+-high`.
    pub const fn signed(
        name: &'static str,
        meaning: &'static str,
        quantity: Quantity,
        high: f64,
        default: f64,
    ) -> Self {
        let (role, scale) = (ParameterRole::Amplitude, Scale::Linear);
        Self { name, meaning, quantity, role, low: -high, high, scale, default, extent: None }
    }

    /// An amplitude that physics keeps at or above 0.
    pub const fn level(
        name: &'static str,
        meaning: &'static str,
        quantity: Quantity,
        high: f64,
        default: f64,
    ) -> Self {
        let (role, scale) = (ParameterRole::Amplitude, Scale::Linear);
        Self { name, meaning, quantity, role, low: 0.0, high, scale, default, extent: None }
    }

    /// A positive shape parameter, searched on a logarithmic scale.
    pub const fn shape(
        name: &'static str,
        meaning: &'static str,
        quantity: Quantity,
        (low, high): (f64, f64),
        default: f64,
    ) -> Self {
        let (role, scale) = (ParameterRole::Shape, Scale::Log);
        Self { name, meaning, quantity, role, low, high, scale, default, extent: None }
    }

    /// A parameter that is not fitted.
    pub const fn fixed(
        name: &'static str,
        meaning: &'static str,
        quantity: Quantity,
        (low, high): (f64, f64),
        default: f64,
    ) -> Self {
        let (role, scale) = (ParameterRole::Fixed, Scale::Linear);
        Self { name, meaning, quantity, role, low, high, scale, default, extent: None }
    }

    /// The same, taken from a recording where it is compared with one.
    #[must_use]
    pub const fn taken_from(mut self, extent: Extent) -> Self {
        self.extent = Some(extent);
        self
    }

    /// The same, searched on a linear scale.
    #[must_use]
    pub const fn linear(mut self) -> Self {
        self.scale = Scale::Linear;
        self
    }

    /// Bounds of a search on `axis`, SI.
    pub fn range(&self, axis: Axis) -> (f64, f64) {
        let factor = axis.typical(self.quantity);
        (self.low * factor, self.high * factor)
    }

    /// Typical value on `axis`, SI.
    pub fn typical(&self, axis: Axis) -> f64 {
        self.default * axis.typical(self.quantity)
    }

    /// Whether a model may carry `value`: finite, positive where all that is searched is. Bounds are for searches; a
    /// file may go beyond them otherwise.
    pub fn accepts(&self, value: f64) -> bool {
        value.is_finite() && (self.low <= 0.0 || value > 0.0)
    }
}

/// Where an effect acts on the plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// What happens to the commanded force before it reaches the mass.
    Drive,
    /// A force that depends on time, position and velocity.
    SmoothForce,
    /// The level of the set-valued friction.
    FrictionLevel,
    /// How the friction contact deforms before it slides.
    Contact,
    /// Another body that hangs on the mass.
    Attached,
    /// Which past the friction level remembers.
    Memory,
    /// What happens to the position before it is recorded.
    Sensor,
}

impl Slot {
    /// The slot's name, for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drive => "drive",
            Self::SmoothForce => "smooth force",
            Self::FrictionLevel => "friction level",
            Self::Contact => "contact",
            Self::Attached => "attached body",
            Self::Memory => "memory",
            Self::Sensor => "sensor",
        }
    }
}

/// All that is to be said of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct About {
    /// Identifier in files, commands and JSON.
    pub name: &'static str,
    /// Name in words.
    pub title: &'static str,
    /// What is added to the model, with the symbols of `parameters`; `v` velocity, `x` position,
    /// `s = sgn v`.
    pub equation: &'static str,
    /// Its parameters, in the order of a model's values.
    pub parameters: &'static [Parameter],
    /// Where it acts.
    pub slots: &'static [Slot],
    /// What a residual looks like when the model lacks the effect.
    pub shows: &'static str,
    /// Where the law comes from.
    pub reference: &'static str,
}

impl About {
    /// Index of the parameter called `name`.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|parameter| parameter.name == name)
    }

    /// Whether `parameter` is the largest force that a drive gives: the lower it is, the more the effect does.
    pub fn is_limit_of_drive(&self, parameter: &Parameter) -> bool {
        parameter.quantity == Quantity::Force && parameter.role == ParameterRole::Shape
    }

    /// Whether it acts through `slot`.
    pub fn acts_on(&self, slot: Slot) -> bool {
        self.slots.contains(&slot)
    }
}
