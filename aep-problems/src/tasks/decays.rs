//! Two exponential decays.

use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "two-decays",
    subject: "amounts, rates and background of two decays from their sum",
    character: "the two can change places; a ridge of sums that look like one decay",
    reference: "C. Lanczos, Applied Analysis, 1956",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Decays),
};

const PARAMETERS: &[Parameter] = &[
    decades("first_amount", "1", 3.0, (1e-3, 1e3)),
    decades("first_rate", "1/s", 0.4, (1e-3, 1e3)),
    decades("second_amount", "1", 2.0, (1e-3, 1e3)),
    decades("second_rate", "1/s", 1.7, (1e-3, 1e3)),
    linear("background", "1", 0.3, (-5.0, 5.0)),
];

const BEST: Best = Best {
    cost: 160.72871794073333,
    position: &[
        2.935475131087051,
        0.396179662762503,
        2.0598236460135917,
        1.6315403174823344,
        0.3004400590938579,
    ],
};

const STEP: f64 = 0.05;
const SAMPLES: usize = 200;
const SENSOR: f64 = 0.02;

struct Decays;

impl Model for Decays {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let (first, second) = ((-p[1] * STEP).exp(), (-p[3] * STEP).exp());
        let (mut a, mut b) = (p[0], p[2]);
        for _ in 0..SAMPLES {
            out.push((a + b + p[4]) / SENSOR);
            a *= first;
            b *= second;
        }
    }
}
