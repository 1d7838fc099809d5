//! A closed loop that runs free: only the desired position is known.

use super::integrate::{Delay, rubbed};
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "closed-loop",
    subject: "plant and delay of a position loop from position and commanded force, simulated free from the \
              desired position",
    character: "control hides the plant; long delays make the loop unstable, where the cost says nothing",
    reference: "U. Forssell, L. Ljung, Closed-loop identification revisited, Automatica 35, 1999",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(ClosedLoop),
};

const PARAMETERS: &[Parameter] = &[
    decades("mass", "kg", 6.0, (0.5, 60.0)),
    linear("viscous", "N s/m", 40.0, (0.0, 400.0)),
    linear("coulomb", "N", 5.0, (0.0, 40.0)),
    decades("actuator", "s", 3e-3, (5e-4, 5e-2)),
    linear("delay", "s", 4e-3, (0.0, 0.03)),
    linear("cable", "N/m", 150.0, (0.0, 2000.0)),
];

const BEST: Best = Best {
    cost: 787.7041776060856,
    position: &[
        5.998870815198725,
        40.17028058527478,
        4.987286364732266,
        0.002912805968531844,
        0.004091859357732736,
        150.40721209583674,
    ],
};

const STEP: f64 = 1e-3;
const STEPS_PER_SAMPLE: usize = 4;
const SAMPLES: usize = 400;
/// m and N.
const SENSORS: (f64, f64) = (2e-5, 0.5);
/// Position to velocity, velocity to force, its integral; and the force at most.
const CONTROL: (f64, f64, f64, f64) = (25.0, 350.0, 6e3, 200.0);

struct ClosedLoop;

/// Steps to and fro, rounded.
fn desired(t: f64) -> f64 {
    0.02 * (5.0 * t).sin() + 0.01 * (4.0 * (11.0 * t).sin()).tanh()
}

impl Model for ClosedLoop {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [mass, viscous, coulomb, actuator, delay, cable] = *p else { return };
        let (mut x, mut v, mut force, mut integral) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut commands = Delay::<64>::new();
        let lag = 1.0 - (-STEP / actuator).exp();
        for sample in 0..SAMPLES {
            let error = CONTROL.0 * (desired((sample * STEPS_PER_SAMPLE) as f64 * STEP) - x) - v;
            integral = (integral + CONTROL.2 * STEP * STEPS_PER_SAMPLE as f64 * error)
                .clamp(-CONTROL.3, CONTROL.3);
            let command = (CONTROL.1 * error + integral).clamp(-CONTROL.3, CONTROL.3);
            for _ in 0..STEPS_PER_SAMPLE {
                commands.push(command);
                force += lag * (commands.ago(delay / STEP) - force);
                let free = v + STEP / mass * (force - cable * x);
                v = rubbed(free, STEP / mass * coulomb) / (1.0 + STEP / mass * viscous);
                x += STEP * v;
            }
            out.push(x / SENSORS.0);
            out.push(command / SENSORS.1);
        }
    }
}
