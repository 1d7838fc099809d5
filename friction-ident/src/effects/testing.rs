//! Evaluates one effect at one point: for the effects' own tests.

use super::{Effect, Motion, Parameters, Smooth};

/// A point of the state space; `Point::at(x, v)` and change what matters.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub time: f64,
    pub position: f64,
    pub velocity: f64,
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
