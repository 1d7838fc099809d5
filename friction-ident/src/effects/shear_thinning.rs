//! Viscous friction that saturates: the lubricant thins under shear.

use super::{About, AsFound, CLaw, Effect, Motion, Parameter, Parameters, Refused, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{tanh, vectorised};

/// How the friction saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Law {
    /// At once, as the lubricant can bear no more: `tanh(v / v_n)`.
    Limit,
    /// Little by little, as its molecules align (fluid of Cross): `v / (v_n + |v|)`.
    Cross,
}

/// `dF tanh(v / v_n)`: viscous with `dF / v_n` at low speed, limited by the shear stress that the
/// lubricant can bear at high speed; the form of Cross comes there more slowly.
#[derive(Clone, Copy, Debug)]
pub struct ShearThinning(Law);

/// The default form.
pub static SHEAR_THINNING: ShearThinning = ShearThinning(Law::Limit);
static CROSS: ShearThinning = ShearThinning(Law::Cross);
static FORMS: [&dyn Effect; 1] = [&CROSS];

/// A speed below this multiple of the least one is at it.
const AT_ONCE: f64 = 1.001;

const PARAMETERS: [Parameter; 2] = [
    Parameter::level("dF", "limit at high speed", Quantity::Force, 200.0, 4.0),
    Parameter::shape(
        "v_n",
        "speed at which the lubricant thins",
        Quantity::Velocity,
        (1e-4, 0.3),
        1e-2,
    ),
];
const SHOWS: &str = "(residual x sign of velocity) against speed: too little friction at low speed, the same for \
                     speeding up and slowing down; the reverse of the Stribeck hump";

static ABOUT: About = About {
    name: "shear-thinning",
    title: "viscous friction that saturates (shear thinning)",
    equation: "dF tanh(v/v_n)",
    parameters: &PARAMETERS,
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "B. Gecim, W. O. Winer, J. Lubrication Technology 102, 1980 (limiting shear stress)",
};

static CROSS_ABOUT: About = About {
    name: "shear-thinning:cross",
    title: "viscous friction that saturates slowly (shear thinning)",
    equation: "dF v/(v_n + |v|)",
    parameters: &PARAMETERS,
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "M. M. Cross, J. Colloid Science 20, 1965",
};

impl Effect for ShearThinning {
    fn about(&self) -> &'static About {
        match self.0 {
            Law::Limit => &ABOUT,
            Law::Cross => &CROSS_ABOUT,
        }
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if self.0 == Law::Limit { &FORMS } else { &[] }
    }

    fn flexible_form(&self) -> Option<&'static str> {
        (self.0 == Law::Limit).then_some("shear-thinning:cross")
    }

    /// What comes there little by little sets in early, as a friction level does.
    fn is_only_flexible(&self) -> bool {
        self.0 == Law::Cross
    }

    /// Of a friction level that sets in with the speed instead of at rest.
    fn law_of(&self) -> Option<&'static str> {
        Some("coulomb")
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(match self.0 {
            Law::Limit => CLaw {
                smooth: "force += {dF} * tanh(v / {v_n});",
                damping: "{
    const double part = tanh(v / {v_n});
    damping += {dF} * (1.0 - part * part) / {v_n};
}",
                ..CLaw::NONE
            },
            Law::Cross => CLaw {
                smooth: "force += {dF} * v / ({v_n} + fabs(v));",
                damping: "{
    const double sum = {v_n} + fabs(v);
    damping += {dF} * {v_n} / (sum * sum);
}",
                ..CLaw::NONE
            },
        })
    }

    /// What is thin at any speed is a friction level, smoothed where the axis reverses.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let meaning = "it thins at the lowest speed of its search: a friction level";
        found.at_least((1, "v_n"), AT_ONCE, meaning)
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let law = if self.0 == Law::Limit { limited } else { cross };
        law(p.get(0), p.get(1), m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn limited(limit: &[f64], speed: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
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

    fn cross(limit: &[f64], speed: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (limit, speed) = (&limit[..n], &speed[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let per_sum = 1.0 / (speed[i] + velocity[i].abs());
            force[i] += limit[i] * velocity[i] * per_sum;
            slope[i] += limit[i] * speed[i] * per_sum * per_sum;
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
        let (force, damping) = smooth(&SHEAR_THINNING, &p, Point::at(0.0, 1e-6));
        assert!((force - 4e-4).abs() < 1e-9 && (damping - 400.0).abs() < 1e-4);
        let (force, damping) = smooth(&SHEAR_THINNING, &p, Point::at(0.0, -0.5));
        assert!((force + 4.0).abs() < 1e-9 && damping.abs() < 1e-9);
        // The other form begins alike, and has come half way where this one is at three quarters.
        let (force, damping) = smooth(&CROSS, &p, Point::at(0.0, 1e-6));
        assert!((force - 4e-4).abs() < 1e-7 && (damping - 400.0).abs() < 0.1);
        let (force, damping) = smooth(&CROSS, &p, Point::at(0.0, -0.01));
        assert!((force + 2.0).abs() < 1e-12 && (damping - 100.0).abs() < 1e-9);
    }
}
