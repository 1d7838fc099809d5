//! Drag that grows with another power of the speed: between laminar and turbulent flow, or with a seal that is pressed on.

use crate::axis::Quantity;
use crate::effects::{About, CLaw, Effect, Extent, Motion, Parameter, Parameters, Slot, Smooth};
use crate::simd::{power, vectorised};

/// `c v |v| (|v| / v_high)^(n - 2)`: the quadratic drag with `n = 2`, and as large at the top speed with any `n`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Power;

pub(super) const NAME: &str = "quadratic-drag:power";

static ABOUT: About = About {
    name: NAME,
    title: "drag by a power of the speed",
    equation: "c v |v| (|v|/v_high)^(n - 2)",
    parameters: &[
        Parameter::level("c", "drag at the top speed", Quantity::Drag, 10_000.0, 100.0),
        // From hardly more than viscous on.
        Parameter::shape("n", "exponent", Quantity::One, (1.2, 4.0), 2.0).linear(),
        Parameter::fixed("v_high", "top speed", Quantity::Velocity, (1e-6, 100.0), 0.05)
            .taken_from(Extent::TopSpeed),
    ],
    slots: &[Slot::SmoothForce],
    shows: "curvature against speed at top speed only; its exponent where the speeds span a decade",
    reference: "H. Blasius, Forschungsarbeiten des Ingenieurwesens 131, 1913 (n = 1.75); R. B. Bird et al., Transport Phenomena, 2002",
};

impl Effect for Power {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// A free exponent would fit any curve over the speed a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn may_be_overrated(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        let smooth = "force += {c} * {v_high} * pow(fabs(v) / {v_high}, {n} - 1.0) * v;";
        let damping = "damping += {c} * {v_high} * pow(fabs(v) / {v_high}, {n} - 1.0);";
        Some(CLaw::smooth(smooth).damped(damping))
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        drag([p.get(0), p.get(1), p.get(2)], m.velocity, out.force, out.damping);
    }
}

vectorised! {
    fn drag(parameters: [&[f64]; 3], velocity: &[f64], force: &mut [f64], slope: &mut [f64]) {
        let n = force.len();
        let [drag, exponent, high] = parameters.map(|p| &p[..n]);
        let (velocity, slope) = (&velocity[..n], &mut slope[..n]);
        for i in 0..n {
            // The secant through rest, as of the quadratic drag.
            let secant =
                drag[i] * high[i] * power(velocity[i].abs() / high[i], exponent[i] - 1.0);
            force[i] += secant * velocity[i];
            slope[i] += secant;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::QuadraticDrag;
    use super::*;
    use crate::effects::testing::{Point, along_and_simulated, smooth};

    #[test]
    fn with_the_exponent_two_it_is_the_quadratic_drag() {
        for v in [0.5, -0.03, 0.0] {
            let ((force, slope), (square, secant)) = (
                smooth(&Power, &[100.0, 2.0, 0.7], Point::at(0.0, v)),
                smooth(&QuadraticDrag, &[100.0], Point::at(0.0, v)),
            );
            assert!((force - square).abs() < 1e-10 && (slope - secant).abs() < 1e-10, "{v}");
        }
    }

    #[test]
    fn it_grows_with_its_power_and_is_as_large_at_the_top_speed_with_any() {
        for n in [1.5, 3.0] {
            let at = |v: f64| smooth(&Power, &[100.0, n, 0.5], Point::at(0.0, v)).0;
            assert!((at(0.5) - 25.0).abs() < 1e-9);
            assert!((at(-0.25) / at(0.5) + 0.5_f64.powf(n)).abs() < 1e-9);
        }
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("c", 200.0), ("n", 1.7), ("v_high", 0.3)];
        let left = along_and_simulated(&[("quadratic-drag:power", &values)], None);
        assert!(left < 0.02, "{left}");
    }
}
