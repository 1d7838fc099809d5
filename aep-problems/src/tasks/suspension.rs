//! A quarter of a car, by a simulator that never gives the same twice.

use super::integrate::runge_kutta;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "noisy-suspension",
    subject: "wheel, springs and dampers of a quarter car of known weight from the acceleration of body and wheel over a bump",
    character: "the simulator adds its own noise, another one at each position; solved is judged without it",
    reference: "R. S. Sharp, D. A. Crolla, Road vehicle suspension system design, Vehicle System Dynamics 16, 1987",
    parameters: PARAMETERS,
    noise: 0.1,
    tolerance: 1e-2,
    best: BEST,
    model: || Box::new(Suspension),
};

const PARAMETERS: &[Parameter] = &[
    linear("wheel", "kg", 38.0, (10.0, 120.0)),
    decades("spring", "N/m", 2.1e4, (2e3, 2e5)),
    decades("damper", "N s/m", 1.4e3, (1e2, 1e4)),
    decades("tyre", "N/m", 1.9e5, (2e4, 2e6)),
    decades("tyre_damper", "N s/m", 150.0, (1.0, 1e4)),
];

const BEST: Best = Best {
    cost: 564.4109065204841,
    position: &[
        37.76084756159329,
        21044.463471533258,
        1404.3198553684651,
        189377.72422483817,
        146.60207999686725,
    ],
};

const STEP: f64 = 4e-3;
/// kg.
const BODY: f64 = 310.0;
const SAMPLES: usize = 300;
/// m/s^2, of body and wheel.
const SENSORS: (f64, f64) = (0.1, 1.0);

struct Suspension;

/// A bump of 5 cm within 0.15 s, then a washboard.
fn road(t: f64) -> f64 {
    let bump =
        if t < 0.15 { 0.025 * (1.0 - (t / 0.15 * std::f64::consts::TAU).cos()) } else { 0.0 };
    bump + if t > 0.6 { 0.004 * (50.0 * t * t).sin() } else { 0.0 }
}

impl Model for Suspension {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [wheel, spring, damper, tyre, tyre_damper] = *p else { return };
        let accelerations = |[z, v, zw, vw]: [f64; 4], (ground, rate): (f64, f64)| {
            let strut = spring * (zw - z) + damper * (vw - v);
            let contact = tyre * (ground - zw) + tyre_damper * (rate - vw);
            (strut / BODY, (contact - strut) / wheel)
        };
        let mut state = [0.0; 4];
        for sample in 0..SAMPLES {
            let t = sample as f64 * STEP;
            let ground = (road(t), (road(t + STEP) - road(t)) / STEP);
            state = runge_kutta(state, STEP, |x| {
                let (of_body, of_wheel) = accelerations(x, ground);
                [x[1], of_body, x[3], of_wheel]
            });
            let (of_body, of_wheel) = accelerations(state, ground);
            out.push(of_body / SENSORS.0);
            out.push(of_wheel / SENSORS.1);
        }
    }
}
