//! Friction and thirteen harmonics of a motor's cogging: thirty parameters.

use std::f64::consts::TAU;

use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "cogging",
    subject: "thirteen harmonics of cogging (amplitude and phase), and the Stribeck curve, from torque",
    character: "thirty parameters; phases are periodic, each has its best twice",
    reference: "P. J. Hor et al., Minimization of cogging force in a linear permanent magnet motor, IEEE Trans. \
                Magnetics 34, 1998",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Cogging::new()),
};

const AMPLITUDES: (f64, f64) = (0.0, 0.5);
/// Twice around, so that a search need not turn back where a phase begins anew.
const PHASES: (f64, f64) = (-TAU, TAU);

const fn amplitude(name: &'static str, truth: f64) -> Parameter {
    linear(name, "N m", truth, AMPLITUDES)
}

const fn phase(name: &'static str, truth: f64) -> Parameter {
    linear(name, "rad", truth, PHASES)
}

const PARAMETERS: &[Parameter] = &[
    linear("coulomb", "N m", 0.4, (0.0, 2.0)),
    linear("viscous", "N m s/rad", 0.03, (0.0, 0.3)),
    linear("stribeck", "N m", 0.25, (0.0, 2.0)),
    decades("stribeck_velocity", "rad/s", 0.3, (1e-2, 1e1)),
    amplitude("a1", 0.21),
    phase("phase1", 0.4),
    amplitude("a2", 0.12),
    phase("phase2", -1.9),
    amplitude("a3", 0.05),
    phase("phase3", 2.2),
    amplitude("a4", 0.17),
    phase("phase4", -0.3),
    amplitude("a5", 0.03),
    phase("phase5", 1.1),
    amplitude("a6", 0.26),
    phase("phase6", -2.4),
    amplitude("a7", 0.04),
    phase("phase7", 0.9),
    amplitude("a8", 0.08),
    phase("phase8", -1.2),
    amplitude("a9", 0.06),
    phase("phase9", 1.7),
    amplitude("a10", 0.03),
    phase("phase10", -0.8),
    amplitude("a11", 0.09),
    phase("phase11", 2.0),
    amplitude("a12", 0.31),
    phase("phase12", -1.5),
    amplitude("a13", 0.04),
    phase("phase13", 0.2),
];

const BEST: Best = Best {
    cost: 393.2195629894679,
    position: &[
        0.40110396614602045,
        0.02849154916571314,
        0.24858606055670085,
        0.2950573014892633,
        0.20925706810412742,
        0.41218525755845514,
        0.12018704406423919,
        -1.900910961243659,
        0.050314075793739,
        2.2029750566163484,
        0.16913507481280585,
        -0.2928085897464451,
        0.030936298181874426,
        1.080101792282549,
        0.2585114454225923,
        -2.400499508728498,
        0.0407834472076167,
        0.9757331780079357,
        0.0766130546461172,
        -1.1949583200688099,
        0.05962001380539889,
        1.7035274483348728,
        0.03019853415600377,
        -0.7950433501383737,
        0.09055488425771165,
        2.0076000424807146,
        0.31048573962662407,
        -1.4965204269732197,
        0.03983521907625922,
        0.13027582246814012,
    ],
};

const HARMONICS: usize = 13;
const SAMPLES: usize = 400;
/// Of a revolution.
const STROKE: f64 = 1.3;
/// N m.
const SENSOR: f64 = 0.02;

/// One sample: velocity, and cosine and sine of every harmonic of the angle.
struct Sample {
    velocity: f64,
    waves: [(f64, f64); HARMONICS],
}

struct Cogging {
    samples: Vec<Sample>,
}

impl Cogging {
    fn new() -> Self {
        let sample = |i: usize| {
            let t = i as f64 * 0.05;
            let angle = 0.5 * STROKE * TAU * (0.8 * (0.61 * t).sin() + 0.2 * (1.7 * t).sin());
            let velocity =
                0.5 * STROKE * TAU * (0.8 * 0.61 * (0.61 * t).cos() + 0.2 * 1.7 * (1.7 * t).cos());
            let wave = |k: usize| ((k + 1) as f64 * angle).sin_cos();
            Sample { velocity, waves: std::array::from_fn(wave) }
        };
        Self { samples: (0..SAMPLES).map(sample).collect() }
    }
}

impl Model for Cogging {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let (friction, harmonics) = p.split_at(4);
        // a sin(k angle + phase), over the sine and the cosine of k angle.
        let mut parts = [(0.0, 0.0); HARMONICS];
        for (part, pair) in parts.iter_mut().zip(harmonics.chunks_exact(2)) {
            let (sin, cos) = pair[1].sin_cos();
            *part = (pair[0] * cos, pair[0] * sin);
        }
        for Sample { velocity, waves } in &self.samples {
            let slip = velocity / friction[3];
            let level = friction[0] + friction[2] * (-slip * slip).exp();
            let cogging: f64 = parts.iter().zip(waves).map(|(p, w)| p.0 * w.0 + p.1 * w.1).sum();
            out.push((level * velocity.signum() + friction[1] * velocity + cogging) / SENSOR);
        }
    }
}
