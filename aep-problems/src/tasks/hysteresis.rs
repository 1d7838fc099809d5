//! A vibrating mass with hysteresis.

use super::integrate::runge_kutta;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "hysteresis",
    subject: "a Bouc-Wen oscillator from its displacement under a multisine",
    character: "spring and hysteresis trade off; a resonance",
    reference: "J.-P. Noël, M. Schoukens, Hysteretic benchmark with a dynamic nonlinearity, 2016",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(BoucWen),
};

/// As the benchmark has them.
const PARAMETERS: &[Parameter] = &[
    linear("mass", "kg", 2.0, (0.5, 8.0)),
    linear("damping", "N s/m", 10.0, (0.0, 100.0)),
    decades("spring", "N/m", 5e4, (5e3, 2e5)),
    decades("hysteretic", "N/m", 5e4, (5e3, 2e5)),
    linear("loop", "1/m", 800.0, (0.0, 4000.0)),
    linear("bulge", "1/m", -1100.0, (-4000.0, 4000.0)),
];

const BEST: Best = Best {
    cost: 661.2751150598892,
    position: &[
        2.0003160476217445,
        9.880293529931798,
        50011.99029428044,
        49994.65664594199,
        801.368174628994,
        -1101.4217698984376,
    ],
};

const STEP: f64 = 1.0 / 750.0;
const SAMPLES: usize = 600;
/// m.
const SENSOR: f64 = 2e-6;

struct BoucWen;

/// N.
fn force(t: f64) -> f64 {
    let tone = |hz: f64, phase: f64| (std::f64::consts::TAU * hz * t + phase).sin();
    30.0 * (tone(9.0, 0.0) + tone(17.0, 1.1) + tone(26.0, 2.9) + tone(33.0, 0.4) + tone(47.0, 5.0))
}

impl Model for BoucWen {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [mass, damping, spring, hysteretic, around, bulge] = *p else { return };
        let mut state = [0.0_f64; 3];
        for sample in 0..SAMPLES {
            let force = force((sample as f64 + 0.5) * STEP);
            state = runge_kutta(state, STEP, |[x, v, z]| {
                let slope = hysteretic * v - around * v.abs() * z - bulge * v * z.abs();
                [v, (force - damping * v - spring * x - z) / mass, slope]
            });
            out.push(state[0] / SENSOR);
        }
    }
}
