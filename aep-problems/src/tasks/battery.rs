//! A battery as a circuit.

use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "battery",
    subject: "resistances and capacitances of a cell from its voltage under pulses of current",
    character: "two time constants that can change places; the slow one trades off with the charge at the start",
    reference: "G. L. Plett, Extended Kalman filtering for battery management systems, J. Power Sources 134, 2004",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Battery),
};

const PARAMETERS: &[Parameter] = &[
    decades("series", "ohm", 0.031, (1e-3, 1.0)),
    decades("first_resistance", "ohm", 0.018, (1e-3, 1.0)),
    decades("first_capacitance", "F", 800.0, (1e1, 1e6)),
    decades("second_resistance", "ohm", 0.04, (1e-3, 1.0)),
    decades("second_capacitance", "F", 9e3, (1e1, 1e6)),
    linear("charge", "1", 0.72, (0.0, 1.0)),
    decades("capacity", "A h", 2.3, (0.5, 10.0)),
];

const BEST: Best = Best {
    cost: 588.9645861349702,
    position: &[
        0.030949167872011275,
        0.037319766915392946,
        9051.09405641122,
        0.01795495408150721,
        798.1475505514896,
        0.7202246392256892,
        2.245292799623062,
    ],
};

const STEP: f64 = 2.0;
const SAMPLES: usize = 600;
/// V.
const SENSOR: f64 = 1e-3;

struct Battery;

/// Pulses of discharge and rests, one charge, A.
fn current(sample: usize) -> f64 {
    match sample % 150 {
        0..20 => 2.0,
        50..60 => 4.0,
        90..110 => -1.5,
        120..124 => 6.0,
        _ => 0.0,
    }
}

/// Voltage at rest over the charge, V.
fn open_circuit(charge: f64) -> f64 {
    3.2 + 0.9 * charge - 0.25 * (-12.0 * charge.max(-0.2)).exp() + 0.08 * (charge - 0.5).powi(3)
}

impl Model for Battery {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let [series, r1, c1, r2, c2, mut charge, capacity] = *p else { return };
        let (keep1, keep2) = ((-STEP / (r1 * c1)).exp(), (-STEP / (r2 * c2)).exp());
        let (mut u1, mut u2) = (0.0, 0.0);
        for sample in 0..SAMPLES {
            let current = current(sample);
            out.push((open_circuit(charge) - u1 - u2 - series * current) / SENSOR);
            u1 = keep1 * u1 + (1.0 - keep1) * r1 * current;
            u2 = keep2 * u2 + (1.0 - keep2) * r2 * current;
            charge -= STEP * current / (3600.0 * capacity);
        }
    }
}
