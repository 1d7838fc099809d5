//! Viscous friction that saturates: the lubricant thins under shear.

use super::{About, AsFound, CLaw, Effect, Motion, Parameter, Parameters, Refused, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{tanh, vectorised};

/// `dF tanh(v / v_n)`: viscous with `dF / v_n` at low speed, limited by the shear stress that the
/// lubricant can bear at high speed.
#[derive(Clone, Copy, Debug)]
pub struct ShearThinning;

/// A speed below this multiple of the least one is at it.
const AT_ONCE: f64 = 1.001;

static ABOUT: About = About {
    name: "shear-thinning",
    title: "viscous friction that saturates (shear thinning)",
    equation: "dF tanh(v/v_n)",
    parameters: &[
        Parameter::level("dF", "limit at high speed", Quantity::Force, 200.0, 4.0),
        Parameter::shape(
            "v_n",
            "speed at which the lubricant thins",
            Quantity::Velocity,
            (1e-4, 0.3),
            1e-2,
        ),
    ],
    slots: &[Slot::SmoothForce],
    shows: "(residual x sign of velocity) against speed: too little friction at low speed, the same for \
            speeding up and slowing down; the reverse of the Stribeck hump",
    reference: "B. Gecim, W. O. Winer, J. Lubrication Technology 102, 1980 (limiting shear stress)",
};

impl Effect for ShearThinning {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// Of a friction level that sets in with the speed instead of at rest.
    fn law_of(&self) -> Option<&'static str> {
        Some("coulomb")
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "force += {dF} * tanh(v / {v_n});",
            damping: "{
    const double part = tanh(v / {v_n});
    damping += {dF} * (1.0 - part * part) / {v_n};
}",
            ..CLaw::NONE
        })
    }

    /// What is thin at any speed is a friction level, smoothed where the axis reverses.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let meaning = "it thins at the lowest speed of its search: a friction level";
        found.at_least((1, "v_n"), AT_ONCE, meaning)
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        thin(p.get(0), p.get(1), m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn thin(limit: &[f64], speed: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (limit, speed) = (&limit[..n], &speed[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let per_speed = 1.0 / speed[i];
            let part = tanh(velocity[i] * per_speed);
            force[i] += limit[i] * part;
            slope[i] += limit[i] * (1.0 - part * part) * per_speed;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn it_is_viscous_at_low_speed_and_constant_at_high_speed() {
        let p = [4.0, 0.01];
        let (force, damping) = smooth(&ShearThinning, &p, Point::at(0.0, 1e-6));
        assert!((force - 4e-4).abs() < 1e-9 && (damping - 400.0).abs() < 1e-4);
        let (force, damping) = smooth(&ShearThinning, &p, Point::at(0.0, -0.5));
        assert!((force + 4.0).abs() < 1e-9 && damping.abs() < 1e-9);
    }
}
