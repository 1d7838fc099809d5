//! Friction that differs between the two directions of motion.

use super::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::{sign, vectorised};

/// Half differences: `F_C+ = F_C + dF_C`, `F_C- = F_C - dF_C`, likewise for `F_v`.
///
/// While the axis slides, `dF_C s s = dF_C` looks like an offset; at rest and in the breakaway
/// force it does not. `dF_v s v = dF_v |v|`.
#[derive(Clone, Copy, Debug)]
pub struct Asymmetry;

static ABOUT: About = About {
    name: "asymmetry",
    title: "direction-dependent friction",
    equation: "(dF_C s + dF_v |v| s) s",
    parameters: &[
        Parameter::signed(
            "dF_C",
            "half difference of the friction levels (+ minus -)",
            Quantity::Force,
            100.0,
            1.0,
        ),
        Parameter::signed(
            "dF_v",
            "half difference of the dampings (+ minus -)",
            Quantity::Damping,
            1000.0,
            30.0,
        ),
    ],
    slots: &[Slot::FrictionLevel, Slot::SmoothForce],
    shows: "two levels or two slopes in (residual x sign of velocity) against speed",
    reference: "A. Janot, M. Gautier, M. Brunot, data set EMPS, 2019 (F_v 167 and 240 N s/m)",
};

impl Effect for Asymmetry {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "force += {dF_v} * fabs(v);",
            damping: "damping += {dF_v} * (double)((v > 0.0) - (v < 0.0));",
            level: "level += {dF_C} * s;",
            ..CLaw::NONE
        })
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        shift(p.get(0), m.direction, level);
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        tilt(p.get(1), m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn shift(half: &[f64], direction: &[f64], level: &mut [f64]) {
        for ((level, half), direction) in level.iter_mut().zip(half).zip(direction) {
            *level += half * direction;
        }
    }

    fn tilt(half: &[f64], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let (half, velocity, slope) = (&half[..n], &velocity[..n], &mut slope[..n]);
        for i in 0..n {
            force[i] += half[i] * velocity[i].abs();
            // Negative on one side: there it lowers the positive slope of `viscous`.
            slope[i] += half[i] * sign(velocity[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level, smooth};
    use super::*;

    #[test]
    fn levels_and_slopes_differ_by_twice_the_half_difference() {
        let p = [2.0, 30.0];
        let (forth, back) = (Point::at(0.0, 0.1), Point::at(0.0, -0.1));
        assert_eq!(level(&Asymmetry, &p, forth) - level(&Asymmetry, &p, back), 4.0);
        assert_eq!(smooth(&Asymmetry, &p, forth), (3.0, 30.0));
        assert_eq!(smooth(&Asymmetry, &p, back), (3.0, -30.0));
    }
}
