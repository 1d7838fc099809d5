//! A constant force: weight of an inclined axis, pre-tension, zero error of the current sensor.

use super::{
    About, Apart, AsFound, CLaw, Effect, Motion, Parameter, Parameters, Refused, Slot, Smooth,
};
use crate::axis::Quantity;
use crate::simd::add_to;

/// Share of the force, rms, below which a constant one is none: no drive sets its current so finely (12 to 14 bits).
const NOTHING: f64 = 1e-4;

/// `F_0`.
#[derive(Clone, Copy, Debug)]
pub struct Offset;

static ABOUT: About = About {
    name: "offset",
    title: "constant force",
    equation: "F_0",
    parameters: &[Parameter::signed(
        "F_0",
        "force that resists motion in +x",
        Quantity::Force,
        200.0,
        1.0,
    )],
    slots: &[Slot::SmoothForce],
    shows: "the same residual at both signs of the velocity and at rest; asymmetric viscosity mimics it",
    reference: "M. Gautier, Dynamic identification of robots with power model, ICRA 1997",
};

impl Effect for Offset {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// A drive that is not balanced to the last newton, and an amplifier, have it.
    fn is_usual(&self) -> bool {
        true
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let (value, limit) = (found.values[0].abs(), NOTHING * found.force);
        let meaning = "it is less than a ten-thousandth of the force";
        (value < limit).then_some(Refused { name: "F_0", value, limit, unit_of: "F_0", meaning })
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw { smooth: "force += {F_0};", ..CLaw::NONE })
    }

    fn told_apart(&self) -> &'static [Apart] {
        &[
            Apart {
                from: &["asymmetry"],
                experiment: "break away from rest in both directions: an offset shifts both breakaway forces the same way, \
                             asymmetry makes them differ in size; add constant speeds over the whole range",
            },
            Apart {
                from: &["spring", "gravity-pendulum"],
                experiment: "cover the whole stroke slowly in both directions: an offset is the same everywhere",
            },
        ]
    }

    fn smooth_force(&self, p: Parameters<'_>, _m: &Motion<'_>, out: &mut Smooth<'_>) {
        add_to(out.force, p.get(0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn the_force_does_not_depend_on_the_motion() {
        for velocity in [-1.0, 0.0, 1.0] {
            assert_eq!(smooth(&Offset, &[-3.0], Point::at(0.2, velocity)), (-3.0, 0.0));
        }
    }
}
