//! The load behind the coupling has friction of its own.

use crate::effects::CDynamics;
use crate::effects::c_dynamics::LOAD as LOAD_IN_C;
use std::f64::consts::TAU;

use super::super::load::{Connection, Load, Pull, Pulled};
use super::{
    About, AsFound, Correction, Effect, Element, FREQUENCY, LOAD, Onset, Parameter, Parameters,
    Refused, Response, Slot, Step, ZETA, not_one,
};
use crate::axis::Quantity;
use crate::effects::{Along, SecondBody};
use crate::simd::{add_to, vectorised};

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

/// With the encoder on the mass; a coupling that gives far is a gap that is nearly closed.
static SECOND_BODY: SecondBody = SecondBody {
    along: Along::Frequency { count: 10, low: 3.0, share: 0.25 },
    damping: 0.05,
    shares: &[0.35, 0.6],
    factors: &[0.75, 0.88, 1.0, 1.14, 1.33],
    related: Some("backlash:two-mass"),
};
/// With the encoder on the load.
static ON_ENCODER: SecondBody = SecondBody { related: None, ..SECOND_BODY };

/// Helper functions in C.
const COUPLED_IN_C: &str = include_str!("../../export/c/coupled.c");

/// A load with friction behind a coupling; `$shown`: what the encoder shows of it.
macro_rules! coupled {
    ($shown:literal) => {
        CDynamics {
            states: 2,
            helpers: &[LOAD_IN_C, COUPLED_IN_C],
            load: "{
    const double w = 6.283185307179586 * {f}, k = {m_L} * w * w;
    {s0} = k > 0.0 ? -({F_L} * sign(velocity) + {d_L} * velocity) / k : 0.0;
    {s1} = velocity;
}",
            respond: "{
    const double p[5] = {{m_L}, {f}, {zeta}, {F_L}, {d_L}};
    double slope, mean;
    m->elements += coupled(p, m->left, m->displacement, {s0}, {s1}, &slope, &mean);
    m->stiffness += slope;
}",
            commit: "{
    const double p[5] = {{m_L}, {f}, {zeta}, {F_L}, {d_L}};
    double slope, mean;
    coupled(p, m->taken, m->displacement, {s0}, {s1}, &slope, &mean);
    {s0} += m->taken > 0.0 ? m->taken * mean - m->displacement : 0.0;
    {s1} = 2.0 * mean - {s1};
}",
            shown: $shown,
            iterations: 3,
            attached: true,
            ..CDynamics::NONE
        }
    };
}

impl Effect for WithFriction {
    fn about(&self) -> &'static About {
        match self.encoder {
            Encoder::Mass => &ABOUT,
            Encoder::Load => &LOAD_ABOUT,
        }
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["zeta"]
    }

    /// Both bodies answer the force and swing while the axis slides.
    fn rings(&self) -> bool {
        true
    }

    fn most(&self, parameter: &str, values: &[f64], mass: f64) -> Option<f64> {
        super::most(parameter, values, mass)
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(match self.encoder {
            Encoder::Mass => coupled!(""),
            Encoder::Load => coupled!("position += {s0};"),
        })
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        not_one(found)
    }

    fn second_body(&self) -> Option<&'static SecondBody> {
        match self.encoder {
            Encoder::Mass => Some(&SECOND_BODY),
            Encoder::Load => Some(&ON_ENCODER),
        }
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
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn pull(&self, ahead: f64) -> Pull {
        Pull { force: self.start + self.slope * ahead, slope: self.slope, holds: true }
    }

    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn run_ahead(&self, inertia: f64, total: f64) -> f64 {
        (total - self.start) / (inertia + self.slope)
    }
}

/// Stiffness of the coupling and its damping.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn coupling(load: Load, frequency: f64, zeta: f64) -> (f64, f64) {
    let w = TAU * frequency;
    (load.mass * w * w, 2.0 * zeta * load.mass * w)
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn pulled(
    load: Load,
    f: f64,
    zeta: f64,
    r: f64,
    moved: f64,
    stretch: f64,
    velocity: f64,
) -> Pulled {
    let (stiffness, damping) = coupling(load, f, zeta);
    let rate = if r > 0.0 { 1.0 / r } else { 0.0 };
    let slope = 0.5 * stiffness + damping * rate;
    load.step(velocity, r, moved, &Coupling { start: -stiffness * stretch, slope })
}

vectorised! {
    fn answer(
        p: Parameters<'_>,
        duration: &[f64],
        displacement: &[f64],
        state: &[f64],
        force: &mut [f64],
        stiffness: &mut [f64],
    ) {
        let n = duration.len();
        let (mass, f, zeta) = (&p.get(0)[..n], &p.get(1)[..n], &p.get(2)[..n]);
        let (level, viscous) = (&p.get(3)[..n], &p.get(4)[..n]);
        let (stretch, velocity) = state.split_at(n);
        let (displacement, velocity) = (&displacement[..n], &velocity[..n]);
        let (force, stiffness) = (&mut force[..n], &mut stiffness[..n]);
        for i in 0..n {
            let load = Load { mass: mass[i], level: level[i], viscous: viscous[i] };
            let (r, moved) = (duration[i], displacement[i]);
            let pulled = pulled(load, f[i], zeta[i], r, moved, stretch[i], velocity[i]);
            force[i] += pulled.force;
            stiffness[i] += pulled.slope;
        }
    }

    fn take(p: Parameters<'_>, duration: &[f64], displacement: &[f64], state: &mut [f64]) {
        let n = duration.len();
        let (mass, f, zeta) = (&p.get(0)[..n], &p.get(1)[..n], &p.get(2)[..n]);
        let (level, viscous) = (&p.get(3)[..n], &p.get(4)[..n]);
        let (stretch, velocity) = state.split_at_mut(n);
        let (displacement, velocity) = (&displacement[..n], &mut velocity[..n]);
        for i in 0..n {
            let load = Load { mass: mass[i], level: level[i], viscous: viscous[i] };
            let (r, moved) = (duration[i], displacement[i]);
            let pulled = pulled(load, f[i], zeta[i], r, moved, stretch[i], velocity[i]);
            stretch[i] += if r > 0.0 { r * pulled.mean - moved } else { 0.0 };
            velocity[i] = 2.0 * pulled.mean - velocity[i];
        }
    }
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
        answer(p, step.duration, step.displacement, state, out.force, out.stiffness);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        take(p, step.duration, step.displacement, state);
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
        3
    }
}
