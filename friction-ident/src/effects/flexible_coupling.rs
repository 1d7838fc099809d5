//! A flexible coupling: part of the mass hangs behind a spring and a damper.

mod friction;

use super::as_found::AT_END;
use crate::effects::CDynamics;
use std::f64::consts::TAU;

use super::{
    About, AsFound, Correction, Effect, Element, Onset, Parameter, Parameters, Refused, Response,
    Slot, Step, Trials,
};
use crate::axis::Quantity;
use crate::simd::add_to;

/// A second mass `m_L` on spring and damper; the model's own mass is the one in front.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleCoupling;

const LOAD: Parameter =
    Parameter::level("m_L", "mass behind the coupling", Quantity::Mass, 1e3, 10.0);
const FREQUENCY: Parameter = Parameter::shape(
    "f",
    "its frequency with the drive blocked",
    Quantity::Frequency,
    (1.0, 500.0),
    50.0,
);
/// What joints and bearings hold together is damped by half a per cent and more.
const ZETA: Parameter =
    Parameter::shape("zeta", "its damping ratio", Quantity::One, (5e-3, 2.0), 0.05);

/// Damping ratio from which on a resonance has no half-power bandwidth, as its peak does not reach the square root of 2:
/// sqrt((1 - 1/sqrt 2)/2).
const SILENT: f64 = 0.383;

/// Why a coupling is none. A force drives the mass, nothing blocks it: what rings are both bodies against each other, damped
/// by `zeta sqrt(1 + m_L/m)`. What swings as slowly as it may takes the mass along, and hides how large that is; what swings as
/// fast as it may is not seen to swing, and what swings on as long as it may follows how counts beat with the samples.
fn not_one(found: &AsFound<'_>) -> Option<Refused> {
    let zeta = found.values[2];
    let limit = silent(found.values, found.mass);
    let quiet =
        Refused { name: "zeta", value: zeta, limit, unit_of: "zeta", meaning: "nothing rings" };
    let slow = found.at_least((1, "f"), AT_END, "it swings as slowly as it may");
    let (f, most) = (found.values[1], found.most[1]);
    let meaning = "it swings as fast as it may";
    let fast = Refused { name: "f", value: f, limit: most, unit_of: "f", meaning };
    let on = found.at_least((2, "zeta"), AT_END, "it swings on as long as it may");
    slow.or_else(|| (AT_END * f >= most).then_some(fast))
        .or(on)
        .or_else(|| (zeta >= limit).then_some(quiet))
}

/// Damping ratio from which on nothing rings.
fn silent(values: &[f64], mass: f64) -> f64 {
    SILENT / (1.0 + values[0] / mass).sqrt()
}

/// The data must tell that it rings.
fn most(parameter: &str, values: &[f64], mass: f64) -> Option<f64> {
    (parameter == ZETA.name).then(|| silent(values, mass))
}

static FORMS: [&dyn Effect; 2] = [&friction::FRICTION, &friction::ON_LOAD];
static ABOUT: About = About {
    name: "flexible-coupling",
    title: "load behind a flexible coupling",
    equation: "m_L x_L'' = k (x - x_L) + d (x' - x_L') acts back on the mass, k = m_L (2 pi f)^2, d = 2 zeta m_L 2 pi f",
    parameters: &[LOAD, FREQUENCY, ZETA],
    slots: &[Slot::Attached],
    shows: "ringing of the residual after edges of the acceleration",
    reference: "W. Leonhard, Control of Electrical Drives, Springer (two-mass system)",
};

/// Helper functions in C.
const SWING_IN_C: &str = include_str!("../export/c/swing.c");

impl Effect for FlexibleCoupling {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["zeta"]
    }

    /// Both bodies answer the force and swing while the axis slides.
    fn rings(&self) -> bool {
        true
    }

    fn most(&self, parameter: &str, values: &[f64], mass: f64) -> Option<f64> {
        most(parameter, values, mass)
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 2,
            helpers: &[SWING_IN_C],
            load: "{s0} = 0.0;\n{s1} = velocity;",
            respond: "{
    const double p[3] = {{m_L}, {f}, {zeta}};
    double slope, mean;
    m->elements += swing(p, m->left, m->displacement, {s0}, {s1}, &slope, &mean);
    m->stiffness += slope;
}",
            commit: "{
    const double p[3] = {{m_L}, {f}, {zeta}};
    double slope, mean;
    swing(p, m->taken, m->displacement, {s0}, {s1}, &slope, &mean);
    {s0} += m->taken * mean - m->displacement;
    {s1} += 2.0 * (mean - {s1});
}",
            iterations: 1,
            attached: true,
            ..CDynamics::NONE
        })
    }

    /// A resonance is as narrow as its damping, so that the frequencies lie closer than other shapes.
    fn trials(&self, parameter: &str) -> Option<Trials> {
        Some(if parameter == "f" { Trials::Spread(40) } else { Trials::At(&[0.03, 0.1, 0.4]) })
    }

    fn few_trials(&self) -> Option<&'static [usize]> {
        Some(&[12, 1])
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        &FORMS
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        not_one(found)
    }
}

/// Trapezoidal rule for the load over a step in which the mass moves by `moved`. The load's mean
/// velocity `u` follows from `2 (u - v_L) / r = -w^2 (e + (r u - moved) / 2) - 2 zeta w (u - moved / r)`:
/// the force is in proportion to `m_L`, which may be nothing.
struct Swing {
    /// Mean force on the mass, and its slope against `moved`.
    force: f64,
    slope: f64,
    /// Mean velocity of the load.
    mean: f64,
}

fn swing(p: Parameters<'_>, i: usize, r: f64, moved: f64, stretch: f64, velocity: f64) -> Swing {
    let (load, w, zeta) = (p.get(0)[i], TAU * p.get(1)[i], p.get(2)[i]);
    let (stiffness, damping) = (w * w, 2.0 * zeta * w);
    if r <= 0.0 {
        return Swing { force: -load * stiffness * stretch, slope: 0.0, mean: velocity };
    }
    let inertia = 2.0 / r + 0.5 * stiffness * r + damping;
    let coupling = 0.5 * stiffness + damping / r;
    let mean = (2.0 * velocity / r - stiffness * stretch + coupling * moved) / inertia;
    // What accelerates the load is missing at the mass.
    let force = 2.0 * load * (mean - velocity) / r;
    Swing { force, slope: 2.0 * load * coupling / (r * inertia), mean }
}

/// States: stretch `x_L - x` and velocity of the load.
impl Element for FlexibleCoupling {
    fn states(&self) -> usize {
        2
    }

    fn start(&self, _p: &[f64], at: &Onset, state: &mut [f64]) {
        state.copy_from_slice(&[0.0, at.velocity]);
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let lanes = out.force.len();
        for i in 0..lanes {
            let (r, moved) = (step.duration[i], step.displacement[i]);
            let swing = swing(p, i, r, moved, state[i], state[lanes + i]);
            out.force[i] += swing.force;
            out.stiffness[i] += swing.slope;
        }
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        let lanes = step.duration.len();
        for i in 0..lanes {
            let (r, moved) = (step.duration[i], step.displacement[i]);
            let swing = swing(p, i, r, moved, state[i], state[lanes + i]);
            state[i] += r * swing.mean - moved;
            state[lanes + i] += 2.0 * (swing.mean - state[lanes + i]);
        }
    }

    /// Both bodies move together.
    fn correct(&self, _p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        add_to(&mut state[c.velocity.len()..], c.velocity);
    }

    fn iterations(&self) -> usize {
        // Linear.
        1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::driven::{MeasuredMotion, force_along};
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    fn model(zeta: f64) -> Model {
        Model::new(Axis::Linear, 3.0)
            .and_then(|m| m.with("flexible-coupling", &[("m_L", 1.0), ("f", 20.0), ("zeta", zeta)]))
            .unwrap()
    }

    #[test]
    fn both_masses_together_gain_the_impulse_and_ring_at_the_resonance() {
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 2.5e-4).collect();
        let force = vec![4.0; 2000];
        let input = Input::new(&time, &force, Hold::ZeroOrder).with_max_step(1e-4);
        let out = simulate(&model(1e-3), &input, &Start::default()).unwrap();
        // v = a t + ringing at w sqrt(1 + m_L / m); amplitude F / m / W * m_L / (m + m_L).
        let w = TAU * 20.0 * (1.0f64 + 1.0 / 3.0).sqrt();
        for (v, t) in out.velocity.iter().zip(&time) {
            let ring = (4.0 / 3.0 - 1.0) / w * (w * t).sin();
            assert!((v - t - ring).abs() < 2e-4, "{t}: {v}");
        }
    }

    #[test]
    fn along_a_motion_it_asks_for_what_swings_behind() {
        let w = TAU * 3.0;
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let x: Vec<f64> = time.iter().map(|t| 0.01 * (1.0 - (w * t).cos())).collect();
        let v: Vec<f64> = time.iter().map(|t| 0.01 * w * (w * t).sin()).collect();
        let a: Vec<f64> = time.iter().map(|t| 0.01 * w * w * (w * t).cos()).collect();
        let force = force_along(&model(0.3), &MeasuredMotion::new(&time, &x, &v, &a).unwrap());
        // Far below the coupling's frequency the load weighs m_L / (1 - (3/20)^2), nearly in phase.
        let (mut sum, mut square) = (0.0, 0.0);
        for k in 1000..3990 {
            sum += force[k] * a[k];
            square += a[k] * a[k];
        }
        let ratio: f64 = 3.0 / 20.0;
        let apparent = 3.0 + 1.0 / (1.0 - ratio * ratio);
        assert!((sum / square - apparent).abs() < 0.01, "{} {apparent}", sum / square);
    }
}
