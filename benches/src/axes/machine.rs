//! The machines: their parameters, how they are controlled, what of them is recorded.

use std::f64::consts::TAU;

use super::motion;
use super::random::Stream;

/// Steps of the integrator, s.
pub const STEP: f64 = 2e-5;
/// Control intervals per sample where the force is measured.
const FINE: usize = 5;

/// What the column of the force holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// The command, put out at its sample and held until the next one.
    Command,
    /// The force itself, measured at the sample; the control runs faster.
    Measured,
}

/// Which machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Build {
    /// A linear table under proportional and derivative control, 5 ms, counts of 1 um.
    Table,
    /// A joint of a robot with much friction, 1 ms.
    Joint,
    /// The same joint with its arm hanging against gravity.
    HangingJoint,
    /// A ball screw with the encoder on its motor, 1 or 0.5 ms.
    Spindle,
}

/// A machine, with nothing hidden in it.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Radians and newton metres instead of metres and newtons.
    pub rotary: bool,
    /// Mass or inertia.
    pub mass: f64,
    /// Coulomb level.
    pub coulomb: f64,
    /// Viscous coefficient.
    pub viscous: f64,
    /// Constant force that resists.
    pub offset: f64,
    /// Torque of the weight at 90 degrees, and the angle at which it hangs down.
    pub gravity: (f64, f64),
    /// Sampling interval, s.
    pub interval: f64,
    /// What the column of the force holds.
    pub force: Force,
    /// Encoder count.
    pub count: f64,
    /// Standard deviation of the encoder's noise before counting.
    pub encoder_noise: f64,
    /// Standard deviation of the noise of the recorded force.
    pub force_noise: f64,
    /// Step of the force that the converter puts out; 0: none.
    pub force_step: f64,
    /// Stiffness, damping, time constant of the derivative's filter, shares of the wanted acceleration and
    /// of the friction that are fed forward.
    pub control: [f64; 5],
    /// Wanted positions, one per control interval.
    pub wanted: Vec<f64>,
    /// Pitch of what repeats along the way.
    pub pitch: f64,
    /// A short length: of presliding, of a gap.
    pub short: f64,
    /// Largest wanted speed.
    pub speed: f64,
    /// Largest distance from the start.
    pub stroke: f64,
}

impl Machine {
    /// The machine that `random` draws.
    pub fn draw(build: Build, force: Force, random: &mut Stream) -> Self {
        let mut machine = match build {
            Build::Table => Self::table(force, random),
            Build::Joint | Build::HangingJoint => Self::joint(build, force, random),
            Build::Spindle => Self::spindle(force, random),
        };
        let interval = machine.control_interval();
        let far = |most: f64, x: &f64| most.max(x.abs());
        machine.stroke = machine.wanted.iter().fold(0.0, far);
        let speeds = machine.wanted.windows(2).map(|pair| (pair[1] - pair[0]) / interval);
        machine.speed = speeds.fold(0.0, |most, v| f64::max(most, v.abs()));
        machine
    }

    /// Interval of the control, s.
    pub fn control_interval(&self) -> f64 {
        self.interval / self.controls() as f64
    }

    /// Control intervals per sample.
    pub fn controls(&self) -> usize {
        match self.force {
            Force::Command => 1,
            Force::Measured => FINE,
        }
    }

    fn table(force: Force, random: &mut Stream) -> Self {
        let interval = 5e-3;
        let mass = random.between(27.0, 40.0);
        let coulomb = random.between(2.5, 6.0);
        let stiff = random.between(40.0, 62.0);
        let measured = force == Force::Measured;
        let (noisy_encoder, noisy_force) = (random.chance(0.5), measured || random.chance(0.5));
        let grid = if measured { interval / FINE as f64 } else { interval };
        Self {
            rotary: false,
            mass,
            coulomb,
            viscous: random.between(200.0, 480.0),
            offset: random.between(-0.5, 0.5),
            gravity: (0.0, 0.0),
            interval,
            force,
            count: 1e-6,
            encoder_noise: if noisy_encoder { random.between(3e-7, 6e-7) } else { 0.0 },
            force_noise: if noisy_force { random.between(0.05, 0.2) } else { 0.0 },
            force_step: if measured { 0.0 } else { 300.0 / 4096.0 },
            control: [
                mass * stiff * stiff,
                1.5 * mass * stiff,
                if measured { 2e-3 } else { 0.0 },
                0.0,
                0.0,
            ],
            wanted: motion::table(grid, random),
            pitch: 5e-3,
            short: 2e-5,
            speed: 0.0,
            stroke: 0.0,
        }
    }

    fn joint(build: Build, force: Force, random: &mut Stream) -> Self {
        let interval = 1e-3;
        let mass = random.ratio(0.02, 2.0);
        let speed = random.between(0.8, 2.2);
        let share = random.between(0.6, 0.9);
        let measured = force == Force::Measured;
        let grid = if measured { interval / FINE as f64 } else { interval };
        let wanted = motion::joint(grid, speed, random);
        // Coulomb friction takes its share of the torque needed in motion, viscous friction some of the rest.
        let squares: f64 = wanted
            .windows(3)
            .map(|x| ((x[2] - 2.0 * x[1] + x[0]) / (grid * grid)).powi(2))
            .sum::<f64>();
        let inertial = mass * (squares / wanted.len() as f64).sqrt();
        let viscous = random.between(0.3, 1.0) * inertial / (0.4 * speed);
        let coulomb = share / (1.0 - share) * inertial * random.between(1.0, 1.4);
        let hanging = build == Build::HangingJoint;
        let weight = if hanging { coulomb * random.between(2.5, 6.0) } else { 0.0 };
        let stiff = TAU * random.between(8.0, 14.0);
        let count = TAU / 2f64.powi(random.between(17.0, 20.99) as i32);
        Self {
            rotary: true,
            mass,
            coulomb,
            viscous,
            offset: random.between(-0.05, 0.05) * coulomb,
            gravity: (weight, random.sign() * random.between(0.3, 1.2)),
            interval,
            force,
            count,
            encoder_noise: 0.0,
            force_noise: if measured { random.ratio(0.005, 0.03) * coulomb } else { 0.0 },
            force_step: if measured { 0.0 } else { 1e-3 * coulomb },
            control: [
                mass * stiff * stiff,
                1.6 * mass * stiff,
                2e-3,
                random.between(0.5, 1.0),
                random.between(0.3, 0.9),
            ],
            wanted,
            pitch: TAU / 40.0,
            short: 1e-3,
            speed: 0.0,
            stroke: 0.0,
        }
    }

    fn spindle(force: Force, random: &mut Stream) -> Self {
        let interval = if random.chance(0.5) { 1e-3 } else { 5e-4 };
        let mass = random.between(80.0, 350.0);
        let coulomb = random.between(60.0, 250.0);
        let stiff = TAU * random.between(10.0, 18.0);
        let pitch = if random.chance(0.5) { 0.01 } else { 0.02 };
        let measured = force == Force::Measured;
        let grid = if measured { interval / FINE as f64 } else { interval };
        Self {
            rotary: false,
            mass,
            coulomb,
            viscous: coulomb * random.between(2.0, 6.0),
            offset: random.between(-0.1, 0.1) * coulomb,
            gravity: (0.0, 0.0),
            interval,
            force,
            count: pitch / 2f64.powi(random.between(16.0, 19.99) as i32),
            encoder_noise: 0.0,
            force_noise: if measured { random.ratio(0.003, 0.02) * coulomb } else { 0.0 },
            force_step: if measured { 0.0 } else { 5e-4 * coulomb },
            control: [
                mass * stiff * stiff,
                1.5 * mass * stiff,
                1e-3,
                random.between(0.6, 1.0),
                random.between(0.3, 0.9),
            ],
            wanted: motion::spindle(grid, random),
            pitch,
            short: 1e-5,
            speed: 0.0,
            stroke: 0.0,
        }
    }
}
