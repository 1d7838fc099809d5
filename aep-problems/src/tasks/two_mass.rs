//! Two masses with backlash between them.

use super::integrate::rubbed;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "two-mass",
    subject: "inertias, shaft, backlash and friction of two masses from the motor's velocity",
    character: "a resonance that the cost must find before anything else counts; backlash hides the stiffness",
    reference: "M. Nordin, P.-O. Gutman, Controlling mechanical systems with backlash, Automatica 38, 2002; contact of \
                K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42, 1975",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(TwoMass),
};

const PARAMETERS: &[Parameter] = &[
    decades("motor_inertia", "kg m^2", 4e-3, (1e-3, 4e-2)),
    decades("load_inertia", "kg m^2", 1.1e-2, (1e-3, 1e-1)),
    decades("stiffness", "N m/rad", 120.0, (5.0, 2e3)),
    decades("dissipation", "s/rad", 0.06, (1e-3, 2.0)),
    linear("backlash", "rad", 0.012, (0.0, 0.1)),
    linear("motor_viscous", "N m s/rad", 0.03, (0.0, 0.3)),
    linear("load_coulomb", "N m", 0.15, (0.0, 1.0)),
];

const BEST: Best = Best {
    cost: 862.3677791543469,
    position: &[
        0.003999061552756115,
        0.011006799502902651,
        120.11792152786224,
        0.06024627411761485,
        0.01202664353568986,
        0.02993879491304841,
        0.1502605037919793,
    ],
};

const STEP: f64 = 5e-4;
const STEPS_PER_SAMPLE: usize = 4;
const SAMPLES: usize = 800;
/// rad/s.
const SENSOR: f64 = 0.05;

struct TwoMass;

/// A swept sine with a slow reversal below it, N m.
fn drive(t: f64) -> f64 {
    let sweep = 2.0 * std::f64::consts::PI * (2.0 * t + 12.0 * t * t);
    0.8 * sweep.sin() + 0.6 * (7.0 * t).sin()
}

impl Model for TwoMass {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [motor, load, stiffness, dissipation, gap, viscous, coulomb] = *p else { return };
        let half = 0.5 * gap;
        // Velocities, and the angle of the motor before that of the load.
        let (mut of_motor, mut of_load, mut twist) = (0.0_f64, 0.0_f64, half);
        for sample in 0..SAMPLES {
            let torque = drive((sample * STEPS_PER_SAMPLE) as f64 * STEP);
            for _ in 0..STEPS_PER_SAMPLE {
                let wound = rubbed(twist, half);
                let inwards = (of_motor - of_load) * wound.signum();
                let shaft = stiffness * wound * (1.0 + dissipation * inwards).max(0.0);
                of_motor =
                    (of_motor + STEP / motor * (torque - shaft)) / (1.0 + STEP / motor * viscous);
                of_load = rubbed(of_load + STEP / load * shaft, STEP / load * coulomb);
                twist += STEP * (of_motor - of_load);
            }
            out.push(of_motor / SENSOR);
        }
    }
}
