//! Evaluates one effect at one point: for the effects' own tests.

use missing_physics::Hold;

use super::{Effect, Motion, Parameters, Smooth};
use crate::axis::Axis;
use crate::driven::{MeasuredMotion, force_along};
use crate::model::Model;
use crate::simulator::{Input, Start, simulate};

/// A point of the state space; `Point::at(x, v)` and change what matters.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub time: f64,
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
    pub level_velocity: f64,
    pub dwell: f64,
    pub bond: f64,
    pub drive_force: f64,
}

impl Point {
    pub fn at(position: f64, velocity: f64) -> Self {
        Self {
            time: 0.0,
            position,
            velocity,
            acceleration: 0.0,
            level_velocity: velocity,
            dwell: 0.0,
            bond: 1.0,
            drive_force: 0.0,
        }
    }

    fn with_motion<R>(&self, call: impl FnOnce(&Motion<'_>) -> R) -> R {
        call(&Motion {
            time: &[self.time],
            position: &[self.position],
            velocity: &[self.velocity],
            acceleration: &[self.acceleration],
            direction: &[if self.velocity == 0.0 { 0.0 } else { self.velocity.signum() }],
            level_velocity: &[self.level_velocity],
            dwell: &[self.dwell],
            bond: &[self.bond],
            drive_force: &[self.drive_force],
        })
    }
}

/// Smooth force and damping.
pub fn smooth(effect: &dyn Effect, p: &[f64], point: Point) -> (f64, f64) {
    let (mut force, mut damping) = ([0.0], [0.0]);
    point.with_motion(|m| {
        let mut out = Smooth { force: &mut force, damping: &mut damping };
        effect.smooth_force(Parameters::new(p, 1), m, &mut out);
    });
    (force[0], damping[0])
}

/// Friction level.
pub fn level(effect: &dyn Effect, p: &[f64], point: Point) -> f64 {
    let mut level = [0.0];
    point.with_motion(|m| effect.friction_level(Parameters::new(p, 1), m, &mut level));
    level[0]
}

/// A table of 5 kg with Coulomb and viscous friction and `effects`, driven by a swelling sine: largest difference, N, of
/// the force that the simulated motion asks for from the one that made it. Samples within `MARGIN` steps of a
/// change of direction, and those of `left_out`, do not count: half a step matters there.
pub fn along_and_simulated(effects: &[(&str, &[(&str, f64)])], left_out: Option<f64>) -> f64 {
    const STEP: f64 = 1e-4;
    const MARGIN: usize = 4;
    let start = Model::new(Axis::Linear, 5.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 100.0)]))
        .unwrap();
    let model = effects.iter().fold(start, |m, (name, values)| m.with(name, values).unwrap());
    let time: Vec<f64> = (0..20_000).map(|k| f64::from(k) * STEP).collect();
    let force: Vec<f64> =
        time.iter().map(|t| (20.0 + 5.0 * t) * (std::f64::consts::TAU * 1.5 * t).cos()).collect();
    let input = Input::new(&time, &force, Hold::Sampled);
    let out = simulate(&model, &input, &Start::at(0.0, 0.0)).unwrap();
    let acceleration = crate::signal::derivative(&time, &out.velocity);
    let motion = MeasuredMotion::new(&time, &out.position, &out.velocity, &acceleration)
        .and_then(|motion| motion.with_drive_force(&force))
        .unwrap();
    let slides = |k: usize| {
        let near = &out.velocity[k - MARGIN..=k + MARGIN];
        near.iter().all(|v| *v > 0.0) || near.iter().all(|v| *v < 0.0)
    };
    let first = left_out.map_or(MARGIN, |until| (until / STEP) as usize);
    let asked = force_along(&model, &motion);
    let counted = (first..time.len() - MARGIN).filter(|k| slides(*k));
    assert!(counted.clone().count() > time.len() / 4, "it hardly moves");
    counted.map(|k| (asked[k] - force[k]).abs()).fold(0.0, f64::max)
}

/// The force, N, at which a model moves again that came to rest from 0.1 m/s, and is pushed by 2 N/s from 1 s on.
pub fn breaks_away(model: &Model) -> f64 {
    let time: Vec<f64> = (0..6000).map(|k| f64::from(k) * 1e-3).collect();
    let force: Vec<f64> = time.iter().map(|t| 2.0 * (t - 1.0).max(0.0)).collect();
    let input = Input::new(&time, &force, Hold::ZeroOrder);
    let velocity = simulate(model, &input, &Start::at(0.0, 0.1)).unwrap().velocity;
    let rests = velocity.iter().position(|v| *v == 0.0).unwrap();
    assert!(time[rests] < 0.1, "it slides on");
    force[rests + velocity[rests..].iter().position(|v| *v != 0.0).unwrap()]
}
