//! Memory: what the friction level knows of the past.

use super::{Motion, Parameters, Past};

/// What a memory that asks of the past only for the begin of the step must know, s.
pub const BEGIN_OF_STEP: f64 = 1e-9;

/// From the begin of the step that is being taken to where a level is asked for, s.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
pub fn since_begin(begin: f64, now: f64) -> f64 {
    (now - begin).max(0.0)
}

/// How a lane begins, as a [`Memory`] sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Begun {
    /// Velocity, m/s or rad/s.
    pub velocity: f64,
    /// How it came there; nothing where nobody knows, as where a recording begins.
    pub came: Option<Came>,
}

/// The motion before a begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Came {
    /// Way since the last reversal, m or rad: positive forth, negative back.
    pub way: f64,
    /// Time at rest so far, s, 0 in motion; nothing where it has rested since the begin of the recording.
    pub rested: Option<f64>,
}

/// Shapes what the friction level sees, from a state of its own.
pub trait Memory: Sync + Send {
    /// State variables per lane.
    fn states(&self) -> usize {
        0
    }

    /// State of one lane at its begin.
    fn start(&self, _p: &[f64], _begun: &Begun, _state: &mut [f64]) {}

    /// Longest time, s, over which it must know the velocity.
    fn memory(&self, _p: Parameters<'_>) -> f64 {
        0.0
    }

    /// What the level sees at `m`; `past` is the velocity so far.
    fn recall(
        &self,
        p: Parameters<'_>,
        m: &Motion<'_>,
        past: &Past,
        state: &[f64],
        out: &mut Recalled<'_>,
    );

    /// Whether it asks what is left of the static hump: [`Taken::hump`] is 1 where nobody does.
    fn takes_hump(&self) -> bool {
        false
    }

    /// Takes a piece of motion into the state.
    fn remember(&self, _p: Parameters<'_>, _taken: &Taken<'_>, _state: &mut [f64]) {}

    /// The same as the compensator keeps it, sample by sample; nothing where it does not know such a memory.
    fn sampled(&self) -> Option<Sampled> {
        None
    }

    /// Follows an observer that moves the estimate of the position by `displacement`, m or rad: see
    /// [`super::Element::correct`].
    fn correct(&self, _p: Parameters<'_>, _displacement: &[f64], _state: &mut [f64]) {}
}

/// What a controller that samples keeps of a [`Memory`]; the first parameter of the effect is its time, s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampled {
    /// The level follows the velocity that long ago.
    Delay,
    /// The level follows the velocity through a first-order lag.
    Lag,
    /// The static hump grows back at rest, half of it in that time.
    Bond,
}

/// What a [`Memory`] may change.
#[derive(Debug)]
pub struct Recalled<'a> {
    /// The velocity that the friction level follows.
    pub level_velocity: &'a mut [f64],
    /// How much of the static hump has formed, 0..1.
    pub bond: &'a mut [f64],
    /// To be added to: friction level, N or N m.
    pub level: &'a mut [f64],
}

/// A piece of motion as a [`Memory`] sees it.
#[derive(Clone, Copy, Debug)]
pub struct Taken<'a> {
    /// Length, s.
    pub duration: &'a [f64],
    /// Displacement, m or rad.
    pub displacement: &'a [f64],
    /// 1 where the lane slides at the end of the piece, 0 where it rests.
    pub sliding: &'a [f64],
    /// Time at rest so far, s; while sliding the length of the last rest.
    pub dwell: &'a [f64],
    /// Share of the static hump that the level velocity leaves, 0..1.
    pub hump: &'a [f64],
}
