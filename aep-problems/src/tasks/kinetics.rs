//! Robertson's reaction: a stiff equation.

use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "stiff-kinetics",
    subject: "three rates of Robertson's reaction and the gains of two sensors",
    character: "rates over nine decades; a flat cost wherever a rate is far off",
    reference: "H. H. Robertson, The solution of a set of reaction rate equations, 1966; steps by Rosenbrock's \
                method of J. G. Verwer et al., SIAM J. Sci. Comput. 20, 1999",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Robertson),
};

const PARAMETERS: &[Parameter] = &[
    decades("slow", "1/s", 0.04, (1e-4, 1e2)),
    decades("fast", "1/s", 3e7, (1e4, 1e10)),
    decades("back", "1/s", 1e4, (1e1, 1e7)),
    linear("gain_a", "1", 0.9, (0.2, 3.0)),
    decades("gain_b", "1", 2e4, (1e2, 1e6)),
];

const BEST: Best = Best {
    cost: 204.36767027467664,
    position: &[
        0.03985965105936467,
        29677524.232235022,
        9840.321098956045,
        0.8995591057905032,
        19934.043957641086,
    ],
};

/// Time of the first sample, s, and the factor from one to the next.
const TIMES: (f64, f64) = (1e-4, 1.26);
const SAMPLES: usize = 90;
const STEPS_PER_SAMPLE: usize = 3;
const SENSOR: f64 = 0.005;

struct Robertson;

/// One step of ROS2, which damps what is fast: two stages with one matrix I - gamma h J.
fn step([a, b]: [f64; 2], h: f64, p: &[f64]) -> [f64; 2] {
    const GAMMA: f64 = 1.0 + std::f64::consts::FRAC_1_SQRT_2;
    let slope = |a: f64, b: f64| {
        let (slow, fast, back) = (p[0] * a, p[1] * b * b, p[2] * b * (1.0 - a - b));
        [back - slow, slow - fast - back]
    };
    // Derivatives of `back` by a and b.
    let (by_a, by_b) = (-p[2] * b, p[2] * (1.0 - a - 2.0 * b));
    let jacobian = [[by_a - p[0], by_b], [p[0] - by_a, -2.0 * p[1] * b - by_b]];
    let of = |i: usize, j: usize| f64::from(u8::from(i == j)) - GAMMA * h * jacobian[i][j];
    let determinant = of(0, 0) * of(1, 1) - of(0, 1) * of(1, 0);
    let solve = |r: [f64; 2]| {
        [
            (of(1, 1) * r[0] - of(0, 1) * r[1]) / determinant,
            (of(0, 0) * r[1] - of(1, 0) * r[0]) / determinant,
        ]
    };
    let first = solve(slope(a, b));
    let middle = slope(a + h * first[0], b + h * first[1]);
    let second = solve([middle[0] - 2.0 * first[0], middle[1] - 2.0 * first[1]]);
    [a + h * (1.5 * first[0] + 0.5 * second[0]), b + h * (1.5 * first[1] + 0.5 * second[1])]
}

impl Model for Robertson {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let (mut state, mut time, mut before) = ([1.0, 0.0], TIMES.0, 0.0);
        for _ in 0..SAMPLES {
            let h = (time - before) / STEPS_PER_SAMPLE as f64;
            for _ in 0..STEPS_PER_SAMPLE {
                state = step(state, h, p);
            }
            out.push(p[3] * state[0] / SENSOR);
            out.push(p[4] * state[1] / SENSOR);
            (before, time) = (time, time * TIMES.1);
        }
    }
}
