//! Friction that grows with the transmitted load: gears, nuts, preloaded bearings.

use super::{About, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::simd::vectorised;

/// `level += mu |F|` with the force `F` of the drive.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction;

static ABOUT: About = About {
    name: "load-friction",
    title: "load-dependent friction",
    equation: "mu |F| s, F = force of the drive",
    parameters: &[Parameter::level("mu", "share of the load", Quantity::One, 0.9, 0.05)],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against |force| at equal speed; mostly absorbed into mass, viscous and coulomb",
    reference: "A. C. Bittencourt, S. Gunnarsson, J. Dyn. Syst. Meas. Control 134, 2012",
};

impl Effect for LoadFriction {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        load(p.get(0), m.drive_force, level);
    }
}

vectorised! {
    fn load(share: &[f64], force: &[f64], level: &mut [f64]) {
        for ((level, share), force) in level.iter_mut().zip(share).zip(force) {
            *level += share * force.abs();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;

    #[test]
    fn the_level_is_a_share_of_the_load_of_either_sign() {
        for force in [40.0, -40.0] {
            let point = Point { drive_force: force, ..Point::at(0.0, 0.1) };
            assert_eq!(level(&LoadFriction, &[0.05], point), 2.0);
        }
    }
}
