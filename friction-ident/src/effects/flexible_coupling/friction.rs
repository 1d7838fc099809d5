//! The load behind the coupling has friction of its own.

use std::f64::consts::TAU;

use super::super::load::{Connection, Load, Pulled};
use super::{
    About, Correction, Effect, Element, FREQUENCY, LOAD, Onset, Parameter, Parameters, Response,
    Slot, Step, ZETA,
};
use crate::axis::Quantity;
use crate::simd::add_to;

/// The main form with Coulomb friction `F_L` and viscous friction `d_L` of the load on the ground. The load
/// really sticks: a force below `F_L` through the coupling does not move it.
#[derive(Clone, Copy, Debug)]
pub struct WithFriction {
    encoder: Encoder,
}

/// Which body the encoder is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoder {
    Mass,
    Load,
}

/// The encoder is on the model's own mass.
pub static FRICTION: WithFriction = WithFriction { encoder: Encoder::Mass };
/// The encoder is on the load.
pub static ON_LOAD: WithFriction = WithFriction { encoder: Encoder::Load };

const PARAMETERS: &[Parameter] = &[
    LOAD,
    FREQUENCY,
    ZETA,
    Parameter::level("F_L", "Coulomb friction of the load", Quantity::Force, 200.0, 4.0),
    Parameter::level("d_L", "viscous friction of the load", Quantity::Damping, 1e4, 20.0),
];
const EQUATION: &str = "m_L x_L'' = k (x - x_L) + d (x' - x_L') - F_L sgn x_L' - d_L x_L', the coupling acts back on the mass, k = m_L (2 pi f)^2, d = 2 zeta m_L 2 pi f";
const REFERENCE: &str = "W. Leonhard, Control of Electrical Drives, Springer (two-mass system); D. Karnopp, J. Dyn. Syst. Meas. Control 107, 1985 (stick and slip)";

static ABOUT: About = About {
    name: "flexible-coupling:friction",
    title: "load with friction behind a flexible coupling",
    equation: EQUATION,
    parameters: PARAMETERS,
    slots: &[Slot::Attached],
    shows: "ringing after edges of the acceleration, and a load that sticks while the mass turns back",
    reference: REFERENCE,
};
static LOAD_ABOUT: About = About {
    name: "flexible-coupling:load",
    title: "load with friction behind a flexible coupling, encoder on the load",
    equation: EQUATION,
    parameters: PARAMETERS,
    slots: &[Slot::Attached],
    shows: "the position answers the force late and rings, the force does not show it",
    reference: REFERENCE,
};

impl Effect for WithFriction {
    fn about(&self) -> &'static About {
        match self.encoder {
            Encoder::Mass => &ABOUT,
            Encoder::Load => &LOAD_ABOUT,
        }
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

/// Spring and damper over a step: the trapezoidal rule.
struct Coupling {
    /// Force at the start of the step, at no relative velocity.
    start: f64,
    /// Force per distance that the mass runs ahead.
    slope: f64,
}

impl Connection for Coupling {
    fn pull(&self, ahead: f64) -> (f64, f64) {
        (self.start + self.slope * ahead, self.slope)
    }
}

/// Stiffness of the coupling and its damping.
fn coupling(load: Load, frequency: f64, zeta: f64) -> (f64, f64) {
    let w = TAU * frequency;
    (load.mass * w * w, 2.0 * zeta * load.mass * w)
}

fn pulled(p: Parameters<'_>, step: &Step<'_>, i: usize, state: &[f64]) -> Pulled {
    let lanes = step.duration.len();
    let (stretch, velocity) = (state[i], state[lanes + i]);
    let load = Load::of(p, i, [0, 3, 4]);
    let (stiffness, damping) = coupling(load, p.get(1)[i], p.get(2)[i]);
    let (r, start) = (step.duration[i], -stiffness * stretch);
    if r <= 0.0 {
        return Pulled { force: start, slope: 0.0, mean: velocity };
    }
    let connection = Coupling { start, slope: 0.5 * stiffness + damping / r };
    load.step(velocity, r, step.displacement[i], &connection)
}

/// States: stretch `x_L - x` and velocity of the load.
impl Element for WithFriction {
    fn states(&self) -> usize {
        2
    }

    /// Stretched as far as the friction of the load asks for at that velocity.
    fn start(&self, p: &[f64], at: &Onset, state: &mut [f64]) {
        let load = Load { mass: p[0], level: p[3], viscous: p[4] };
        let (stiffness, _) = coupling(load, p[1], p[2]);
        let stretch = -load.drag(at.velocity) / stiffness;
        state.copy_from_slice(&[if stiffness > 0.0 { stretch } else { 0.0 }, at.velocity]);
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

    /// Both bodies move together.
    fn correct(&self, _p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        add_to(&mut state[c.velocity.len()..], c.velocity);
    }

    fn shown(&self, _p: Parameters<'_>, state: &[f64], position: &mut [f64]) -> bool {
        let shows = self.encoder == Encoder::Load;
        if shows {
            let stretch = &state[..position.len()];
            add_to(position, stretch);
        }
        shows
    }

    fn shown_velocity(&self, _p: Parameters<'_>, state: &[f64], velocity: &mut [f64]) -> bool {
        let shows = self.encoder == Encoder::Load;
        if shows {
            let lanes = velocity.len();
            velocity.copy_from_slice(&state[lanes..2 * lanes]);
        }
        shows
    }

    fn iterations(&self) -> usize {
        // A load that sticks is a stiff piece between two softer ones.
        8
    }

    fn bracketed(&self) -> bool {
        true
    }
}
