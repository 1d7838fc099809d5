//! A linear axis in windows of a recording.

use aep_core::Purpose;
use aep_core::random::{self, Streams};

use super::identification::disturb;
use super::integrate::rubbed;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "axis-in-windows",
    subject: "mass and Stribeck curve of a linear axis from its position in windows of 40 ms of a recording, \
              each started from what was measured",
    character: "six parameters, Stribeck effect in a few windows only, measured starts",
    reference: "model of A. Janot, M. Gautier, M. Brunot, Data Set and Reference Models of EMPS, 2019",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Windows::recorded()),
};

const PARAMETERS: &[Parameter] = &[
    linear("mass", "kg", 95.0, (20.0, 400.0)),
    linear("viscous", "N s/m", 203.0, (0.0, 2000.0)),
    linear("coulomb", "N", 20.0, (0.0, 100.0)),
    linear("stribeck", "N", 12.0, (0.0, 100.0)),
    decades("stribeck_velocity", "m/s", 5e-3, (1e-4, 1.0)),
    linear("offset", "N", -3.2, (-30.0, 30.0)),
];

const BEST: Best = Best {
    cost: 1309.3921222406027,
    position: &[
        95.01631121308749,
        203.93972839262335,
        19.94802604272614,
        11.956982684430358,
        0.00495537901515549,
        -3.255921850034415,
    ],
};

const STEP: f64 = 1e-3;
const WINDOW: usize = 40;
const WINDOWS: usize = 25;
/// Steps from the start of a window to the next one.
const APART: usize = 160;
const SENSOR: f64 = 2e-6;
/// Of the velocity at the start of a window, m/s.
const VELOCITY_ERROR: f64 = 5e-5;

/// What was measured: a force at each step; position and velocity at the start of each window.
struct Windows {
    forces: Vec<f64>,
    starts: Vec<[f64; 2]>,
    positions: Vec<f64>,
}

fn step(p: &[f64], [x, v]: [f64; 2], force: f64) -> [f64; 2] {
    let stribeck = p[3] * (-(v / p[4]) * (v / p[4])).exp();
    let free = v + STEP * (force - p[1] * v - p[5]) / p[0];
    let v = rubbed(free, STEP * (p[2] + stribeck) / p[0]);
    [x + STEP * v, v]
}

impl Windows {
    /// A slow and a fast oscillation together, under control of position and velocity.
    fn recorded() -> Self {
        let truth = TASK.truth();
        let mut rng = Streams::new(1, Purpose::Trial, 0).stream(0);
        let (mut state, mut recorded) =
            ([0.0; 2], Self { forces: Vec::new(), starts: Vec::new(), positions: Vec::new() });
        for i in 0..WINDOWS * APART {
            let t = i as f64 * STEP;
            let desired = 0.05 * (1.3 * t).sin() + 0.006 * (6.1 * t).sin();
            let velocity = 0.065 * (1.3 * t).cos() + 0.0366 * (6.1 * t).cos();
            let force = 4e4 * (desired - state[0]) + 2.5e3 * (velocity - state[1]);
            let in_window = i % APART;
            if in_window == 0 {
                let error = VELOCITY_ERROR * random::normal::<f64>(&mut rng);
                recorded.starts.push([state[0], state[1] + error]);
            }
            state = step(&truth, state, force);
            if in_window < WINDOW {
                recorded.forces.push(force);
                recorded.positions.push(state[0] / SENSOR);
            }
        }
        disturb(&mut recorded.positions, 1.0, &mut rng);
        recorded
    }
}

impl Model for Windows {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        for (start, forces) in self.starts.iter().zip(self.forces.chunks(WINDOW)) {
            let mut state = *start;
            for force in forces {
                state = step(p, state, *force);
                out.push(state[0] / SENSOR);
            }
        }
    }

    fn recording(&self) -> Option<Vec<f64>> {
        Some(self.positions.clone())
    }
}
