//! Motion that repeats: how long a cycle is, and how well the force repeats from one to the next.

use serde::{Deserialize, Serialize};

use crate::measurement::Recording;
use crate::measurement::period::{difference, period};
use crate::measurement::quantity::quantity;

/// Motion that repeats.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Length of a cycle in samples.
    pub samples: usize,
    /// Length of a cycle, s.
    pub period_s: f64,
    /// Whole cycles in the recording.
    pub cycles: usize,
    /// Root mean square of what differs in the force from cycle to cycle, over the square root of
    /// two: the part of the force that no model of the motion can explain.
    pub force_repeatability: Option<f64>,
    /// Unit of the force.
    pub force_unit: String,
}

impl Cycle {
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        // Over several segments a sample's number says nothing of the motion.
        let [_] = recording.segments() else {
            return None;
        };
        let motion = recording.channel("reference").or_else(|| recording.channel("position"))?;
        let samples = period(&motion.values)?;
        let force = recording.channel("force");
        Some(Self {
            samples,
            period_s: samples as f64 * recording.interval(),
            cycles: motion.values.len() / samples,
            force_repeatability: force
                .map(|force| difference(&force.values, samples) / std::f64::consts::SQRT_2),
            force_unit: force.map(|force| force.unit.clone()).unwrap_or_default(),
        })
    }

    pub(super) fn in_words(&self) -> String {
        let motion = format!(
            "the motion repeats every {}, {} times",
            quantity(self.period_s, "s"),
            self.cycles
        );
        let Some(force) = self.force_repeatability else {
            return motion;
        };
        let force = quantity(force, &self.force_unit);
        format!("{motion}; from cycle to cycle the force differs by {force} rms")
    }
}
