//! A simulated table with a hidden effect, written without the library: own integrator, own laws.
//!
//! A test of a law against itself proves little. Here the mass moves in small semi-implicit steps,
//! Coulomb friction is a projection of the velocity, an elastic contact is a bristle, a second mass hangs
//! on a spring or behind a gap, and every law stands as its formula.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use missing_physics::{Channel, Hold, Recording, RecordingError};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::hidden::Hidden;
use super::motion::{Excitation, SAMPLE_TIME, reference};

/// Steps of the integrator per sample.
const STEPS: usize = 20;
/// Encoder count, m.
const COUNT: f64 = 1e-6;
/// Standard deviation of the noise of the recorded force, N.
pub const NOISE: f64 = 0.15;
/// Stiffness, N/m, and damping, N s/m, of the contact at the end of a gap.
const IMPACT: (f64, f64) = (3e6, 3e3);
/// Stiffness of the spring beside load-dependent friction, N/m.
const STRONG_SPRING: f64 = 600.0;
/// Radius that turns the table into a rotary axis, m.
const RADIUS: f64 = 0.05;
/// Largest acceleration, m/s^2, and speed, m/s, of the motion that tells much.
const FASTEST: (f64, f64) = (6.0, 0.3);

/// A hidden effect with its size and three random numbers 0..1.
#[derive(Clone, Copy, Debug)]
struct Law {
    kind: Hidden,
    size: f64,
    draw: [f64; 3],
}

/// A table: its base parameters and its hidden effects with their sizes.
#[derive(Clone, Debug)]
pub struct Table {
    mass: f64,
    coulomb: f64,
    viscous: f64,
    offset: f64,
    hidden: Vec<Law>,
    vary: [f64; 2],
    seed: u64,
}

impl Table {
    /// A table drawn by `seed`, with `hidden` effects of a size in the unit that [`Hidden`] says.
    pub fn draw(seed: u64, hidden: &[(Hidden, f64)]) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed ^ 0x7ab1e);
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let (mass, coulomb) = (between(20.0, 50.0), between(4.0, 12.0));
        let (viscous, offset) = (between(100.0, 300.0), between(-1.0, 1.0));
        let vary = [between(0.85, 1.0), between(1.0, 1.15)];
        let hidden = hidden
            .iter()
            .map(|(kind, size)| {
                let draw = [between(0.0, 1.0), between(0.0, 1.0), between(0.0, 1.0)];
                Law { kind: *kind, size: *size, draw }
            })
            .collect();
        Self { mass, coulomb, viscous, offset, hidden, vary, seed }
    }

    /// The parameters of the library's laws that tell the size of what is hidden, with their true values:
    /// a root of the sum of squares where there are several.
    pub fn truth(&self) -> Vec<(&'static [&'static str], f64)> {
        let of = |law: &Law| -> Option<(&'static [&'static str], f64)> {
            Some(match law.kind {
                Hidden::Stribeck => (&["stribeck.dF"], law.size),
                // The offset of the base model takes a difference of the levels.
                Hidden::Asymmetry => {
                    (&["asymmetry.dF_v"], law.size * (0.7 - 0.4 * law.draw[0]) / 0.15)
                }
                Hidden::Ripple => (&["ripple.a_1", "ripple.b_1"], law.size),
                Hidden::Presliding => (&["presliding.k_t"], self.coulomb / law.size),
                Hidden::QuadraticDrag => (&["quadratic-drag.c"], law.size / 0.04),
                Hidden::ShearThinning => (&["shear-thinning.dF"], law.size),
                Hidden::Spring => (&["spring.k"], law.size / 0.06),
                Hidden::LoadFriction => (&["load-friction.mu"], law.size),
                Hidden::Drift => (&["drift.dF_C"], law.size),
                Hidden::FrictionalMemory => (&["frictional-memory.tau_L"], law.size),
                Hidden::ActuatorLag => (&["actuator-lag.tau"], law.size),
                Hidden::InputDelay => (&["input-delay.T_d"], law.size),
                Hidden::Pendulum => (&["gravity-pendulum.M"], law.size * RADIUS),
                Hidden::Saturation => (&["saturation.u_max"], self.limit()),
                Hidden::Encoder => (&["encoder.a", "encoder.b"], law.size),
                Hidden::Backlash => (&["backlash.F_L"], law.size),
                Hidden::FlexibleCoupling => (&["flexible-coupling.m_L"], law.size * self.mass),
                _ => return None,
            })
        };
        self.hidden.iter().filter_map(of).collect()
    }

    fn find(&self, kind: Hidden) -> Option<&Law> {
        self.hidden.iter().find(|law| law.kind == kind)
    }

    fn size_of(&self, kind: Hidden) -> Option<f64> {
        self.find(kind).map(|law| law.size)
    }

    /// Friction level in the direction of motion, N.
    fn level(&self, at: &At) -> f64 {
        let &At { x, v, seen, t, end, direction, dwell, force } = at;
        let hump = |speed: f64| 1.0 / (1.0 + (seen / speed).powi(2));
        let extra = |law: &Law| {
            let Law { kind, size, draw } = *law;
            match kind {
                Hidden::Stribeck => size * hump(6e-4 * 8f64.powf(draw[0])),
                Hidden::FrictionalMemory => 3.0 * hump(3e-3 * 2f64.powf(draw[0])),
                Hidden::GaussianStribeck => {
                    size * (-(v / (1e-3 * 6f64.powf(draw[0]))).powi(2)).exp()
                }
                Hidden::RisingStatic => {
                    let gamma = 0.02 * 4f64.powf(draw[1]);
                    size * dwell / (dwell + gamma) * hump(1e-3 * 4f64.powf(draw[0]))
                }
                Hidden::LoadFriction => size * force.abs(),
                Hidden::Asymmetry => size * (0.3 + 0.4 * draw[0]) * direction,
                Hidden::PositionFriction => {
                    let bump = |at: f64, width: f64| (-((x - at) / width).powi(2)).exp();
                    size * (bump(0.02 + 0.03 * draw[0], 0.02) - bump(0.07 + 0.04 * draw[1], 0.025))
                }
                Hidden::RandomProfile => size * self.profile(x),
                Hidden::Drift => size * (-t / (end * (0.2 + 0.4 * draw[0]))).exp(),
                Hidden::FrictionStep if t > end * (0.35 + 0.3 * draw[0]) => size,
                _ => 0.0,
            }
        };
        (self.coulomb + self.hidden.iter().map(extra).sum::<f64>()).max(0.0)
    }

    /// Twenty waves of random phase along the way of 0.13 m, of unit rms.
    fn profile(&self, x: f64) -> f64 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ 0x9f0f);
        let wave = |k: usize| {
            let phase: f64 = random.random();
            (TAU * (k as f64 * x / 0.26 + phase)).sin() / (1.0 + k as f64 / 8.0)
        };
        0.4 * (1..=20).map(wave).sum::<f64>()
    }

    /// Force against the motion that depends smoothly on the state, N.
    fn smooth(&self, x: f64, v: f64, t: f64) -> f64 {
        let extra = |law: &Law| {
            let Law { kind, size, draw } = *law;
            match kind {
                Hidden::Asymmetry => size * (0.7 - 0.4 * draw[0]) * v.abs() / 0.15,
                Hidden::Ripple => {
                    let period = 2e-3 * 4f64.powf(draw[0]);
                    let phase = TAU * (x / period + draw[1]);
                    size * (phase.sin() + 0.4 * draw[2] * (2.0 * phase).cos())
                }
                Hidden::QuadraticDrag => size * v * v.abs() / 0.04,
                Hidden::ShearThinning => size * (v / (5e-3 * 5f64.powf(draw[0]))).tanh(),
                Hidden::Spring => size * (x - 0.06) / 0.06,
                // It hangs down somewhere within the way of 2.4 rad.
                Hidden::Pendulum => size * (x / RADIUS - 2.4 * draw[0]).sin(),
                Hidden::LoadFriction => STRONG_SPRING * (x - 0.06),
                Hidden::TimePeriodic => size * (TAU * (t / (0.3 + 0.9 * draw[0]) + draw[1])).sin(),
                Hidden::Dent => {
                    let (place, width) = (0.02 + 0.08 * draw[0], 1e-3 * 3f64.powf(draw[1]));
                    size * (-((x - place) / width).powi(2)).exp()
                }
                _ => 0.0,
            }
        };
        self.viscous * v + self.offset + self.hidden.iter().map(extra).sum::<f64>()
    }

    /// Error of the encoder at `x`, m.
    fn encoder_error(&self, x: f64) -> f64 {
        self.find(Hidden::Encoder).map_or(0.0, |law| {
            let period = 2e-3 * 4f64.powf(law.draw[0]);
            law.size * (TAU * (x / period + law.draw[1])).sin()
        })
    }

    /// Largest force of the drive, N.
    fn limit(&self) -> f64 {
        self.size_of(Hidden::Saturation).map_or(f64::INFINITY, |cut| {
            let (acceleration, speed) = FASTEST;
            (1.0 - cut) * (self.mass * acceleration + self.viscous * speed + self.coulomb)
        })
    }

    /// Deflection up to breakaway of an elastic contact, m, and its kind.
    fn contact(&self) -> Option<(f64, Hidden)> {
        [Hidden::Presliding, Hidden::Dahl, Hidden::LuGre]
            .into_iter()
            .find_map(|kind| self.size_of(kind).map(|size| (size, kind)))
    }

    /// The table under a controller: position as the encoder counts, force as commanded plus noise.
    ///
    /// # Errors
    /// The motion is not finite.
    pub fn record(&self, excitation: Excitation) -> Result<Recording, RecordingError> {
        let wanted = reference(excitation, self.vary);
        let end = wanted.len() as f64 * SAMPLE_TIME;
        let mut noise = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ 0x0153);
        let mut plant = Plant::of(self, end);
        let (stiff, damped) = (36.0 * 1e4, 36.0 * 160.0);
        let (mut speed, mut before) = (0.0, 0.0);
        let (mut time, mut force, mut position) = (Vec::new(), Vec::new(), Vec::new());
        for (k, target) in wanted.iter().enumerate() {
            let counted = ((plant.x + self.encoder_error(plant.x)) / COUNT).round() * COUNT;
            let error = target - counted;
            speed += 0.4 * ((error - before) / SAMPLE_TIME - speed);
            before = error;
            let command = stiff * error + damped * speed;
            let t = k as f64 * SAMPLE_TIME;
            let seen: f64 = StandardNormal.sample(&mut noise);
            time.push(t);
            position.push(counted);
            force.push(command + NOISE * seen);
            for step in 0..STEPS {
                let h = SAMPLE_TIME / STEPS as f64;
                plant.step(command, t + step as f64 * h, h);
            }
        }
        let channels = if self.find(Hidden::Pendulum).is_some() {
            let (force, position) = (scaled(&force, RADIUS), scaled(&position, 1.0 / RADIUS));
            vec![Channel::new("force", "Nm", force), Channel::new("position", "rad", position)]
        } else {
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)]
        };
        Ok(Recording::new("table", time, channels)?.with_hold(Hold::ZeroOrder))
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Where the laws are asked.
struct At {
    x: f64,
    v: f64,
    /// Velocity that the friction sees.
    seen: f64,
    t: f64,
    /// Length of the recording, s.
    end: f64,
    direction: f64,
    /// Length of the last rest, s.
    dwell: f64,
    /// Force of the drive, N.
    force: f64,
}

/// A table in motion.
struct Plant<'a> {
    table: &'a Table,
    end: f64,
    x: f64,
    v: f64,
    /// Force of the drive, N.
    force: f64,
    /// Force of the elastic contact, N.
    bristle: f64,
    /// Time at rest, s: of the rest that lasts, or of the last one.
    dwell: f64,
    /// Way of a second mass and its velocity.
    load: (f64, f64),
    /// Commands not yet arrived.
    commands: VecDeque<f64>,
    /// Velocities not yet seen by the friction.
    speeds: VecDeque<f64>,
}

impl<'a> Plant<'a> {
    fn of(table: &'a Table, end: f64) -> Self {
        let steps = |kind: Hidden| {
            let time = table.size_of(kind).unwrap_or(0.0);
            VecDeque::from(vec![0.0; (time * STEPS as f64 / SAMPLE_TIME).round() as usize])
        };
        Self {
            table,
            end,
            x: 0.0,
            v: 0.0,
            force: 0.0,
            bristle: 0.0,
            dwell: 0.0,
            load: (0.0, 0.0),
            commands: steps(Hidden::InputDelay),
            speeds: steps(Hidden::FrictionalMemory),
        }
    }

    fn step(&mut self, command: f64, t: f64, h: f64) {
        let table = self.table;
        self.commands.push_back(command);
        let arrived = self.commands.pop_front().unwrap_or(command);
        let limit = table.limit();
        let arrived = arrived.clamp(-limit, limit);
        let lag = table.size_of(Hidden::ActuatorLag).unwrap_or(0.0);
        self.force =
            if lag > 0.0 { arrived + (self.force - arrived) * (-h / lag).exp() } else { arrived };
        self.speeds.push_back(self.v);
        let seen = self.speeds.pop_front().unwrap_or(self.v);
        let direction = if self.v == 0.0 { self.force.signum() } else { self.v.signum() };
        let at = At {
            x: self.x,
            v: self.v,
            seen,
            t,
            end: self.end,
            direction,
            dwell: self.dwell,
            force: self.force,
        };
        let behind = self.second_mass(h);
        let level = table.level(&at);
        let push = self.force - table.smooth(self.x, self.v, t) - behind;
        let mass = table.mass * (1.0 - table.size_of(Hidden::FlexibleCoupling).unwrap_or(0.0));
        let mass = if table.find(Hidden::Backlash).is_some() { 0.8 * mass } else { mass };
        let before = self.v;
        match table.contact() {
            None => {
                // Coulomb friction takes away as much speed as it can, and no more.
                let free = self.v + h * push / mass;
                let most = h * level / mass;
                self.v = if free.abs() <= most { 0.0 } else { free - most.copysign(free) };
            }
            Some((deflection, kind)) => {
                let stiffness = table.coulomb / deflection;
                let part = self.bristle / level.max(1e-9);
                let slope = match kind {
                    Hidden::Presliding => 1.0,
                    _ => (1.0 - part * self.v.signum()).max(0.0),
                };
                let damping = if kind == Hidden::LuGre { (stiffness * mass).sqrt() } else { 0.0 };
                let contact = self.bristle + damping * slope * self.v;
                self.v += h * (push - contact) / mass;
                self.bristle = (self.bristle + stiffness * slope * self.v * h).clamp(-level, level);
            }
        }
        if self.v == 0.0 {
            self.dwell = if before == 0.0 { self.dwell + h } else { h };
        }
        self.x += 0.5 * h * (self.v + before);
    }

    /// Advances what hangs behind the mass; its force on the mass, N.
    fn second_mass(&mut self, h: f64) -> f64 {
        let (place, speed) = self.load;
        if let Some(law) = self.table.find(Hidden::FlexibleCoupling) {
            let mass = law.size * self.table.mass;
            let w = TAU * 12.0 * 3f64.powf(law.draw[0]);
            let zeta = 0.03 + 0.1 * law.draw[1];
            let force = mass * (w * w * (self.x - place) + 2.0 * zeta * w * (self.v - speed));
            let speed = speed + h * force / mass;
            self.load = (place + h * speed, speed);
            return force;
        }
        if let Some(law) = self.table.find(Hidden::Backlash) {
            let mass = 0.2 * self.table.mass;
            let gap = 4e-5 * 5f64.powf(law.draw[0]);
            let stretch = self.x - place;
            let pressed = stretch - stretch.clamp(-0.5 * gap, 0.5 * gap);
            let contact = IMPACT.0 * pressed + IMPACT.1 * (self.v - speed);
            // The contact pushes; it does not pull.
            let force = if pressed == 0.0 || contact * pressed <= 0.0 { 0.0 } else { contact };
            let free = speed + h * force / mass;
            let most = h * law.size / mass;
            let speed = if free.abs() <= most { 0.0 } else { free - most.copysign(free) };
            self.load = (place + h * speed, speed);
            return force;
        }
        0.0
    }
}
