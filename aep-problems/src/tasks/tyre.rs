//! A tyre by the magic formula.

use super::task::{Best, Model, Parameter, Task, linear};

pub const TASK: Task = Task {
    name: "tyre",
    subject: "lateral force of a tyre over its slip angle",
    character: "shape, stiffness and curvature trade off along a bent ridge",
    reference: "H. B. Pacejka, E. Bakker, The magic formula tyre model, Vehicle System Dynamics 21, 1992",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Tyre),
};

const PARAMETERS: &[Parameter] = &[
    linear("stiffness", "1/rad", 9.5, (1.0, 40.0)),
    linear("shape", "1", 1.35, (0.5, 3.0)),
    linear("peak", "N", 3900.0, (500.0, 10_000.0)),
    linear("curvature", "1", -0.4, (-10.0, 1.0)),
    linear("shift_angle", "rad", 0.006, (-0.1, 0.1)),
    linear("shift_force", "N", -60.0, (-1000.0, 1000.0)),
];

const BEST: Best = Best {
    cost: 234.67666630688421,
    position: &[
        9.157788442089425,
        1.3865343428767292,
        3910.2415837583953,
        -0.3432199025679954,
        0.005886920012676813,
        -64.54682405265153,
    ],
};

const SAMPLES: usize = 240;
/// Largest slip angle, rad.
const WIDEST: f64 = 0.3;
/// N.
const SENSOR: f64 = 60.0;

struct Tyre;

impl Model for Tyre {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [stiffness, shape, peak, curvature, angle, force] = *p else { return };
        for sample in 0..SAMPLES {
            let slip = WIDEST * (2.0 * sample as f64 / (SAMPLES - 1) as f64 - 1.0) + angle;
            let x = stiffness * slip;
            let bent = x - curvature * (x - x.atan());
            out.push((peak * (shape * bent.atan()).sin() + force) / SENSOR);
        }
    }
}
