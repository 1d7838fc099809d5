//! What may be wrong with the force that another model gives, besides what it lacks: its inertia, its gain.
//!
//! These effects stand beside a given force only (see [`crate::Model::beside`]): a plant has one mass.

use missing_physics::Recording;

use super::signal::Signal;
use super::{About, Effect, Motion, Parameter, ParameterRole, Parameters, Scale, Slot, Smooth};
use crate::axis::Quantity;

/// Channel of a recording that holds the force that another model gives.
pub const MODEL_FORCE: &str = "model_force";

/// `dm a`: inertia that the given force has too little of (negative: too much).
#[derive(Clone, Copy, Debug)]
pub struct Inertia;

/// `dk F_model`: share by which the given force is too small (negative: too large).
#[derive(Clone, Copy, Debug)]
pub struct ModelGain;

/// The given force itself, once it is known from a recording.
#[derive(Clone, Copy, Debug)]
pub struct ModelForce;

/// Those of them that can be missing.
pub static BESIDE: &[&dyn Effect] = &[&Inertia, &ModelGain];

static INERTIA: About = About {
    name: "inertia",
    title: "inertia that the given force lacks",
    equation: "dm a",
    parameters: &[Parameter::signed(
        "dm",
        "inertia beside the given one",
        Quantity::Mass,
        1e3,
        1.0,
    )],
    slots: &[Slot::SmoothForce],
    shows: "a residual proportional to the acceleration",
    reference: "C. G. Atkeson, C. H. An, J. M. Hollerbach, Int. J. Robotics Research 5, 1986",
};

static GAIN: About = About {
    name: "model-gain",
    title: "wrong gain of the given force",
    equation: "dk F_model",
    parameters: &[Parameter {
        name: "dk",
        meaning: "share by which the given force is too small",
        quantity: Quantity::One,
        role: ParameterRole::Amplitude,
        low: -0.9,
        high: 9.0,
        scale: Scale::Linear,
        default: 0.02,
        extent: None,
    }],
    slots: &[Slot::SmoothForce],
    shows: "a residual proportional to the given force",
    reference: "L. Ljung, System Identification, 1999, ch. 4 (linear regressions)",
};

static FORCE: About = About {
    name: "model-force",
    title: "force that another model gives",
    equation: "gain (F_model - 1/2 smoothing F_model'')",
    parameters: &[
        Parameter {
            name: "gain",
            meaning: "factor on the given force",
            quantity: Quantity::One,
            role: ParameterRole::Fixed,
            low: 0.0,
            high: 10.0,
            scale: Scale::Linear,
            default: 1.0,
            extent: None,
        },
        Parameter::fixed(
            "smoothing",
            "variance of the smoothing that it went through",
            Quantity::One,
            (-1.0, 1.0),
            0.0,
        ),
    ],
    slots: &[Slot::SmoothForce],
    shows: "nothing: it is there",
    reference: "a column of the user",
};

impl Effect for Inertia {
    fn about(&self) -> &'static About {
        &INERTIA
    }

    fn share_of_given(&self, values: &[f64], mass: f64) -> Option<f64> {
        Some(values[0].abs() / mass)
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        for ((force, dm), a) in out.force.iter_mut().zip(p.get(0)).zip(m.acceleration) {
            *force += dm * a;
        }
    }
}

impl Effect for ModelGain {
    fn about(&self) -> &'static About {
        &GAIN
    }

    fn bound(&self, recording: &Recording) -> Option<&'static dyn Effect> {
        let signal = Signal::of(recording, MODEL_FORCE)?;
        Some(Box::leak(Box::new(Tabled { about: &GAIN, signal, is_given: true })))
    }
}

impl Effect for ModelForce {
    fn about(&self) -> &'static About {
        &FORCE
    }

    fn bound(&self, recording: &Recording) -> Option<&'static dyn Effect> {
        let force = Signal::of(recording, MODEL_FORCE)?;
        let values = &recording.channel(MODEL_FORCE)?.values;
        let square = (WIDTH as f64 * recording.interval()).powi(2);
        let mut curvature = vec![0.0; values.len()];
        for piece in recording.segments() {
            for k in piece.clone() {
                let before = values[k.saturating_sub(WIDTH).max(piece.start)];
                let after = values[(k + WIDTH).min(piece.end - 1)];
                curvature[k] = (before + after - 2.0 * values[k]) / square;
            }
        }
        let curvature = force.with(curvature);
        Some(Box::leak(Box::new(Sharpened { force, curvature })))
    }
}

/// Samples over which the curvature of the given force is taken: it is compared at some 2.5 % of the sampling frequency.
const WIDTH: usize = 8;

/// The given force, freed of a smoothing.
struct Sharpened {
    force: Signal,
    curvature: Signal,
}

impl Effect for Sharpened {
    fn about(&self) -> &'static About {
        &FORCE
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let (mut near, mut also) = (0, 0);
        for (i, (force, t)) in out.force.iter_mut().zip(m.time).enumerate() {
            let smoothing = p.get(1)[i];
            let curvature = if smoothing == 0.0 { 0.0 } else { self.curvature.at(*t, &mut also) };
            *force += p.get(0)[i] * (self.force.at(*t, &mut near) - 0.5 * smoothing * curvature);
        }
    }
}

/// A factor on a recorded signal. It stays in memory, as models refer to effects for as long as they like.
pub(super) struct Tabled {
    about: &'static About,
    signal: Signal,
    /// Whether the signal is all that is given.
    is_given: bool,
}

impl Tabled {
    pub(super) fn keep(about: &'static About, signal: Signal) -> &'static dyn Effect {
        Box::leak(Box::new(Self { about, signal, is_given: false }))
    }
}

impl Effect for Tabled {
    fn about(&self) -> &'static About {
        self.about
    }

    fn share_of_given(&self, values: &[f64], _mass: f64) -> Option<f64> {
        self.is_given.then_some(values[0].abs())
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let mut near = 0;
        for ((force, factor), t) in out.force.iter_mut().zip(p.get(0)).zip(m.time) {
            *force += factor * self.signal.at(*t, &mut near);
        }
    }
}

/// Whether an effect makes sense only beside a given force.
pub fn is_beside(effect: &dyn Effect) -> bool {
    BESIDE.iter().any(|other| other.about().name == effect.about().name)
}

#[cfg(test)]
mod tests {
    use missing_physics::Channel;

    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn a_wrong_inertia_is_a_force_in_proportion_to_the_acceleration() {
        let point = Point { acceleration: 2.0, ..Point::at(0.0, 0.1) };
        assert_eq!(smooth(&Inertia, &[-3.0], point).0, -6.0);
    }

    #[test]
    fn a_wrong_gain_follows_the_given_force_once_a_recording_is_known() {
        assert_eq!(smooth(&ModelGain, &[0.5], Point::at(0.0, 0.1)).0, 0.0);
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let force = time.iter().map(|t| 10.0 * t).collect();
        let channels = vec![Channel::new(MODEL_FORCE, "N", force)];
        let recording = Recording::new("run", time, channels).unwrap();
        let bound = ModelGain.bound(&recording).unwrap();
        let point = Point { time: 2.5, ..Point::at(0.0, 0.1) };
        assert_eq!(smooth(bound, &[0.5], point).0, 12.5);
    }
}
