//! A spring whose stiffness varies along the stroke: bellows, flexures, cables that tighten.

use crate::axis::Quantity;
use crate::effects::about::STROKE;
use crate::effects::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot, Smooth};
use crate::simd::vectorised;

/// `k d + F_2 u^2 + F_3 u^3` with the way `d` from the middle of the stroke and the share `u` of half the stroke that it is.
#[derive(Clone, Copy, Debug)]
pub struct Stiffening;

static ABOUT: About = About {
    name: "spring:stiffening",
    title: "spring to the base that stiffens",
    equation: "k d + F_2 u^2 + F_3 u^3, d = x less the middle of the stroke, u = d over half the stroke",
    parameters: &[
        Parameter::signed("k", "stiffness in the middle", Quantity::Stiffness, 1e5, 100.0),
        Parameter::signed(
            "F_2",
            "force at the ends by the second power",
            Quantity::Force,
            100.0,
            1.0,
        ),
        Parameter::signed(
            "F_3",
            "force at the ends by the third power",
            Quantity::Force,
            100.0,
            1.0,
        ),
        STROKE[0],
        STROKE[1],
    ],
    slots: &[Slot::SmoothForce],
    shows: "residual against position, bent, the same for both directions",
    reference: "G. Duffing, Erzwungene Schwingungen bei veraenderlicher Eigenfrequenz, Vieweg 1918",
};

impl Effect for Stiffening {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn is_of_place(&self) -> bool {
        true
    }

    /// Alone it would fit whatever depends on the place a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw {
            smooth: "{
    const double way = x - 0.5 * ({start} + {end}), share = 2.0 * way / ({end} - {start});
    force += {k} * way + ({F_2} + {F_3} * share) * share * share;
}",
            ..CLaw::NONE
        })
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        stretch(p, m.position, out.force);
    }
}

vectorised! {
    fn stretch(p: Parameters<'_>, position: &[f64], force: &mut [f64]) {
        let n = force.len();
        let (stiffness, second, third) = (&p.get(0)[..n], &p.get(1)[..n], &p.get(2)[..n]);
        let (start, end, position) = (&p.get(3)[..n], &p.get(4)[..n], &position[..n]);
        for i in 0..n {
            let way = position[i] - 0.5 * (start[i] + end[i]);
            let share = 2.0 * way / (end[i] - start[i]);
            force[i] += stiffness[i] * way + (second[i] + third[i] * share) * share * share;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, smooth};

    #[test]
    fn it_stiffens_from_the_middle_of_the_stroke_on() {
        // From -1 to 3: the middle is 1, the ends are 2 away.
        let force = |x: f64| smooth(&Stiffening, &[10.0, 3.0, 5.0, -1.0, 3.0], Point::at(x, 0.0)).0;
        assert_eq!(force(1.0), 0.0);
        assert_eq!((force(3.0), force(-1.0)), (20.0 + 3.0 + 5.0, -20.0 + 3.0 - 5.0));
        assert_eq!(force(2.0), 10.0 + 3.0 / 4.0 + 5.0 / 8.0);
    }
}
