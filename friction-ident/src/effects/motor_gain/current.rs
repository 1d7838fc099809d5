//! A gain that falls with the current: iron that saturates, magnets that the armature's field weakens.

use crate::axis::Quantity;
use crate::effects::{About, Advance, CDynamics, Drive, Effect, Parameter, Parameters, Slot};
use crate::simd::vectorised;

/// `F = u / (1 + c |u|)`: it never falls as the command grows, and no command yields more than `1/c`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Current;

static ABOUT: About = About {
    name: "motor-gain:current",
    title: "gain that falls with the current (magnetic saturation)",
    equation: "F = u / (1 + c |u|)",
    parameters: &[Parameter::level(
        "c",
        "share of the gain that is lost per force, where little is",
        Quantity::PerForce,
        1.0,
        1e-3,
    )],
    slots: &[Slot::Drive],
    shows: "the larger the command, the more of it is missing, of either sign; the mass looks larger the harder it is \
            accelerated",
    reference: "J. F. Gieras, Permanent Magnet Motor Technology, CRC Press 2010 (armature reaction)",
};

impl Effect for Current {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics { drive: "force /= 1.0 + {c} * fabs(force);", ..CDynamics::NONE })
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for Current {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        lose(p.get(0), force);
    }

    fn invert(&self, p: &[f64], _time: &[f64], force: &mut [f64]) {
        for force in force {
            // No command yields more than `1/c`: there the largest one that is sensible.
            *force /= (1.0 - p[0] * force.abs()).max(LEAST_GAIN);
        }
    }
}

/// Least share of the gain that a command is told for.
const LEAST_GAIN: f64 = 0.01;

vectorised! {
    fn lose(lost: &[f64], force: &mut [f64]) {
        for (force, lost) in force.iter_mut().zip(lost) {
            *force /= 1.0 + lost * force.abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::through;
    use super::*;

    #[test]
    fn where_the_command_is_one_over_the_parameter_half_of_it_is_lost() {
        assert_eq!(through(&Current, &[0.01], &[100.0, -100.0, 0.0]), [50.0, -50.0, 0.0]);
    }

    #[test]
    fn a_force_that_no_command_yields_has_a_finite_one() {
        let mut force = [150.0];
        Current.invert(&[0.01], &[0.0], &mut force);
        assert!(force[0].is_finite());
    }
}
