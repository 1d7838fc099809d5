//! Friction that varies along the stroke: straightness, preload, wear.

use super::about::STROKE;
use super::c_law::profile;
use super::cosines;
use super::{About, Apart, CLaw, Effect, Motion, Parameter, Parameters, Slot};
use crate::axis::Quantity;

/// `level += sum_k c_k cos(k pi u)` over the stroke, `u` from 0 to 1: smooth, without a mean, so that
/// it does not compete with `coulomb`.
///
/// Cosines are level at both ends. The fine form adds two polynomials, also without a mean, that take the
/// slopes at the ends, so that what is left to the cosines falls off with the fourth power of `k`.
#[derive(Clone, Copy, Debug)]
pub struct PositionFriction<const COSINES: usize>;

const MAIN: usize = 6;
const DETAILED: usize = 20;
/// The default form: a sixth of the stroke is the shortest half wave.
pub static POSITION_FRICTION: PositionFriction<MAIN> = PositionFriction;
static FINE: PositionFriction<DETAILED> = PositionFriction;
static FORMS: [&dyn Effect; 1] = [&FINE];

const NAMES: [&str; DETAILED] = [
    "c_1", "c_2", "c_3", "c_4", "c_5", "c_6", "c_7", "c_8", "c_9", "c_10", "c_11", "c_12", "c_13",
    "c_14", "c_15", "c_16", "c_17", "c_18", "c_19", "c_20",
];

const fn amplitude(name: &'static str, meaning: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, meaning, Quantity::Force, 100.0, default)
}

/// The amplitudes of the cosines, then `last`.
const fn parameters<const LAST: usize, const ALL: usize>(
    last: [Parameter; LAST],
) -> [Parameter; ALL] {
    let mut parameters = [last[0]; ALL];
    let mut k = 0;
    while k < ALL {
        parameters[k] = if k + LAST < ALL {
            amplitude(NAMES[k], "amplitude of cos(k pi u)", if k == 0 { 1.0 } else { 0.0 })
        } else {
            last[k + LAST - ALL]
        };
        k += 1;
    }
    parameters
}

const START: Parameter = STROKE[0];
const END: Parameter = STROKE[1];
const SHOWS: &str = "(residual x sign of velocity) against position";
const REFERENCE: &str =
    "M. R. Popovic, A. A. Goldenberg, IEEE Trans. Robotics and Automation 14, 1998";

static ABOUT: About = About {
    name: "position-friction",
    title: "friction along the stroke",
    equation: "sum_{k=1..6} c_k cos(k pi u) s, u = (x - start)/(end - start) within 0..1",
    parameters: &parameters::<2, { MAIN + 2 }>([START, END]),
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: REFERENCE,
};
static FINE_ABOUT: About = About {
    name: "position-friction:fine",
    title: "friction along the stroke, in detail",
    equation: "(sum_{k=1..20} c_k cos(k pi u) + p_1 (u - 1/2) + p_2 (u^2 - u + 1/6)) s, \
               u = (x - start)/(end - start) within 0..1",
    parameters: &parameters::<4, { DETAILED + 4 }>([
        START,
        END,
        amplitude("p_1", "mean slope along the stroke", 0.0),
        amplitude("p_2", "bend along the stroke", 0.0),
    ]),
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: REFERENCE,
};

impl<const COSINES: usize> Effect for PositionFriction<COSINES> {
    fn about(&self) -> &'static About {
        if COSINES == MAIN { &ABOUT } else { &FINE_ABOUT }
    }

    fn flexible_form(&self) -> Option<&'static str> {
        (COSINES == MAIN).then_some("position-friction:fine")
    }

    /// In detail it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        COSINES == DETAILED
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(if COSINES == MAIN {
            CLaw {
                level: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "level += sum;"),
                ..CLaw::NONE
            }
        } else {
            CLaw {
                level: profile!(
                    "20",
                    "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}, {c_7}, {c_8}, {c_9}, {c_10},
        {c_11}, {c_12}, {c_13}, {c_14}, {c_15}, {c_16}, {c_17}, {c_18}, {c_19}, {c_20}",
                    "level += sum + {p_1} * (u - 0.5) + {p_2} * (u * u - u + 1.0 / 6.0);"
                ),
                ..CLaw::NONE
            }
        })
    }

    fn told_apart(&self) -> &'static [Apart] {
        if COSINES != MAIN {
            return &[];
        }
        &[Apart {
            from: &["load-friction"],
            experiment: "cover the whole stroke in both directions with two different loads, or at two accelerations: what \
                         depends on the position stays where it is",
        }]
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        if COSINES == MAIN { &FORMS } else { &[] }
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        if COSINES == DETAILED {
            cosines::add_with_slopes(p, COSINES, m.position, level);
        } else {
            cosines::add(p, COSINES, m.position, level);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level};
    use super::*;
    use std::f64::consts::PI;

    /// A stroke from -0.1 to 0.3 m.
    fn fine() -> Vec<f64> {
        let mut p: Vec<f64> = (1..=DETAILED).map(|k| (k as f64).sin() / k as f64).collect();
        p.extend([-0.1, 0.3, 0.7, -2.0]);
        p
    }

    #[test]
    fn it_is_the_sum_of_cosines_over_the_stroke() {
        let p = [1.0, -0.5, 0.3, 0.2, -0.1, 0.05, -0.1, 0.3];
        for x in [-0.1, 0.0, 0.13, 0.3] {
            let u = (x + 0.1) / 0.4;
            let exact = |p: &[f64], cosines: usize| -> f64 {
                (1..=cosines).map(|k| p[k - 1] * (k as f64 * PI * u).cos()).sum()
            };
            let main = level(&POSITION_FRICTION, &p, Point::at(x, 0.1));
            assert!((main - exact(&p, MAIN)).abs() < 1e-12);
            let p = fine();
            let polynomials = 0.7 * (u - 0.5) - 2.0 * (u * u - u + 1.0 / 6.0);
            let found = level(&FINE, &p, Point::at(x, 0.1));
            assert!((found - exact(&p, DETAILED) - polynomials).abs() < 1e-12);
        }
    }

    #[test]
    fn beyond_the_stroke_it_keeps_the_value_of_the_end() {
        let p = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3];
        assert_eq!(level(&POSITION_FRICTION, &p, Point::at(0.5, 0.1)), -1.0);
        assert_eq!(level(&POSITION_FRICTION, &p, Point::at(-0.5, 0.1)), 1.0);
    }

    #[test]
    fn its_mean_over_the_stroke_is_zero() {
        let main = [1.0, -0.5, 0.3, 0.2, -0.1, 0.05, -0.1, 0.3];
        let forms: [(&dyn Effect, &[f64]); 2] = [(&POSITION_FRICTION, &main), (&FINE, &fine())];
        for (form, p) in forms {
            let points = 10_000;
            let sum: f64 = (0..points)
                .map(|k| 0.4 * (f64::from(k) + 0.5) / f64::from(points) - 0.1)
                .map(|x| level(form, p, Point::at(x, 0.1)))
                .sum();
            assert!((sum / f64::from(points)).abs() < 1e-8);
        }
    }
}
