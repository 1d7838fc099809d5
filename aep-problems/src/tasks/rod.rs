//! A heated rod, by a simulator with a fixed step that fails in half of the domain.

use super::task::{Best, Model, Parameter, Task, decades};

pub const TASK: Task = Task {
    name: "failing-rod",
    subject: "conduction, capacity, losses and sensor lag of a rod heated at its end",
    character: "the explicit simulator fails (NaN) where conduction is quick against capacity: about half of the domain",
    reference: "R. Courant, K. Friedrichs, H. Lewy, Mathematische Annalen 100, 1928",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Rod),
};

const PARAMETERS: &[Parameter] = &[
    decades("conductance", "W/K", 1.3, (1e-2, 1e2)),
    decades("capacity", "J/K", 4.2, (1e-2, 5e2)),
    decades("loss", "W/K", 0.011, (1e-4, 1.0)),
    decades("sensor_lag", "s", 3.0, (1.0, 50.0)),
];

const BEST: Best = Best {
    cost: 621.6656384688637,
    position: &[1.2999884906940273, 4.201961459501571, 0.010993424811265447, 2.9828545638001516],
};

const STEP: f64 = 1.0;
const SAMPLES: usize = 300;
const NODES: usize = 8;
/// W.
const HEATER: f64 = 9.0;
/// K.
const SENSOR: f64 = 0.05;
/// Warmer than any rod, K: the simulation has left physics.
const MELTED: f64 = 1e5;

struct Rod;

impl Model for Rod {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [conductance, capacity, loss, lag] = *p else { return };
        let (mut rod, mut near, mut far) = ([0.0_f64; NODES], 0.0, 0.0);
        for sample in 0..SAMPLES {
            let heated = if sample % 140 < 60 { HEATER } else { 0.0 };
            let before = rod;
            for (i, node) in rod.iter_mut().enumerate() {
                let towards = |j: usize| conductance * (before[j] - before[i]);
                let left = if i == 0 { heated } else { towards(i - 1) };
                let right = if i + 1 == NODES { 0.0 } else { towards(i + 1) };
                *node += STEP / capacity * (left + right - loss * before[i]);
            }
            if !rod.iter().all(|node| node.abs() < MELTED) {
                out.resize(out.len() + 2 * (SAMPLES - sample), f64::NAN);
                return;
            }
            near += STEP / lag * (rod[1] - near);
            far += STEP / lag * (rod[NODES - 2] - far);
            out.push(near / SENSOR);
            out.push(far / SENSOR);
        }
    }
}
