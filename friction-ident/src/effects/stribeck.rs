//! The Stribeck effect: more friction at low speed, where the lubricant film has not formed yet.

use super::{About, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;

/// The shape of the hump over speed, 1 at rest and 0 at high speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// `1 / (1 + (v / v_s)^2)`.
    Rational,
    /// `exp(-(v / v_s)^2)`.
    Gaussian,
    /// `exp(-|v / v_s|^delta)`.
    Exponential,
}

/// An extra friction level at low speed; the forms differ in how it fades.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck(Form);

/// The default form, rational.
pub static STRIBECK: Stribeck = Stribeck(Form::Rational);
static GAUSSIAN: Stribeck = Stribeck(Form::Gaussian);
static EXPONENTIAL: Stribeck = Stribeck(Form::Exponential);
static FORMS: [&dyn Effect; 2] = [&GAUSSIAN, &EXPONENTIAL];

const HEIGHT: Parameter = Parameter::level(
    "dF",
    "extra level at rest (static minus Coulomb friction)",
    Quantity::Force,
    200.0,
    4.0,
);
const SPEED: Parameter =
    Parameter::shape("v_s", "Stribeck velocity", Quantity::Velocity, (1e-6, 0.05), 2e-3);
const EXPONENT: Parameter =
    Parameter::shape("delta", "exponent", Quantity::One, (0.3, 3.0), 1.0).linear();

const SHOWS: &str = "(residual x sign of velocity) against log speed: a hump at low speed, the same for \
                     speeding up and slowing down";

static RATIONAL_ABOUT: About = About {
    name: "stribeck",
    title: "Stribeck effect",
    equation: "dF / (1 + (v/v_s)^2) s",
    parameters: &[HEIGHT, SPEED],
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: "D. P. Hess, A. Soom, J. Tribology 112, 1990",
};
static GAUSSIAN_ABOUT: About = About {
    name: "stribeck:gaussian",
    title: "Stribeck effect, Gaussian",
    equation: "dF exp(-(v/v_s)^2) s",
    parameters: &[HEIGHT, SPEED],
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: "B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991",
};
static EXPONENTIAL_ABOUT: About = About {
    name: "stribeck:exponential",
    title: "Stribeck effect, exponential",
    equation: "dF exp(-|v/v_s|^delta) s",
    parameters: &[HEIGHT, SPEED, EXPONENT],
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: "L. C. Bo, D. Pavelescu, Wear 82, 1982",
};

impl Effect for Stribeck {
    fn about(&self) -> &'static About {
        match self.0 {
            Form::Rational => &RATIONAL_ABOUT,
            Form::Gaussian => &GAUSSIAN_ABOUT,
            Form::Exponential => &EXPONENTIAL_ABOUT,
        }
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if self.0 == Form::Rational { &FORMS } else { &[] }
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        match self.0 {
            Form::Rational => hump(p, m, level, |_, u| 1.0 / (1.0 + u * u)),
            Form::Gaussian => hump(p, m, level, |_, u| (-u * u).exp()),
            Form::Exponential => {
                let delta = p.get(2);
                hump(p, m, level, |i, u| (-u.abs().powf(delta[i])).exp());
            }
        }
    }
}

#[inline]
fn hump(p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64], shape: impl Fn(usize, f64) -> f64) {
    let lanes = level.len();
    let (height, speed) = (&p.get(0)[..lanes], &p.get(1)[..lanes]);
    let (velocity, bond) = (&m.level_velocity[..lanes], &m.bond[..lanes]);
    for i in 0..lanes {
        level[i] += height[i] * bond[i] * shape(i, velocity[i] / speed[i]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;

    #[test]
    fn the_hump_is_full_at_rest_and_gone_at_speed() {
        for form in [&STRIBECK, &GAUSSIAN, &EXPONENTIAL] {
            let p = [5.0, 1e-3, 1.5];
            let p = &p[..form.about().parameters.len()];
            assert_eq!(level(form, p, Point::at(0.0, 0.0)), 5.0);
            assert!(level(form, p, Point::at(0.0, 0.1)) < 1e-3);
            let forth = level(form, p, Point::at(0.0, 7e-4));
            assert_eq!(forth, level(form, p, Point::at(0.0, -7e-4)));
        }
    }

    #[test]
    fn at_the_stribeck_velocity_half_is_left_of_the_rational_hump() {
        assert_eq!(level(&STRIBECK, &[5.0, 1e-3], Point::at(0.0, -1e-3)), 2.5);
        let gaussian = level(&GAUSSIAN, &[5.0, 1e-3], Point::at(0.0, 1e-3));
        assert!((gaussian - 5.0 * (-1.0f64).exp()).abs() < 1e-12);
    }

    #[test]
    fn it_follows_the_remembered_velocity_and_the_bond() {
        let point = Point { level_velocity: 0.0, bond: 0.5, ..Point::at(0.0, 0.1) };
        assert_eq!(level(&STRIBECK, &[5.0, 1e-3], point), 2.5);
    }
}
