//! Motor gain: the force constant is not what the data sheet says.

use super::{About, Advance, Drive, Effect, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::effects::CDynamics;

/// `F = g u`.
///
/// All forces of the model scale with it: without a known mass it is not identifiable.
#[derive(Clone, Copy, Debug)]
pub struct MotorGain;

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

    #[test]
    fn the_inverse_undoes_the_gain() {
        let (mut force, past) = ([20.0], Past::default());
        let step = Advance { duration: &[1e-3], end: &[0.0], past: &past };
        MotorGain.advance(Parameters::new(&[1.25], 1), &step, &mut [], &mut force);
        assert_eq!(force, [25.0]);
        MotorGain.invert(&[1.25], &[0.0], &mut force);
        assert_eq!(force, [20.0]);
    }
}
