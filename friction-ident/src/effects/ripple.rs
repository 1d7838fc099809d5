//! Force ripple: periodic along the stroke, the same for both directions (screw, cogging).

use super::own::{Own, turned};
use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Periodic, Repeats, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{sin_cos_of_turns, vectorised};

/// Two harmonics of period `l`.
#[derive(Clone, Copy, Debug)]
pub struct Ripple;

/// Six harmonics of period `p`.
#[derive(Clone, Copy, Debug)]
struct Harmonics;

/// One harmonic of period `p` with amplitudes of its own for either direction of motion.
///
/// The mean of both is a force, half of their difference a friction level: at rest the axis holds
/// between the two, and at a reversal the force jumps where it turns and not half a step beside it.
#[derive(Clone, Copy, Debug)]
struct Direction;

static HARMONICS: Harmonics = Harmonics;
static DIRECTION: Direction = Direction;
static FORMS: [&dyn Effect; 2] = [&HARMONICS, &DIRECTION];

/// Harmonics of the finer form.
const COUNT: usize = 6;
const SHOWS: &str = "a line at 1/l in the residual's spectrum over position";
const PERIOD: Parameter =
    Parameter::shape("l", "period: screw lead, pole pitch", Quantity::Length, (2e-4, 20.0), 5e-3);

/// How a ripple repeats.
const PERIODIC: Periodic =
    Periodic { period: "l", of: Repeats::Force, ranked: true, columns: None, shortest: None };

const fn sine(name: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, "sine amplitude of harmonic k", Quantity::Force, 50.0, default)
}

const fn cosine(name: &'static str) -> Parameter {
    Parameter::signed(name, "cosine amplitude of harmonic k", Quantity::Force, 50.0, 0.0)
}

const fn of_direction(name: &'static str, meaning: &'static str, default: f64) -> Parameter {
    Parameter::signed(name, meaning, Quantity::Force, 50.0, default)
}

const A1: &str = "sine amplitude of the period";
const B1: &str = "cosine amplitude of the period";
const A2: &str = "sine amplitude of half the period";
const B2: &str = "cosine amplitude of half the period";

static ABOUT: About = About {
    name: "ripple",
    title: "force ripple along the stroke",
    equation: "sum_{k=1,2} a_k sin(2 pi k x/l) + b_k cos(2 pi k x/l)",
    parameters: &[
        Parameter::signed("a_1", A1, Quantity::Force, 50.0, 1.0),
        Parameter::signed("b_1", B1, Quantity::Force, 50.0, 0.0),
        Parameter::signed("a_2", A2, Quantity::Force, 50.0, 0.0),
        Parameter::signed("b_2", B2, Quantity::Force, 50.0, 0.0),
        PERIOD,
    ],
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "G. Otten et al., IEEE/ASME Trans. Mechatronics 2, 1997 (cogging)",
};

static HARMONICS_ABOUT: About = About {
    name: "ripple:harmonics",
    title: "force ripple along the stroke, six harmonics",
    equation: "sum_{k=1..6} a_k sin(2 pi k x/l) + b_k cos(2 pi k x/l)",
    parameters: &[
        sine("a_1", 1.0),
        sine("a_2", 0.0),
        sine("a_3", 0.0),
        sine("a_4", 0.0),
        sine("a_5", 0.0),
        sine("a_6", 0.0),
        cosine("b_1"),
        cosine("b_2"),
        cosine("b_3"),
        cosine("b_4"),
        cosine("b_5"),
        cosine("b_6"),
        PERIOD,
    ],
    slots: &[Slot::SmoothForce],
    shows: "lines at 1/l, 2/l, 3/l and so on in the residual's spectrum over position",
    reference: "P. J. Hor, Z. Q. Zhu, D. Howe, J. Rees-Jones, IEEE Trans. Magnetics 34, 1998 (cogging)",
};
static DIRECTION_ABOUT: About = About {
    name: "ripple:direction",
    title: "force ripple along the stroke, another one for either direction",
    equation: "a_p sin(2 pi x/l) + b_p cos(2 pi x/l) for v > 0, a_m, b_m instead for v < 0, their mean at rest",
    parameters: &[
        of_direction("a_p", "sine amplitude of the motion forth", 1.0),
        of_direction("b_p", "cosine amplitude of the motion forth", 0.0),
        of_direction("a_m", "sine amplitude of the motion back", 0.5),
        of_direction("b_m", "cosine amplitude of the motion back", 0.0),
        PERIOD,
    ],
    slots: &[Slot::SmoothForce, Slot::FrictionLevel],
    shows: "a line at 1/l in the residual's spectrum over position, of another size or phase for the motion forth \
            than for the motion back",
    reference: "B. Armstrong-Helouvry, Control of Machines with Friction, Kluwer 1991 (position-dependent friction \
                of either direction)",
};

/// Forces per unit of `a_1, b_1, a_2, b_2` of a ripple.
fn two_columns(wave: &[(f64, f64)]) -> Vec<Vec<f64>> {
    let column = |of: fn((f64, f64)) -> f64| wave.iter().map(|w| of(*w)).collect();
    vec![
        column(|(sin, _)| sin),
        column(|(_, cos)| cos),
        column(|(sin, cos)| 2.0 * sin * cos),
        column(|(sin, _)| 1.0 - 2.0 * sin * sin),
    ]
}

/// Forces per unit of `a_1 .. a_6, b_1 .. b_6` of a ripple of six harmonics.
fn six_columns(wave: &[(f64, f64)]) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::new(); 2 * COUNT];
    for (sin, cos) in wave {
        let (mut sin_k, mut cos_k) = (*sin, *cos);
        for k in 0..COUNT {
            columns[k].push(sin_k);
            columns[COUNT + k].push(cos_k);
            (sin_k, cos_k) = (sin_k * cos + cos_k * sin, cos_k * cos - sin_k * sin);
        }
    }
    columns
}

/// The values with each pair of amplitudes turned: places of its sine and its cosine, and its harmonic.
fn turned_by(values: &[f64], own: Own, pairs: &[(usize, usize, usize)]) -> Option<Vec<f64>> {
    let Own::Home(home) = own else { return None };
    let period = *values.last()?;
    let mut moved = values.to_vec();
    for (sine, cosine, harmonic) in pairs {
        (moved[*sine], moved[*cosine]) =
            turned((values[*sine], values[*cosine]), *harmonic, home, period);
    }
    Some(moved)
}

/// Screw leads on the market, m.
pub(super) const LEADS: [f64; 4] = [2.5e-3, 4e-3, 5e-3, 10e-3];

impl Effect for Ripple {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn is_of_place(&self) -> bool {
        true
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("ripple:harmonics")
    }

    fn drawn_from(&self, parameter: &str) -> Option<&'static [f64]> {
        (parameter == "l").then_some(&LEADS)
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "{
    const double a = 6.283185307179586 * (x / {l});
    const double sine = sin(a), cosine = cos(a);
    const double second = 2.0 * {a_2} * sine * cosine + {b_2} * (1.0 - 2.0 * sine * sine);
    force += {a_1} * sine + {b_1} * cosine + second;
}",
            ..CLaw::NONE
        })
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn periodic(&self) -> Option<Periodic> {
        Some(Periodic { ranked: true, columns: Some(two_columns), ..PERIODIC })
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        turned_by(values, own, &[(0, 1, 1), (2, 3, 2)])
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        two(p, m.position, out.force);
    }
}

impl Effect for Harmonics {
    fn about(&self) -> &'static About {
        &HARMONICS_ABOUT
    }

    fn is_of_place(&self) -> bool {
        true
    }

    /// Alone it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn drawn_from(&self, parameter: &str) -> Option<&'static [f64]> {
        (parameter == "l").then_some(&LEADS)
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "{
    static const double a[6] = {{a_1}, {a_2}, {a_3}, {a_4}, {a_5}, {a_6}};
    static const double b[6] = {{b_1}, {b_2}, {b_3}, {b_4}, {b_5}, {b_6}};
    const double angle = 6.283185307179586 * (x / {l});
    const double sine = sin(angle), cosine = cos(angle);
    double sine_k = sine, cosine_k = cosine, sum = 0.0;
    int k;
    for (k = 0; k < 6; k++) {
        const double next = sine_k * cosine + cosine_k * sine;
        sum += a[k] * sine_k + b[k] * cosine_k;
        cosine_k = cosine_k * cosine - sine_k * sine;
        sine_k = next;
    }
    force += sum;
}",
            ..CLaw::NONE
        })
    }

    fn periodic(&self) -> Option<Periodic> {
        Some(Periodic { ranked: false, columns: Some(six_columns), ..PERIODIC })
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        let pairs: [_; COUNT] = std::array::from_fn(|k| (k, COUNT + k, k + 1));
        turned_by(values, own, &pairs)
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        six(p, m.position, out.force);
    }
}

impl Effect for Direction {
    fn about(&self) -> &'static About {
        &DIRECTION_ABOUT
    }

    fn is_of_place(&self) -> bool {
        true
    }

    fn drawn_from(&self, parameter: &str) -> Option<&'static [f64]> {
        (parameter == "l").then_some(&LEADS)
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "{
    const double a = 6.283185307179586 * (x / {l});
    force += 0.5 * (({a_p} + {a_m}) * sin(a) + ({b_p} + {b_m}) * cos(a));
}",
            level: "{
    const double a = 6.283185307179586 * (x / {l});
    level += 0.5 * (({a_p} - {a_m}) * sin(a) + ({b_p} - {b_m}) * cos(a));
}",
            ..CLaw::NONE
        })
    }

    fn periodic(&self) -> Option<Periodic> {
        Some(Periodic { ranked: true, columns: None, ..PERIODIC })
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        turned_by(values, own, &[(0, 1, 1), (2, 3, 1)])
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        half(p, m.position, 1.0, out.force);
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        half(p, m.position, -1.0, level);
    }
}

vectorised! {
    /// Adds the fundamental and the second harmonic.
    fn two(p: Parameters<'_>, position: &[f64], force: &mut [f64]) {
        let lanes = force.len();
        let [a1, b1, a2, b2, period] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        let position = &position[..lanes];
        for i in 0..lanes {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            // sin 2a = 2 sin a cos a, cos 2a = 1 - 2 sin^2 a.
            let second = 2.0 * a2[i] * sin * cos + b2[i] * (1.0 - 2.0 * sin * sin);
            force[i] += a1[i] * sin + b1[i] * cos + second;
        }
    }

    /// Adds harmonics 1 to `COUNT`.
    fn six(p: Parameters<'_>, position: &[f64], force: &mut [f64]) {
        let lanes = force.len();
        let a: [&[f64]; COUNT] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        let b: [&[f64]; COUNT] = std::array::from_fn(|k| &p.get(COUNT + k)[..lanes]);
        let (period, position) = (&p.get(2 * COUNT)[..lanes], &position[..lanes]);
        for i in 0..lanes {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            let (mut sin_k, mut cos_k, mut sum) = (sin, cos, 0.0);
            for k in 0..COUNT {
                sum += a[k][i] * sin_k + b[k][i] * cos_k;
                (sin_k, cos_k) = (sin_k * cos + cos_k * sin, cos_k * cos - sin_k * sin);
            }
            force[i] += sum;
        }
    }

    /// Adds half of the ripple forth and half of that back times `back`.
    fn half(p: Parameters<'_>, position: &[f64], back: f64, out: &mut [f64]) {
        let lanes = out.len();
        let [a_p, b_p, a_m, b_m, period] = std::array::from_fn(|k| &p.get(k)[..lanes]);
        let position = &position[..lanes];
        for i in 0..lanes {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            out[i] += 0.5 * ((a_p[i] + back * a_m[i]) * sin + (b_p[i] + back * b_m[i]) * cos);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, along_and_simulated, level, smooth};
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn every_harmonic_has_its_period() {
        let mut p: Vec<f64> = (0..2 * COUNT).map(|k| (1.0 + k as f64).sin()).collect();
        p.push(5e-3);
        for x in [0.0, 0.37e-3, 1.9e-3, -3.1e-3] {
            let exact: f64 = (0..COUNT)
                .map(|k| (p[k], p[COUNT + k], TAU * (k + 1) as f64 * x / 5e-3))
                .map(|(a, b, angle)| a * angle.sin() + b * angle.cos())
                .sum();
            let (force, _) = smooth(&HARMONICS, &p, Point::at(x, 0.1));
            assert!((force - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn either_direction_has_its_ripple_and_rest_their_mean() {
        let p = [2.0, 0.3, -1.0, 0.5, 5e-3];
        let (sin, cos) = (TAU * 0.37e-3 / 5e-3).sin_cos();
        let (forth, back) = (2.0 * sin + 0.3 * cos, -sin + 0.5 * cos);
        for (v, exact) in [(0.1, forth), (-0.1, back), (0.0, 0.5 * (forth + back))] {
            let point = Point::at(0.37e-3, v);
            let sign = crate::simd::sign(v);
            let force = smooth(&DIRECTION, &p, point).0 + sign * level(&DIRECTION, &p, point);
            assert!((force - exact).abs() < 1e-12, "{v}");
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let harmonics = [("a_2", 1.0), ("b_6", -0.5), ("l", 0.02)];
        let direction = [("a_p", 2.0), ("b_p", 1.0), ("a_m", -1.0), ("b_m", 0.5), ("l", 0.01)];
        let forms: [(&str, &[(&str, f64)]); 2] =
            [("ripple:harmonics", &harmonics), ("ripple:direction", &direction)];
        for form in forms {
            let left = along_and_simulated(&[form], None);
            assert!(left < 0.02, "{}: {left}", form.0);
        }
    }

    #[test]
    fn both_harmonics_have_their_period() {
        let p = [1.0, 0.5, 0.3, -0.2, 5e-3];
        for x in [0.0, 0.37e-3, 1.9e-3] {
            let (force, _) = smooth(&Ripple, &p, Point::at(x, 0.1));
            let a = TAU * x / 5e-3;
            let exact = a.sin() + 0.5 * a.cos() + 0.3 * (2.0 * a).sin() - 0.2 * (2.0 * a).cos();
            assert!((force - exact).abs() < 1e-12);
            let (later, _) = smooth(&Ripple, &p, Point::at(x + 5e-3, -0.1));
            assert!((force - later).abs() < 1e-12);
        }
    }
}
