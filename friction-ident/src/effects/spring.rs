//! A spring to the machine's base: cable chain, bellows, counterbalance.

mod stiffening;

use super::{About, Apart, CLaw, Effect, Extent, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use crate::simd::vectorised;

/// `k (x - x_0)`.
#[derive(Clone, Copy, Debug)]
pub struct Spring;

static ABOUT: About = About {
    name: "spring",
    title: "spring to the base",
    equation: "k (x - x_0)",
    parameters: &[
        Parameter::level("k", "stiffness", Quantity::Stiffness, 1e5, 100.0),
        Parameter {
            low: -10.0,
            ..Parameter::shape("x_0", "position without force", Quantity::Length, (0.0, 10.0), 0.0)
                .linear()
                .taken_from(Extent::StrokeMiddle)
        },
    ],
    slots: &[Slot::SmoothForce],
    shows: "residual against position, the same for both directions",
    reference: "R. Hooke, De potentia restitutiva, 1678",
};

static FORMS: [&dyn Effect; 1] = [&stiffening::Stiffening];

impl Effect for Spring {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("spring:stiffening")
    }

    fn is_of_place(&self) -> bool {
        true
    }

    fn may_be_overrated(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw { smooth: "force += {k} * (x - {x_0});", ..CLaw::NONE })
    }

    fn told_apart(&self) -> &'static [Apart] {
        &[Apart {
            from: &["position-friction", "ripple", "gravity-pendulum"],
            experiment: "cover the whole stroke in both directions at two constant speeds",
        }]
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        stretch(p.get(0), p.get(1), m.position, out.force);
    }
}

vectorised! {
    fn stretch(stiffness: &[f64], zero: &[f64], position: &[f64], force: &mut [f64]) {
        let n = force.len();
        let (stiffness, zero, position) = (&stiffness[..n], &zero[..n], &position[..n]);
        for i in 0..n {
            force[i] += stiffness[i] * (position[i] - zero[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, smooth};
    use super::*;

    #[test]
    fn the_force_is_proportional_to_the_way_from_its_zero() {
        assert_eq!(smooth(&Spring, &[100.0, 0.25], Point::at(0.5, 1.0)), (25.0, 0.0));
        assert_eq!(smooth(&Spring, &[100.0, 0.25], Point::at(0.25, -1.0)), (0.0, 0.0));
    }
}
