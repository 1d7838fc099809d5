//! The table of the paper on accelerated evolutionary programming, with its friction model.

use super::integrate::Delay;
use super::task::{Best, Model, Parameter, Task, decades, linear};

pub const TASK: Task = Task {
    name: "table",
    subject: "mass and seven friction parameters of a screw-driven table from its position under PD control",
    character: "stick and slip make the cost rough; rising static friction and delayed Stribeck effect trade off",
    reference: "J.-H. Kim et al., IEEE Control Systems Magazine, 1996; B. Armstrong-Helouvry et al., \
                Automatica 30, 1994",
    parameters: PARAMETERS,
    noise: 0.0,
    tolerance: 1e-3,
    best: BEST,
    model: || Box::new(Table),
};

/// As the paper identified them, but for the Stribeck velocity, the rise time of the static friction
/// and the stiffness, which its 5 ms and its encoder could not show.
const PARAMETERS: &[Parameter] = &[
    linear("mass", "kg", 33.3, (10.0, 80.0)),
    linear("coulomb", "N", 3.96, (0.0, 15.0)),
    linear("viscous", "N s/m", 416.0, (0.0, 1500.0)),
    linear("stribeck", "N", 6.0, (0.0, 20.0)),
    decades("rise_time", "s", 0.1, (1e-3, 10.0)),
    linear("memory", "s", 0.012, (0.0, 0.04)),
    decades("stribeck_velocity", "m/s", 1e-3, (1e-5, 1e-1)),
    decades("stiffness", "N/m", 2e6, (2e5, 2e7)),
];

const BEST: Best = Best {
    cost: 742.466000100834,
    position: &[
        33.46762363811769,
        3.885229306452588,
        421.62661436047483,
        6.077656909279203,
        0.11026298862903834,
        0.012005788890364383,
        0.0010195657507962154,
        1993720.7080422898,
    ],
};

const STEP: f64 = 1e-3;
const STEPS_PER_SAMPLE: usize = 5;
const SAMPLES: usize = 700;
const ENCODER: f64 = 2e-6;
/// N/m and N s/m: stable with 33 kg at 5 ms.
const GAINS: (f64, f64) = (2e5, 2e3);

struct Table;

/// Two slow ramps with stick and slip, then a fast oscillation.
fn desired(t: f64) -> (f64, f64) {
    const FAST: f64 = 2.0 * std::f64::consts::PI;
    if t < 1.2 {
        (2e-4 * t, 2e-4)
    } else if t < 2.0 {
        (2.4e-4 - 5e-4 * (t - 1.2), -5e-4)
    } else {
        let (sin, cos) = (FAST * (t - 2.0)).sin_cos();
        (-1.6e-4 + 3e-3 * sin, 3e-3 * FAST * cos)
    }
}

/// Contact at rest and in motion. Static friction rises with the time at rest from what friction was
/// when the last slip ended; the Stribeck effect follows the velocity with a delay.
struct Contact<'a> {
    p: &'a [f64],
    /// Where the spring of the contact is relaxed, while at rest.
    anchor: Option<f64>,
    at_rest: f64,
    last: f64,
    level: f64,
    velocities: Delay<64>,
}

impl Contact<'_> {
    fn static_level(&self) -> f64 {
        self.last + (self.p[3] - self.last) * self.at_rest / (self.at_rest + self.p[4])
    }

    fn stribeck(&self) -> f64 {
        let velocity = self.velocities.ago(self.p[5] / STEP);
        self.level / (1.0 + (velocity / self.p[6]).powi(2))
    }

    fn force(&mut self, x: f64, v: f64) -> f64 {
        let [_, coulomb, viscous, .., stiffness] = *self.p else { return f64::NAN };
        if let Some(anchor) = self.anchor {
            let spring = stiffness * (x - anchor);
            if spring.abs() < coulomb + self.static_level() {
                self.at_rest += STEP;
                return spring + viscous * v;
            }
            self.level = self.static_level();
            self.anchor = None;
        }
        (coulomb + self.stribeck()) * v.signum() + viscous * v
    }

    /// After a step from velocity `before` to `v`: a slip ends where the velocity changes its sign. Where
    /// in the step that was decides where the spring begins, so that the cost has no jumps.
    fn moved(&mut self, x: f64, before: f64, v: f64) {
        self.velocities.push(v);
        if self.anchor.is_none() && before * v <= 0.0 {
            let since = if v == before { STEP } else { STEP * v / (v - before) };
            self.last = self.stribeck();
            self.at_rest = since;
            let force = (self.p[1] + self.last) * before.signum();
            self.anchor = Some(x - v * since - force / self.p[7]);
        }
    }
}

impl Model for Table {
    fn predict(&self, p: &[f64], out: &mut Vec<f64>) {
        let velocities = Delay::new();
        let mut contact =
            Contact { p, anchor: Some(0.0), at_rest: 10.0, last: 0.0, level: 0.0, velocities };
        let (mut x, mut v, mut x_before) = (0.0, 0.0, 0.0);
        for sample in 0..SAMPLES {
            let t = (sample * STEPS_PER_SAMPLE) as f64 * STEP;
            let (position, velocity) = desired(t);
            let measured = (x - x_before) / (STEP * STEPS_PER_SAMPLE as f64);
            x_before = x;
            let drive = GAINS.0 * (position - x) + GAINS.1 * (velocity - measured);
            for _ in 0..STEPS_PER_SAMPLE {
                let before = v;
                v += STEP * (drive - contact.force(x, v)) / p[0];
                x += STEP * v;
                contact.moved(x, before, v);
            }
            out.push(x / ENCODER);
        }
    }
}
