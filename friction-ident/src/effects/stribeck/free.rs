//! A friction curve of any shape over speed.

use super::super::Extent;
use super::super::{AsFound, Refused};
use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Quantity, SHOWS, Slot};
use crate::simd::{ln, vectorised};

/// Number of knots with a value of their own; the last of all has none.
const FREE: usize = 9;
/// `v_0` in units of the top speed: below it the curve is linear in the speed, above in its logarithm.
const CORNER: f64 = 2e-3;
/// `asinh(v_k/v_0)` at `v_k` = 0, 0.001, 0.003, 0.008, 0.016, 0.03, 0.06, 0.12, 0.3, 1 times the top speed.
const KNOTS: [f64; FREE + 1] = [
    0.0,
    0.481_211_825_059_603_47,
    1.194_763_217_287_109_4,
    2.094_712_547_261_101_2,
    2.776_472_280_723_717_7,
    3.402_306_645_480_594_6,
    4.094_622_224_330_53,
    4.787_561_179_993_81,
    5.703_793_585_582_131,
    6.907_756_278_980_637,
];
/// Knots with a value of their own, as shares of the top speed.
pub(crate) const KNOT_SPEEDS: [f64; FREE] =
    [0.0, 0.001, 0.003, 0.008, 0.016, 0.03, 0.06, 0.12, 0.3];
/// One over the distances of neighbouring knots.
const SLOPES: [f64; FREE] = {
    let mut slopes = [0.0; FREE];
    let mut k = 0;
    while k < FREE {
        slopes[k] = 1.0 / (KNOTS[k + 1] - KNOTS[k]);
        k += 1;
    }
    slopes
};
/// Speed, in units of `v_0`, from which nothing changes any more: beyond the last knot.
const BEYOND: f64 = 1e3;

/// `sum_k c_k hat_k(|v|)`, piecewise linear in `asinh(|v|/v_0)`: what a Stribeck hump of no known form, a second
/// hump, or a rise with the logarithm of the speed look like. It ends at 0, so that it does not compete with `coulomb`.
#[derive(Clone, Copy, Debug)]
pub struct Free;

const fn value(name: &'static str, default: f64) -> Parameter {
    Parameter::signed(
        name,
        "level at knot k beyond that at v_high",
        Quantity::Force,
        200.0,
        default,
    )
}

static ABOUT: About = About {
    name: "stribeck:free",
    title: "Stribeck effect, free curve",
    equation: "sum_{k=0..8} c_k hat_k(|v|) s, linear in asinh(|v|/(0.002 v_high)) between 0, 0.001, 0.003, 0.008, \
               0.016, 0.03, 0.06, 0.12, 0.3 and 1 times v_high, 0 from there on",
    parameters: &[
        value("c_0", 4.0),
        value("c_1", 4.0),
        value("c_2", 4.0),
        value("c_3", 3.8),
        value("c_4", 3.4),
        value("c_5", 2.6),
        value("c_6", 1.2),
        value("c_7", 0.4),
        value("c_8", 0.1),
        Parameter::fixed(
            "v_high",
            "speed at which the curve ends",
            Quantity::Velocity,
            (1e-6, 100.0),
            0.05,
        )
        .taken_from(Extent::TopSpeed),
    ],
    slots: &[Slot::FrictionLevel],
    shows: SHOWS,
    reference: "R. Stribeck, Zeitschrift des VDI 46, 1902 (measured curves)",
};

/// How far `w` has gone, 0..1, from a knot of the free curve to the next one.
macro_rules! gone {
    ($from:literal, $to:literal) => {
        concat!(
            "fmin(fmax((asinh(fabs(w) / (0.002 * {v_high})) - ",
            $from,
            ") / (",
            $to,
            " - ",
            $from,
            "), 0.0), 1.0)"
        )
    };
}

/// What the free curve has at `w` of what it has at rest, where that is a hump.
const FREE_SHARE: &str = concat!(
    "{c_0} > 0.0 ? fmin(fmax((",
    "{c_0} * (1.0 - ",
    gone!("0.0", "0.48121182505960347"),
    ") + {c_1} * (",
    gone!("0.0", "0.48121182505960347"),
    " - ",
    gone!("0.48121182505960347", "1.1947632172871094"),
    ") + {c_2} * (",
    gone!("0.48121182505960347", "1.1947632172871094"),
    " - ",
    gone!("1.1947632172871094", "2.0947125472611012"),
    ") + {c_3} * (",
    gone!("1.1947632172871094", "2.0947125472611012"),
    " - ",
    gone!("2.0947125472611012", "2.7764722807237177"),
    ") + {c_4} * (",
    gone!("2.0947125472611012", "2.7764722807237177"),
    " - ",
    gone!("2.7764722807237177", "3.4023066454805946"),
    ") + {c_5} * (",
    gone!("2.7764722807237177", "3.4023066454805946"),
    " - ",
    gone!("3.4023066454805946", "4.09462222433053"),
    ") + {c_6} * (",
    gone!("3.4023066454805946", "4.09462222433053"),
    " - ",
    gone!("4.09462222433053", "4.78756117999381"),
    ") + {c_7} * (",
    gone!("4.09462222433053", "4.78756117999381"),
    " - ",
    gone!("4.78756117999381", "5.703793585582131"),
    ") + {c_8} * (",
    gone!("4.78756117999381", "5.703793585582131"),
    " - ",
    gone!("5.703793585582131", "6.907756278980637"),
    ")",
    ") / {c_0}, 0.0), 1.0) : 1.0 - ",
    gone!("0.0", "0.48121182505960347")
);

impl Effect for Free {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// Alone it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn fades_with_speed(&self) -> bool {
        true
    }

    /// Of a hump the curve lies below the straight line from rest to the top speed, whatever of it is taken for Coulomb and
    /// viscous friction; above it lies that of a lubricant that thins.
    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let at_rest = found.values[0];
        let line = KNOT_SPEEDS.map(|share| at_rest * (1.0 - share));
        let beyond = found.values.iter().zip(line).map(|(level, line)| level - line);
        let (above, below) = beyond.fold((0.0f64, 0.0f64), |(above, below), beyond| {
            (above.max(beyond), below.max(-beyond))
        });
        (above > below).then_some(Refused {
            name: "bulge",
            value: above,
            limit: below,
            unit_of: "c_0",
            meaning: "it rises fast, then slowly with the speed, as of a lubricant that thins",
        })
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            level: "{
    static const double knots[10] = {0.0, 0.48121182505960347, 1.1947632172871094, 2.0947125472611012,
        2.7764722807237177, 3.4023066454805946, 4.09462222433053, 4.78756117999381,
        5.703793585582131, 6.907756278980637};
    static const double c[9] = {{c_0}, {c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}, {c_7}, {c_8}};
    const double z = asinh(fabs(w) / (0.002 * {v_high}));
    double before = 1.0, sum = 0.0;
    int k;
    for (k = 0; k < 9; k++) {
        const double gone = (z - knots[k]) / (knots[k + 1] - knots[k]);
        const double next = gone < 0.0 ? 0.0 : (gone > 1.0 ? 1.0 : gone);
        sum += c[k] * (before - next);
        before = next;
    }
    level += bond * sum;
}",
            hump: FREE_SHARE,
            ..CLaw::NONE
        })
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        let values = std::array::from_fn(|k| p.get(k));
        curve(values, p.get(FREE), m.level_velocity, m.bond, level);
    }

    /// What the curve has left of its value at rest, where that is a hump.
    fn hump(&self, p: Parameters<'_>, level_velocity: &[f64], share: &mut [f64]) -> bool {
        let values = std::array::from_fn(|k| p.get(k));
        left(values, p.get(FREE), level_velocity, share);
        true
    }
}

/// Weights of the values at a speed.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn hats(velocity: f64, high: f64) -> [f64; FREE] {
    let x = (velocity.abs() / (CORNER * high)).min(BEYOND);
    // asinh x.
    let z = ln(x + (x * x + 1.0).sqrt());
    let (mut hats, mut before) = ([0.0; FREE], 1.0);
    for k in 0..FREE {
        // How far the speed has gone from knot k to the next one. Differences of these are exact at the ends.
        let next = ((z - KNOTS[k]) * SLOPES[k]).clamp(0.0, 1.0);
        hats[k] = before - next;
        before = next;
    }
    hats
}

vectorised! {
    fn left(values: [&[f64]; FREE], high: &[f64], velocity: &[f64], share: &mut [f64]) {
        let n = share.len();
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = values;
        let (c0, c1, c2, c3, c4) = (&c0[..n], &c1[..n], &c2[..n], &c3[..n], &c4[..n]);
        let (c5, c6, c7, c8) = (&c5[..n], &c6[..n], &c7[..n], &c8[..n]);
        let (high, velocity) = (&high[..n], &velocity[..n]);
        for i in 0..n {
            let h = hats(velocity[i], high[i]);
            let low = c0[i] * h[0] + c1[i] * h[1] + c2[i] * h[2] + c3[i] * h[3];
            let top = c4[i] * h[4] + c5[i] * h[5] + c6[i] * h[6] + c7[i] * h[7] + c8[i] * h[8];
            let rests = c0[i] > 0.0;
            let part = (low + top) / if rests { c0[i] } else { 1.0 };
            let part = if part < 0.0 { 0.0 } else { part };
            let part = if part > 1.0 { 1.0 } else { part };
            share[i] = if rests { part } else { h[0] };
        }
    }

    fn curve(values: [&[f64]; FREE], high: &[f64], velocity: &[f64], bond: &[f64], level: &mut [f64]) {
        let n = level.len();
        let [c0, c1, c2, c3, c4, c5, c6, c7, c8] = values;
        let (c0, c1, c2, c3, c4) = (&c0[..n], &c1[..n], &c2[..n], &c3[..n], &c4[..n]);
        let (c5, c6, c7, c8) = (&c5[..n], &c6[..n], &c7[..n], &c8[..n]);
        let (high, velocity, bond) = (&high[..n], &velocity[..n], &bond[..n]);
        for i in 0..n {
            let h = hats(velocity[i], high[i]);
            let low = c0[i] * h[0] + c1[i] * h[1] + c2[i] * h[2] + c3[i] * h[3];
            let top = c4[i] * h[4] + c5[i] * h[5] + c6[i] * h[6] + c7[i] * h[7] + c8[i] * h[8];
            level[i] += bond[i] * (low + top);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{Point, along_and_simulated, level};
    use super::*;

    const VALUES: [f64; FREE + 1] = [5.0, 4.0, -1.0, 2.0, 3.0, 0.5, -0.7, 1.5, 0.3, 0.2];
    const SHARES: [f64; FREE + 1] = [0.0, 1e-3, 3e-3, 8e-3, 0.016, 0.03, 0.06, 0.12, 0.3, 1.0];

    #[test]
    fn it_has_its_values_at_the_knots_and_none_at_the_top_speed_and_beyond() {
        for (k, share) in SHARES.iter().enumerate().take(FREE) {
            for v in [0.2 * share, -0.2 * share] {
                let found = level(&Free, &VALUES, Point::at(0.0, v));
                assert!((found - VALUES[k]).abs() < 1e-12, "{k}: {found}");
            }
        }
        assert!(level(&Free, &VALUES, Point::at(0.0, 0.2)).abs() < 1e-12);
        assert_eq!(level(&Free, &VALUES, Point::at(0.0, -0.21)), 0.0);
        assert_eq!(level(&Free, &VALUES, Point::at(0.0, 3e9)), 0.0);
    }

    #[test]
    fn it_is_linear_in_the_inverse_hyperbolic_sine_between_the_knots() {
        for (k, pair) in SHARES.windows(2).enumerate() {
            let asinh = |share: f64| (share / CORNER).asinh();
            for part in [0.1, 0.5, 0.8] {
                let z = asinh(pair[0]) + part * (asinh(pair[1]) - asinh(pair[0]));
                let v = 0.2 * CORNER * z.sinh();
                let end = if k + 1 < FREE { VALUES[k + 1] } else { 0.0 };
                let exact = VALUES[k] + part * (end - VALUES[k]);
                assert!((level(&Free, &VALUES, Point::at(0.0, v)) - exact).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn it_follows_the_remembered_velocity_and_the_bond() {
        let point = Point { level_velocity: 0.0, bond: 0.5, ..Point::at(0.0, 0.1) };
        assert_eq!(level(&Free, &VALUES, point), 2.5);
        let mut share = [0.0; 3];
        let p = super::super::super::broadcast(&VALUES, 3);
        assert!(Free.hump(Parameters::new(&p, 3), &[0.0, 0.2e-3, 0.6e-3], &mut share));
        assert!((share[1] - 0.8).abs() < 1e-12);
        assert_eq!((share[0], share[2]), (1.0, 0.0));
    }

    #[test]
    fn a_curve_that_rises_fast_and_then_slowly_is_none_whatever_is_taken_for_viscous() {
        // Of 3 N at rest, and of a viscous friction that takes away what it had of 4 N up to the top speed.
        for (hump, viscous) in [(3.0, 0.0), (3.0, 4.0), (-3.0, 0.0), (-3.0, 4.0)] {
            let curve = |share: f64| hump / (1.0 + share / 0.05) - viscous * share;
            let levels = KNOT_SPEEDS.map(|share| curve(share) - curve(1.0));
            let values = [&levels[..], &[0.2]].concat();
            let found = AsFound {
                values: &values,
                least: &[-9.0; FREE + 1],
                most: &[9.0; FREE + 1],
                mass: 1.0,
                force: 1.0,
                count: 1e-6,
                give: 0.0,
            };
            assert_eq!(Free.refused(&found).is_some(), hump < 0.0, "{hump} {viscous}");
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        // Knots that are passed in no less than some ten steps.
        let flat = [("c_0", 3.0), ("c_1", 3.0), ("c_2", 3.0), ("c_3", 3.0)];
        let bent = [("c_4", 3.0), ("c_5", 2.0), ("c_6", -1.0), ("c_7", 0.5), ("v_high", 1.0)];
        let left = along_and_simulated(&[("stribeck:free", &[&flat[..], &bent].concat())], None);
        assert!(left < 0.03, "{left}");
    }
}
