//! Motor gain: the force constant is not what the data sheet says, or not the same everywhere.

mod current;
mod direction;
mod knee;
mod ripple;
mod stroke;

use super::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::effects::CDynamics;

/// `F = g u`.
///
/// All forces of the model scale with it: without a known mass it is not identifiable. Its forms, which change with the
/// force or along the stroke, are.
#[derive(Clone, Copy, Debug)]
pub struct MotorGain;

static FORMS: [&dyn Effect; 5] =
    [&direction::Direction, &current::Current, &knee::Knee, &stroke::Stroke, &ripple::Ripple];

static ABOUT: About = About {
    name: "motor-gain",
    title: "gain of the motor",
    equation: "F = g u",
    parameters: &[Parameter::shape("g", "gain", Quantity::One, (0.5, 2.0), 1.0)],
    slots: &[Slot::Drive],
    shows: "all parameters scale together: not identifiable without a known mass",
    reference: "M. Gautier, S. Briot, J. Dyn. Syst. Meas. Control 136, 2014 (drive gains)",
};

impl Effect for MotorGain {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics { drive: "force *= {g};", ..CDynamics::NONE })
    }

    fn is_determined(&self) -> bool {
        false
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }

    fn shows_in_force(&self) -> bool {
        false
    }
}

impl Drive for MotorGain {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        for (force, gain) in force.iter_mut().zip(p.get(0)) {
            *force *= gain;
        }
    }

    fn invert(&self, p: &[f64], _time: &[f64], force: &mut [f64]) {
        for force in force {
            *force /= p[0];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Past;
    use super::*;

    /// What becomes of `commands`; the inverse is to give them back.
    pub(super) fn through(effect: &dyn Drive, p: &[f64], commands: &[f64]) -> Vec<f64> {
        let (lanes, past) = (commands.len(), Past::default());
        let values: Vec<f64> = p.iter().flat_map(|value| vec![*value; lanes]).collect();
        let zeros = vec![0.0; lanes];
        let step = Advance { duration: &vec![1e-3; lanes], end: &zeros, past: &past };
        let mut force = commands.to_vec();
        effect.advance(Parameters::new(&values, lanes), &step, &mut [], &mut force);
        let mut back = force.clone();
        effect.invert(p, &zeros, &mut back);
        for (back, command) in back.iter().zip(commands) {
            assert!((back - command).abs() <= 1e-12 * command.abs(), "{back} {command}");
        }
        force
    }

    #[test]
    fn the_inverse_undoes_the_gain() {
        assert_eq!(through(&MotorGain, &[1.25], &[20.0]), [25.0]);
    }
}
