//! A gain that repeats along the stroke: the force constant over the poles of a motor.

use crate::axis::Quantity;
use crate::effects::own::{Own, turned};
use crate::effects::{
    About, CLaw, Effect, Motion, Parameter, Parameters, Periodic, Repeats, Slot, Smooth,
};
use crate::simd::{sin_cos_of_turns, vectorised};

/// `F = u (1 + a sin(2 pi x/l) + b cos(2 pi x/l))`, as the force that is missing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ripple;

static ABOUT: About = About {
    name: "motor-gain:ripple",
    title: "gain that repeats along the stroke",
    equation: "F (1 + a sin(2 pi x/l) + b cos(2 pi x/l))",
    parameters: &[
        Parameter::signed("a", "sine amplitude, of the mean gain", Quantity::One, 0.9, 0.05),
        Parameter::signed("b", "cosine amplitude, of the mean gain", Quantity::One, 0.9, 0.0),
        Parameter::shape("l", "period: pole pitch", Quantity::Length, (1e-3, 20.0), 3e-2),
    ],
    slots: &[Slot::SmoothForce],
    shows: "a line at 1/l in the spectrum of (residual / force) over position: a ripple that grows with the force",
    reference: "C. Rohrig, A. Jochheim, American Control Conference 2001 (force ripple of linear motors)",
};

impl Effect for Ripple {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn periodic(&self) -> Option<Periodic> {
        let of = Repeats::Gain;
        Some(Periodic { period: "l", of, ranked: true, columns: None, shortest: None })
    }

    fn in_recording(&self, values: &[f64], own: Own) -> Option<Vec<f64>> {
        let (Own::Home(home), &[a, b, l]) = (own, values) else { return None };
        let (a, b) = turned((a, b), 1, home, l);
        Some(vec![a, b, l])
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some("it needs the force of the drive")
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::smooth(
            "force -= drive * ({a} * sin(6.283185307179586 * x / {l}) + {b} * cos(6.283185307179586 * x / {l}));",
        ))
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        swing(p, m.position, m.drive_force, out.force);
    }
}

vectorised! {
    fn swing(p: Parameters<'_>, position: &[f64], drive: &[f64], force: &mut [f64]) {
        let n = force.len();
        let [sine, cosine, period] = std::array::from_fn(|k| &p.get(k)[..n]);
        let (position, drive) = (&position[..n], &drive[..n]);
        for i in 0..n {
            let (sin, cos) = sin_cos_of_turns(position[i] / period[i]);
            force[i] -= drive[i] * (sine[i] * sin + cosine[i] * cos);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, along_and_simulated, smooth};

    #[test]
    fn it_is_a_share_of_the_force_of_the_drive_that_repeats_along_the_stroke() {
        let p = [0.3, -0.05, 0.02];
        let at = |x: f64| smooth(&Ripple, &p, Point { drive_force: 10.0, ..Point::at(x, 0.1) }).0;
        assert!((at(0.0) - 0.5).abs() < 1e-12 && (at(0.005) + 3.0).abs() < 1e-12);
        assert!((at(0.0123) - at(0.0323)).abs() < 1e-9);
        let other = Point { drive_force: -10.0, ..Point::at(0.005, 0.1) };
        assert!((smooth(&Ripple, &p, other).0 - 3.0).abs() < 1e-12);
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("a", 0.1), ("b", -0.2), ("l", 0.03)];
        let left = along_and_simulated(&[("motor-gain:ripple", &values)], None);
        assert!(left < 0.02, "{left}");
    }

    #[test]
    fn where_homing_put_zero_elsewhere_the_axis_is_the_same() {
        let p = [0.3, -0.05, 0.02];
        let moved = Ripple.in_recording(&p, Own::Home(0.0037)).unwrap();
        let at = |p: &[f64], x: f64| {
            smooth(&Ripple, p, Point { drive_force: 10.0, ..Point::at(x, 0.1) }).0
        };
        let (here, there) = (at(&p, 0.011), [at(&moved, 0.0147), at(&moved, 0.0073)]);
        assert!(there.iter().any(|there| (there - here).abs() < 1e-9), "{here} {there:?}");
    }
}
