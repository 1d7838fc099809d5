//! A gain that differs between the two directions of the force: a single-rod cylinder, an amplifier with two half bridges.

use crate::axis::Quantity;
use crate::effects::{About, Advance, CDynamics, Drive, Effect, Parameter, Parameters, Slot};
use crate::simd::vectorised;

/// `F = u + dg |u|`: the half difference of the two gains, whose mean all other parameters scale with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Direction;

static ABOUT: About = About {
    name: "motor-gain:direction",
    title: "gain that differs by the direction of the force",
    equation: "F = u + dg |u|",
    parameters: &[Parameter::signed(
        "dg",
        "half difference of the gains (+ minus -), of their mean",
        Quantity::One,
        0.9,
        0.1,
    )],
    slots: &[Slot::Drive],
    shows: "the mass looks larger under a force of one sign than under one of the other, and so does all friction",
    reference: "M. Jelali, A. Kroll, Hydraulic Servo-systems, Springer 2003 (single-rod cylinders)",
};

impl Effect for Direction {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics { drive: "force += {dg} * fabs(force);", ..CDynamics::NONE })
    }

    fn drive(&self) -> Option<&dyn Drive> {
        Some(self)
    }
}

impl Drive for Direction {
    fn advance(
        &self,
        p: Parameters<'_>,
        _step: &Advance<'_>,
        _state: &mut [f64],
        force: &mut [f64],
    ) {
        favour(p.get(0), force);
    }

    fn invert(&self, p: &[f64], _time: &[f64], force: &mut [f64]) {
        for force in force {
            *force /= 1.0 + p[0] * force.signum();
        }
    }
}

vectorised! {
    fn favour(half: &[f64], force: &mut [f64]) {
        for (force, half) in force.iter_mut().zip(half) {
            *force += half * force.abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::through;
    use super::*;

    #[test]
    fn the_gains_of_the_two_directions_differ_by_twice_the_half_difference() {
        assert_eq!(through(&Direction, &[0.25], &[20.0, -20.0, 0.0]), [25.0, -15.0, 0.0]);
    }
}
