//! Viscous friction that saturates: the lubricant thins under shear.

use super::as_found::AT_END;
use super::{About, AsFound, CLaw, Effect, Motion, Parameter, Parameters, Refused, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{ln, power, tanh, vectorised};

/// How the friction saturates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Law {
    /// At once, as the lubricant can bear no more: `tanh(v / v_n)`.
    Limit,
    /// As molecules jump over barriers that shear lowers (Eyring): `asinh(v / v_n)`.
    Eyring,
    /// Little by little, as its molecules align (fluid of Cross): `u / (1 + |u|^m)` of `u = v / v_n`.
    Cross,
}

/// `dF tanh(v / v_n)`: viscous with `dF / v_n` at low speed, limited by the shear stress that the
/// lubricant can bear at high speed; the form of Cross comes there more slowly.
#[derive(Clone, Copy, Debug)]
pub struct ShearThinning(Law);

/// The default form.
pub static SHEAR_THINNING: ShearThinning = ShearThinning(Law::Limit);
static EYRING: ShearThinning = ShearThinning(Law::Eyring);
static CROSS: ShearThinning = ShearThinning(Law::Cross);
static FORMS: [&dyn Effect; 2] = [&EYRING, &CROSS];

const LIMIT: Parameter = Parameter::level("dF", "limit at high speed", Quantity::Force, 200.0, 4.0);
const THINS: Parameter = Parameter::shape(
    "v_n",
    "speed at which the lubricant thins",
    Quantity::Velocity,
    (1e-4, 100.0),
    1e-2,
);
/// From a power of the speed (below 1) to one that falls again (2: eddy currents).
const EXPONENT: Parameter =
    Parameter::shape("m", "exponent of the thinning", Quantity::One, (0.2, 2.5), 1.0).linear();
const SHOWS: &str = "(residual x sign of velocity) against speed: too little friction at low speed, the same for \
                     speeding up and slowing down; the reverse of the Stribeck hump";

static ABOUT: About = About {
    name: "shear-thinning",
    title: "viscous friction that saturates (shear thinning)",
    equation: "dF tanh(v/v_n)",
    parameters: &[LIMIT, THINS],
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "B. Gecim, W. O. Winer, J. Lubrication Technology 102, 1980 (limiting shear stress)",
};

static EYRING_ABOUT: About = About {
    name: "shear-thinning:eyring",
    title: "viscous friction that rises with the logarithm of the speed (shear thinning)",
    equation: "dF asinh(v/v_n)",
    parameters: &[
        Parameter::level("dF", "rise as the speed grows by e", Quantity::Force, 200.0, 4.0),
        THINS,
    ],
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "H. Eyring, J. Chem. Phys. 4, 1936; S. Bair, High Pressure Rheology, 2007",
};

static CROSS_ABOUT: About = About {
    name: "shear-thinning:cross",
    title: "viscous friction that thins slowly (shear thinning)",
    equation: "dF u/(1 + |u|^m), u = v/v_n",
    parameters: &[
        Parameter::level("dF", "twice what it is at v_n", Quantity::Force, 200.0, 4.0),
        THINS,
        EXPONENT,
    ],
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "M. M. Cross, J. Colloid Science 20, 1965; m = 2: J. H. Wouterse, IEE Proc. B 138, 1991 (eddy currents)",
};

impl Effect for ShearThinning {
    fn about(&self) -> &'static About {
        match self.0 {
            Law::Limit => &ABOUT,
            Law::Eyring => &EYRING_ABOUT,
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

    /// A power of the speed has no speed of its own.
    fn whatever(&self) -> &'static [&'static str] {
        if self.0 == Law::Cross { &[THINS.name] } else { &[] }
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
            Law::Eyring => CLaw {
                smooth: "force += {dF} * asinh(v / {v_n});",
                damping: "damping += {dF} / sqrt({v_n} * {v_n} + v * v);",
                ..CLaw::NONE
            },
            Law::Cross => CLaw {
                smooth: "force += {dF} * v / {v_n} / (1.0 + pow(fabs(v) / {v_n}, {m}));",
                damping: "{
    const double thins = pow(fabs(v) / {v_n}, {m});
    damping += {dF} / {v_n} * (1.0 + (1.0 - {m}) * thins) / ((1.0 + thins) * (1.0 + thins));
}",
                ..CLaw::NONE
            },
        })
    }

    /// What is thin at any speed is a friction level, smoothed where the axis reverses.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let meaning = "it thins at the lowest speed of its search: a friction level";
        found.at_least((1, "v_n"), AT_END, meaning)
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        match self.0 {
            Law::Limit => limited(p.get(0), p.get(1), m.velocity, out.force, out.damping),
            Law::Eyring => eyring(p.get(0), p.get(1), m.velocity, out.force, out.damping),
            Law::Cross => cross(p.get(0), p.get(1), p.get(2), m.velocity, out.force, out.damping),
        }
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

    fn eyring(rise: &[f64], speed: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (rise, speed) = (&rise[..n], &speed[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let per_speed = 1.0 / speed[i];
            let u = velocity[i] * per_speed;
            let root = (1.0 + u * u).sqrt();
            // asinh, odd to the last digit.
            force[i] += rise[i] * ln(u.abs() + root).copysign(u);
            slope[i] += rise[i] * per_speed / root;
        }
    }

    fn cross(limit: &[f64], speed: &[f64], exponent: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (limit, speed, exponent) = (&limit[..n], &speed[..n], &exponent[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            let per_speed = 1.0 / speed[i];
            let u = velocity[i] * per_speed;
            let thins = power(u.abs(), exponent[i]);
            let part = 1.0 / (1.0 + thins);
            force[i] += limit[i] * u * part;
            slope[i] += limit[i] * per_speed * part * part * (1.0 + (1.0 - exponent[i]) * thins);
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
        let p = [4.0, 0.01, 1.0];
        let (force, damping) = smooth(&CROSS, &p, Point::at(0.0, 1e-6));
        assert!((force - 4e-4).abs() < 1e-7 && (damping - 400.0).abs() < 0.1);
        let (force, damping) = smooth(&CROSS, &p, Point::at(0.0, -0.01));
        assert!((force + 2.0).abs() < 1e-12 && (damping - 100.0).abs() < 1e-9);
    }

    #[test]
    fn it_rises_with_the_logarithm_of_the_speed() {
        let at = |v: f64| smooth(&EYRING, &[0.5, 0.01], Point::at(0.0, v));
        assert!((at(1e-6).0 - 5e-5).abs() < 1e-9 && (at(1e-6).1 - 50.0).abs() < 1e-4);
        assert!((at(20.0).0 - at(10.0).0 - 0.5 * 2f64.ln()).abs() < 1e-6);
        for v in [-0.2, -0.01, 0.003, 0.4] {
            assert!((at(v).0 + at(-v).0).abs() < 1e-15);
            let slope = (at(v + 1e-7).0 - at(v - 1e-7).0) / 2e-7;
            assert!((slope - at(v).1).abs() < 1e-6 * slope, "{v}");
        }
    }

    #[test]
    fn it_thins_as_a_power_of_the_speed_or_falls_again() {
        let at = |m: f64, v: f64| smooth(&CROSS, &[4.0, 0.01, m], Point::at(0.0, v));
        // Far beyond v_n a power 1 - m of the speed is left.
        let (near, far) = (at(0.4, 100.0).0, at(0.4, 200.0).0);
        assert!((far / near - 2f64.powf(0.6)).abs() < 0.02, "{}", far / near);
        // Eddy currents: most at v_n, 1/v beyond.
        assert!(at(2.0, 0.01).1.abs() < 1e-9);
        assert!((at(2.0, 1.0).0 - 0.04).abs() < 1e-4);
        for (m, v) in [(0.4, 0.003), (0.4, -0.2), (1.7, 0.02), (2.5, -0.5)] {
            let (below, above) = (at(m, v - 1e-7).0, at(m, v + 1e-7).0);
            let slope = at(m, v).1;
            assert!(((above - below) / 2e-7 - slope).abs() < 1e-4 * (1.0 + slope.abs()), "{m} {v}");
        }
        assert_eq!(at(0.4, 0.0).0, 0.0);
    }
}
