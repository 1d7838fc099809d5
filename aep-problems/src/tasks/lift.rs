//! A small servo that lifts an arm.

use super::integrate::rubbed;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "lift",
    subject: "inertia, motor, damping and load-dependent friction of a small servo that lifts a known mass",
    character: "friction against gravity: motor constant, Coulomb and load friction trade off",
    reference: "model of G. Duclusaud et al., Extended friction models for the physics simulation of servo \
                actuators, 2024",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Lift),
};

const PARAMETERS: &[Parameter] = &[
    decades("inertia", "kg m^2", 3.2e-3, (3e-4, 3e-2)),
    linear("motor", "N m/V", 0.11, (0.02, 0.4)),
    linear("damping", "N m s/rad", 0.06, (0.0, 0.4)),
    linear("coulomb", "N m", 0.022, (0.0, 0.2)),
    linear("load", "1", 0.13, (0.0, 0.6)),
    linear("stribeck", "N m", 0.035, (0.0, 0.2)),
    decades("stribeck_velocity", "rad/s", 0.25, (1e-2, 10.0)),
    linear("horn", "rad", 0.03, (-0.3, 0.3)),
];

const BEST: Best = Best {
    cost: 462.94991867022554,
    position: &[
        0.003173243717210173,
        0.10992331961944571,
        0.05939514414538506,
        0.021901871467429904,
        0.13758750250873966,
        0.03524779878154868,
        0.2401632865505437,
        0.030173489469589865,
    ],
};

const STEP: f64 = 4e-3;
const STEPS_PER_SAMPLE: usize = 2;
const SAMPLES: usize = 500;
/// rad.
const SENSOR: f64 = 1.5e-3;
/// Weight of the known mass at its lever, N m.
const GRAVITY: f64 = 0.16;
/// Proportional control, V/rad, and the supply.
const CONTROL: (f64, f64) = (14.0, 6.0);

struct Lift;

fn desired(t: f64) -> f64 {
    if t < 2.0 { 0.8 * (4.0 * t).sin() } else { 0.9 * (1.2 * t + 0.5 * t * t).sin() - 0.3 }
}

impl Model for Lift {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [inertia, motor, damping, coulomb, load, stribeck, slow, horn] = *p else { return };
        let (mut q, mut v) = (0.0_f64, 0.0_f64);
        for sample in 0..SAMPLES {
            let t = (sample * STEPS_PER_SAMPLE) as f64 * STEP;
            let torque = motor * (CONTROL.0 * (desired(t) - q)).clamp(-CONTROL.1, CONTROL.1);
            for _ in 0..STEPS_PER_SAMPLE {
                let weight = GRAVITY * (q + horn).cos();
                let transmitted = (torque - weight).abs();
                let slip = (v / slow).abs();
                let most = coulomb + load * transmitted + stribeck * (-slip).exp();
                let free = v + STEP / inertia * (torque - weight);
                v = rubbed(free, STEP / inertia * most) / (1.0 + STEP / inertia * damping);
                q += STEP * v;
            }
            out.push(q / SENSOR);
        }
    }
}
