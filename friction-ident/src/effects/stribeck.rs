//! The Stribeck effect: more friction at low speed, where the lubricant film has not formed yet.

mod free;

pub(crate) use free::KNOT_SPEEDS;

use super::{About, Apart, Before, Begin, CLaw, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;
use crate::simd::{exp, ln, vectorised};

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
static FORMS: [&dyn Effect; 3] = [&GAUSSIAN, &EXPONENTIAL, &free::Free];

const HEIGHT: Parameter = Parameter::level(
    "dF",
    "extra level at rest (static minus Coulomb friction)",
    Quantity::Force,
    200.0,
    4.0,
);
const SPEED: Parameter =
    Parameter::shape("v_s", "Stribeck velocity", Quantity::Velocity, (1e-6, 100.0), 2e-3);
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

    fn fades_with_speed(&self) -> bool {
        true
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("stribeck:free")
    }

    /// At this hump, which ends at the top speed: Coulomb friction takes over what is left of it there.
    fn begins_flexible(&self, before: &Before<'_>) -> Begin {
        let value = |name: &str| (before.value)(name);
        let height = value("dF").unwrap_or(0.0);
        let (speed, exponent) = (value("v_s").unwrap_or(1e-3), value("delta").unwrap_or(1.0));
        let law = |v: f64| height * self.0.of_ratio(v / speed, exponent);
        let end = law(before.top_speed);
        let knots = KNOT_SPEEDS.iter().enumerate();
        let values =
            knots.map(|(k, share)| (format!("c_{k}"), law(share * before.top_speed) - end));
        Begin { values: values.collect(), level: end }
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(match self.0 {
            Form::Rational => CLaw {
                level: "level += {dF} * bond * ({v_s} * {v_s}) / ({v_s} * {v_s} + w * w);",
                hump: "({v_s} * {v_s}) / ({v_s} * {v_s} + w * w)",
                ..CLaw::NONE
            },
            Form::Gaussian => CLaw {
                level: "level += {dF} * bond * exp(-(w / {v_s}) * (w / {v_s}));",
                hump: "exp(-(w / {v_s}) * (w / {v_s}))",
                ..CLaw::NONE
            },
            Form::Exponential => CLaw {
                level: "level += {dF} * bond * exp(-pow(fabs(w / {v_s}), {delta}));",
                hump: "exp(-pow(fabs(w / {v_s}), {delta}))",
                ..CLaw::NONE
            },
        })
    }

    fn told_apart(&self) -> &'static [Apart] {
        if self.0 != Form::Rational {
            return &[];
        }
        &[
            Apart {
                from: &["presliding"],
                experiment: "reverse within 5 to 50 µm at several rates (only presliding is independent of rate), and creep \
                             at constant speeds from 0.05 to 5 mm/s without reversals",
            },
            Apart {
                from: &["frictional-memory", "rising-static-friction"],
                experiment: "rest for 0.1 to 100 s before breaking away, and cross the low speeds both slowly and fast",
            },
        ]
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if self.0 == Form::Rational { &FORMS } else { &[] }
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        match self.0 {
            Form::Rational => rational(p.get(0), p.get(1), m.level_velocity, m.bond, level),
            Form::Gaussian => gaussian(p.get(0), p.get(1), m.level_velocity, m.bond, level),
            Form::Exponential => {
                exponential(p.get(0), p.get(1), p.get(2), m.level_velocity, m.bond, level);
            }
        }
    }

    fn hump(&self, p: Parameters<'_>, level_velocity: &[f64], share: &mut [f64]) -> bool {
        match self.0 {
            Form::Rational => rational_share(p.get(1), level_velocity, share),
            Form::Gaussian => gaussian_share(p.get(1), level_velocity, share),
            Form::Exponential => exponential_share(p.get(1), p.get(2), level_velocity, share),
        }
        true
    }
}

impl Form {
    /// Share of the hump that is left at a speed in Stribeck velocities.
    fn of_ratio(self, u: f64, exponent: f64) -> f64 {
        match self {
            Self::Rational => 1.0 / (1.0 + u * u),
            Self::Gaussian => gaussian_of(u),
            Self::Exponential => exponential_of(u, exponent),
        }
    }
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn gaussian_of(u: f64) -> f64 {
    exp(-u * u)
}

/// `exp(-|u|^delta)`.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn exponential_of(u: f64, exponent: f64) -> f64 {
    // At rest the power is 0 to rounding.
    let size = u.abs();
    let size = if size < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { size };
    exp(-exp(exponent * ln(size)))
}

vectorised! {
    fn gaussian_share(speed: &[f64], velocity: &[f64], share: &mut [f64]) {
        for ((share, speed), velocity) in share.iter_mut().zip(speed).zip(velocity) {
            *share = gaussian_of(velocity / speed);
        }
    }

    fn gaussian(height: &[f64], speed: &[f64], velocity: &[f64], bond: &[f64], level: &mut [f64]) {
        let n = level.len();
        let (height, speed) = (&height[..n], &speed[..n]);
        let (velocity, bond) = (&velocity[..n], &bond[..n]);
        for i in 0..n {
            level[i] += height[i] * bond[i] * gaussian_of(velocity[i] / speed[i]);
        }
    }

    fn exponential_share(speed: &[f64], exponent: &[f64], velocity: &[f64], share: &mut [f64]) {
        let n = share.len();
        let (speed, exponent, velocity) = (&speed[..n], &exponent[..n], &velocity[..n]);
        for i in 0..n {
            share[i] = exponential_of(velocity[i] / speed[i], exponent[i]);
        }
    }

    fn exponential(
        height: &[f64],
        speed: &[f64],
        exponent: &[f64],
        velocity: &[f64],
        bond: &[f64],
        level: &mut [f64],
    ) {
        let n = level.len();
        let (height, speed, exponent) = (&height[..n], &speed[..n], &exponent[..n]);
        let (velocity, bond) = (&velocity[..n], &bond[..n]);
        for i in 0..n {
            level[i] += height[i] * bond[i] * exponential_of(velocity[i] / speed[i], exponent[i]);
        }
    }

    fn rational_share(speed: &[f64], velocity: &[f64], share: &mut [f64]) {
        for ((share, speed), velocity) in share.iter_mut().zip(speed).zip(velocity) {
            let square = speed * speed;
            *share = square / (square + velocity * velocity);
        }
    }

    fn rational(height: &[f64], speed: &[f64], velocity: &[f64], bond: &[f64], level: &mut [f64]) {
        let n = level.len();
        let (height, speed) = (&height[..n], &speed[..n]);
        let (velocity, bond) = (&velocity[..n], &bond[..n]);
        for i in 0..n {
            // 1 / (1 + (v/v_s)^2) with one division.
            let square = speed[i] * speed[i];
            level[i] += height[i] * bond[i] * square / (square + velocity[i] * velocity[i]);
        }
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
