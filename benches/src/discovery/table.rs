//! A simulated table with a hidden effect, written without the library: own integrator, own laws.
//!
//! A test of a law against itself proves little. Here the mass moves in small semi-implicit steps,
//! Coulomb friction is a projection of the velocity, an elastic contact is a bristle, and every law
//! stands as its formula.

use std::f64::consts::TAU;

use missing_physics::{Channel, Hold, Recording, RecordingError};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::motion::{Excitation, SAMPLE_TIME, reference};

/// Steps of the integrator per sample.
const STEPS: usize = 20;
/// Encoder count, m.
const COUNT: f64 = 1e-6;
/// Standard deviation of the noise of the recorded force, N.
pub const NOISE: f64 = 0.15;

/// What hides in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hidden {
    /// Nothing beyond mass, Coulomb and viscous friction and an offset.
    Nothing,
    /// A Lorentzian hump of friction at low speed.
    Stribeck,
    /// A Gaussian hump.
    GaussianStribeck,
    /// Direction-dependent levels and slopes.
    Asymmetry,
    /// Periodic force along the stroke.
    Ripple,
    /// An elastic contact (one bristle that slips at the friction level).
    Presliding,
    /// A Dahl contact: stiffness falls off smoothly towards the friction level.
    Dahl,
    /// A smooth random friction profile along the stroke.
    PositionFriction,
    /// Drag with the square of the speed.
    QuadraticDrag,
    /// A saturating viscous force.
    ShearThinning,
    /// A spring about mid-stroke.
    Spring,
    /// A first-order lag of the force.
    ActuatorLag,
    /// A force periodic in time: no effect of the library.
    TimePeriodic,
    /// The friction level changes at some moment: no effect of the library.
    FrictionStep,
}

/// Every kind, with the names that are a right answer (none: nothing, or unexplained).
pub const ALL: [(Hidden, &str, &[&str]); 14] = [
    (Hidden::Nothing, "nothing", &[]),
    (Hidden::Stribeck, "stribeck", &["stribeck"]),
    (Hidden::GaussianStribeck, "stribeck, Gaussian", &["stribeck"]),
    (Hidden::Asymmetry, "asymmetry", &["asymmetry"]),
    (Hidden::Ripple, "ripple", &["ripple"]),
    (Hidden::Presliding, "presliding", &["presliding"]),
    (Hidden::Dahl, "presliding, Dahl", &["presliding"]),
    (Hidden::PositionFriction, "position-friction", &["position-friction"]),
    (Hidden::QuadraticDrag, "quadratic-drag", &["quadratic-drag"]),
    (Hidden::ShearThinning, "shear-thinning", &["shear-thinning"]),
    (Hidden::Spring, "spring", &["spring"]),
    (Hidden::ActuatorLag, "actuator-lag", &["actuator-lag"]),
    (Hidden::TimePeriodic, "periodic in time", &[]),
    (Hidden::FrictionStep, "friction step in time", &[]),
];

/// A table: its base parameters and its hidden effects with their sizes.
#[derive(Clone, Debug)]
pub struct Table {
    mass: f64,
    coulomb: f64,
    viscous: f64,
    offset: f64,
    /// Effect, size (N, or s for a lag, or m of deflection for a contact), three random numbers 0..1.
    hidden: Vec<(Hidden, f64, [f64; 3])>,
    vary: [f64; 2],
    seed: u64,
}

impl Table {
    /// A table drawn by `seed`, with `hidden` effects at a size relative to their `unit`.
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
                (*kind, *size, draw)
            })
            .collect();
        Self { mass, coulomb, viscous, offset, hidden, vary, seed }
    }

    /// Friction level in the direction `s`, N.
    fn level(&self, x: f64, v: f64, s: f64, t: f64, end: f64) -> f64 {
        let extra = |(kind, size, draw): &(Hidden, f64, [f64; 3])| match kind {
            Hidden::Stribeck => {
                let speed = 6e-4 * 8f64.powf(draw[0]);
                size / (1.0 + (v / speed).powi(2))
            }
            Hidden::GaussianStribeck => {
                let speed = 1e-3 * 6f64.powf(draw[0]);
                size * (-(v / speed).powi(2)).exp()
            }
            Hidden::Asymmetry => size * (0.3 + 0.4 * draw[0]) * s,
            Hidden::PositionFriction => {
                let bump = |at: f64, width: f64| (-((x - at) / width).powi(2)).exp();
                size * (bump(0.02 + 0.03 * draw[0], 0.02) - bump(0.07 + 0.04 * draw[1], 0.025))
            }
            Hidden::FrictionStep if t > end * (0.35 + 0.3 * draw[0]) => *size,
            _ => 0.0,
        };
        (self.coulomb + self.hidden.iter().map(extra).sum::<f64>()).max(0.0)
    }

    /// Force against the motion that depends smoothly on the state, N.
    fn smooth(&self, x: f64, v: f64, t: f64) -> f64 {
        let extra = |(kind, size, draw): &(Hidden, f64, [f64; 3])| match kind {
            Hidden::Asymmetry => size * (0.7 - 0.4 * draw[0]) * v.abs() / 0.15,
            Hidden::Ripple => {
                let period = 2e-3 * 4f64.powf(draw[0]);
                let phase = TAU * (x / period + draw[1]);
                size * (phase.sin() + 0.4 * draw[2] * (2.0 * phase).cos())
            }
            Hidden::QuadraticDrag => size * v * v.abs() / 0.04,
            Hidden::ShearThinning => size * (v / (5e-3 * 5f64.powf(draw[0]))).tanh(),
            Hidden::Spring => size * (x - 0.06) / 0.06,
            Hidden::TimePeriodic => size * (TAU * (t / (0.3 + 0.9 * draw[0]) + draw[1])).sin(),
            _ => 0.0,
        };
        self.viscous * v + self.offset + self.hidden.iter().map(extra).sum::<f64>()
    }

    fn size_of(&self, kind: Hidden) -> Option<f64> {
        self.hidden.iter().find(|(hidden, _, _)| *hidden == kind).map(|(_, size, _)| *size)
    }

    /// Deflection up to breakaway of an elastic contact, m; whether it is a Dahl contact.
    fn contact(&self) -> Option<(f64, bool)> {
        let elastic = self.size_of(Hidden::Presliding).map(|size| (size, false));
        elastic.or(self.size_of(Hidden::Dahl).map(|size| (size, true)))
    }

    /// The table under a controller: position as the encoder counts, force as commanded plus noise.
    ///
    /// # Errors
    /// The motion is not finite.
    pub fn record(&self, excitation: Excitation) -> Result<Recording, RecordingError> {
        let wanted = reference(excitation, self.vary);
        let end = wanted.len() as f64 * SAMPLE_TIME;
        let mut noise = Xoshiro256PlusPlus::seed_from_u64(self.seed ^ 0x0153);
        let mut state = State::default();
        let (stiff, damped) = (36.0 * 1e4, 36.0 * 160.0);
        let (mut speed, mut before) = (0.0, 0.0);
        let (mut time, mut force, mut position) = (Vec::new(), Vec::new(), Vec::new());
        for (k, target) in wanted.iter().enumerate() {
            let counted = (state.x / COUNT).round() * COUNT;
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
                self.step(&mut state, command, t + step as f64 * h, h, end);
            }
        }
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        Ok(Recording::new("table", time, channels)?.with_hold(Hold::ZeroOrder))
    }

    fn step(&self, state: &mut State, command: f64, t: f64, h: f64, end: f64) {
        let lag = self.size_of(Hidden::ActuatorLag).unwrap_or(0.0);
        state.force =
            if lag > 0.0 { command + (state.force - command) * (-h / lag).exp() } else { command };
        let direction = if state.v == 0.0 { state.force.signum() } else { state.v.signum() };
        let level = self.level(state.x, state.v, direction, t, end);
        let push = state.force - self.smooth(state.x, state.v, t);
        let before = state.v;
        match self.contact() {
            None => {
                // Coulomb friction takes away as much speed as it can, and no more.
                let free = state.v + h * push / self.mass;
                let most = h * level / self.mass;
                state.v = if free.abs() <= most { 0.0 } else { free - most.copysign(free) };
            }
            Some((deflection, dahl)) => {
                let stiffness = self.coulomb / deflection;
                let part = state.bristle / level.max(1e-9);
                let slope = if dahl { (1.0 - part * state.v.signum()).max(0.0) } else { 1.0 };
                state.v += h * (push - state.bristle) / self.mass;
                state.bristle =
                    (state.bristle + stiffness * slope * state.v * h).clamp(-level, level);
            }
        }
        state.x += 0.5 * h * (state.v + before);
    }
}

#[derive(Default)]
struct State {
    x: f64,
    v: f64,
    /// Force of the drive, N.
    force: f64,
    /// Force of the elastic contact, N.
    bristle: f64,
}
