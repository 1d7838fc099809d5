//! A quarter of a car, by a simulator that never gives the same twice.

use super::integrate::runge_kutta;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "noisy-suspension",
    subject: "masses, springs and dampers of a quarter car from the acceleration of body and wheel over a bump",
    character: "the simulator adds its own noise, another one at each position; solved is judged without it",
    reference: "R. S. Sharp, D. A. Crolla, Road vehicle suspension system design, Vehicle System Dynamics 16, 1987",
    parameters: PARAMETERS,
    noise: 0.1,
    tolerance: 1e-2,
    best: BEST,
    model: || Box::new(Suspension),
};

const PARAMETERS: &[Parameter] = &[
    linear("body", "kg", 310.0, (100.0, 800.0)),
    linear("wheel", "kg", 38.0, (10.0, 120.0)),
    decades("spring", "N/m", 2.1e4, (2e3, 2e5)),
    decades("damper", "N s/m", 1.4e3, (1e2, 1e4)),
    decades("tyre", "N/m", 1.9e5, (2e4, 2e6)),
];

const BEST: Best = Best { cost: 1.0, position: &[310.0, 38.0, 2.1e4, 1.4e3, 1.9e5] };

const STEP: f64 = 4e-3;
const SAMPLES: usize = 300;
/// m/s^2, of body and wheel.
const SENSORS: (f64, f64) = (0.1, 1.0);

struct Suspension;

/// A bump of 5 cm within 0.15 s, then a washboard.
fn road(t: f64) -> f64 {
    let bump = if t < 0.15 { 0.025 * (1.0 - (t / 0.15 * std::f64::consts::TAU).cos()) } else { 0.0 };
    bump + if t > 0.6 { 0.004 * (50.0 * t * t).sin() } else { 0.0 }
}

impl Model for Suspension {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [body, wheel, spring, damper, tyre] = *p else { return };
        let accelerations = |[z, v, zw, vw]: [f64; 4], ground: f64| {
            let strut = spring * (zw - z) + damper * (vw - v);
            (strut / body, (tyre * (ground - zw) - strut) / wheel)
        };
        let mut state = [0.0; 4];
        for sample in 0..SAMPLES {
            let ground = road(sample as f64 * STEP);
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
