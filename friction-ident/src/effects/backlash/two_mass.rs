//! Two masses and a gap between them: the impact at its ends is part of the law.

use super::super::load::{Connection, Load, Pulled};
use super::{About, Effect, Parameter, Parameters, Slot, WIDTH};
use crate::axis::Quantity;
use crate::effects::{Correction, Element, Onset, Response, Step};
use crate::simd::sign;

/// A second mass `m_L` with friction of its own that the mass meets at either end of a gap `b`, over a
/// spring and a damper in parallel that push but never pull.
#[derive(Clone, Copy, Debug)]
pub struct TwoMass;

/// Share of the gap next to each end within which an observer takes it for closed.
const NEAR_END: f64 = 0.05;

static ABOUT: About = About {
    name: "backlash:two-mass",
    title: "load behind a gap",
    equation: "m_L x_L'' = N - F_L sgn x_L' - d_L x_L', N acts back on the mass; N = k p + d p' >= 0 for p = x - x_L - b/2 > 0, mirrored at the other end, d = 2 zeta sqrt(k m_L)",
    parameters: &[
        Parameter::level("m_L", "mass behind the gap", Quantity::Mass, 1e3, 10.0),
        Parameter::level("F_L", "Coulomb friction of the load", Quantity::Force, 200.0, 4.0),
        Parameter::level("d_L", "viscous friction of the load", Quantity::Damping, 1e4, 20.0),
        WIDTH,
        Parameter::shape(
            "k",
            "stiffness of the contact at its ends",
            Quantity::Stiffness,
            (1e4, 1e9),
            5e6,
        ),
        Parameter::shape("zeta", "damping ratio of the contact", Quantity::One, (1e-3, 2.0), 0.1),
    ],
    slots: &[Slot::Attached],
    shows: "after a reversal the load is missing over the distance b, then an impact",
    reference: "M. Nordin, P.-O. Gutman, Automatica 38, 2002; K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42, 1975",
};

impl Effect for TwoMass {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

/// Both ends of the gap over a step. At each the mean force along an even motion is exact, whenever in the
/// step it opens or closes: that of the spring is its change of energy over the distance, so that the spring
/// gives back what it took and no more.
struct Gap {
    /// Place of the mass in the gap at the start of the step, from its middle.
    place: f64,
    half: f64,
    stiffness: f64,
    /// Damping over the length of the step.
    damping: f64,
}

impl Gap {
    /// One end, towards which `place` and `ahead` count.
    fn end(&self, place: f64, ahead: f64) -> (f64, f64) {
        let pressed = |place: f64| (place - self.half).max(0.0);
        let (before, after) = (pressed(place), pressed(place + ahead));
        let (spring, slope) = if before > 0.0 && after > 0.0 {
            (0.5 * (before + after), 0.5)
        } else if before == 0.0 && after == 0.0 {
            return (0.0, 0.0);
        } else {
            // It opens or closes within the step, so that `ahead` is not 0.
            let share = (after + before) / ahead.abs();
            let slope = if after > 0.0 { share * (1.0 - 0.5 * share) } else { 0.5 * share * share };
            (0.5 * share * (after + before), slope)
        };
        let damper = self.damping * (after - before);
        let force = self.stiffness * spring + damper;
        let damped = if after > 0.0 { self.damping } else { 0.0 };
        if force > 0.0 { (force, self.stiffness * slope + damped) } else { (0.0, 0.0) }
    }
}

impl Connection for Gap {
    fn pull(&self, ahead: f64) -> (f64, f64) {
        let (front, back) = (self.end(self.place, ahead), self.end(-self.place, -ahead));
        (front.0 - back.0, front.1 + back.1)
    }
}

fn pulled(p: Parameters<'_>, step: &Step<'_>, i: usize, state: &[f64]) -> Pulled {
    let lanes = step.duration.len();
    let (stretch, velocity) = (state[i], state[lanes + i]);
    let load = Load::of(p, i, [0, 1, 2]);
    let (half, stiffness, zeta) = (0.5 * p.get(3)[i], p.get(4)[i], p.get(5)[i]);
    let r = step.duration[i];
    let damping = if r > 0.0 { 2.0 * zeta * (stiffness * load.mass).sqrt() / r } else { 0.0 };
    let gap = Gap { place: -stretch, half, stiffness, damping };
    if r <= 0.0 {
        return Pulled { force: gap.pull(0.0).0, slope: 0.0, mean: velocity };
    }
    load.step(velocity, r, step.displacement[i], &gap)
}

/// States: stretch `x_L - x` and velocity of the load.
impl Element for TwoMass {
    fn states(&self) -> usize {
        2
    }

    /// At rest the mass is in the middle of the gap, else at the end where it pushes the load, pressed as far as
    /// the friction of the load asks for.
    fn start(&self, p: &[f64], at: &Onset, state: &mut [f64]) {
        let load = Load { mass: p[0], level: p[1], viscous: p[2] };
        let stretch = -0.5 * p[3] * sign(at.velocity) - load.drag(at.velocity) / p[4];
        state.copy_from_slice(&[stretch, at.velocity]);
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        for i in 0..step.duration.len() {
            let pulled = pulled(p, step, i, state);
            out.force[i] += pulled.force;
            out.stiffness[i] += pulled.slope;
        }
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        let lanes = step.duration.len();
        for i in 0..lanes {
            let (r, moved) = (step.duration[i], step.displacement[i]);
            if r > 0.0 {
                let pulled = pulled(p, step, i, state);
                state[i] += r * pulled.mean - moved;
                state[lanes + i] = 2.0 * pulled.mean - state[lanes + i];
            }
        }
    }

    /// Well inside the gap the mass moves alone, up to its end; else both bodies move together.
    fn correct(&self, p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        let (stretch, velocity) = state.split_at_mut(c.displacement.len());
        for (i, (stretch, velocity)) in stretch.iter_mut().zip(velocity).enumerate() {
            let (width, half) = (p.get(3)[i], 0.5 * p.get(3)[i]);
            if half - stretch.abs() > NEAR_END * width {
                *stretch = (*stretch - c.displacement[i]).max(-half).min(half);
            } else {
                *velocity += c.velocity[i];
            }
        }
    }

    fn iterations(&self) -> usize {
        // Soft in the gap, stiff at its ends, and stiff between two softer pieces where the load sticks.
        12
    }

    fn bracketed(&self) -> bool {
        true
    }
}
