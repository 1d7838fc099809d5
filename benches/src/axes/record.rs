//! A machine under its controller, and what is written down of it.

use super::fault;
use super::hidden::Hidden;
use super::machine::{Build, Force, Machine, STEP};
use super::plant::Plant;
use super::random::Stream;

/// An elastic contact never rests; it creeps and trembles. What goes less than this many counts within an
/// interval counts as at rest, or a model with rigid contact would be blamed for what no encoder shows.
const RESTING: f64 = 0.5;

/// Integrals over a sampling interval, over its length: weighed with what is left of the interval, and with
/// what has passed of it.
pub type Halves = [f64; 2];

/// A recording, and of the motion what only a simulation knows.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Time stamps, s.
    pub time: Vec<f64>,
    /// Recorded force.
    pub force: Vec<f64>,
    /// Recorded position.
    pub position: Vec<f64>,
    /// Sign of the true velocity in each interval.
    pub sign: Vec<Halves>,
    /// Whether the body moves in each interval.
    pub moving: Vec<Halves>,
    /// Largest command.
    pub peak: f64,
    /// Parameter of the library's law that tells the size of what is hidden.
    pub parameter: Option<(&'static str, f64)>,
}

/// Runs `machine` with `hidden` of this size; `peak` as in [`Plant::new`]. All that is random follows from
/// `names` and `seed`.
pub fn run(
    (machine, build): (&Machine, Build),
    (hidden, size): (Hidden, f64),
    peak: f64,
    names: &[&str],
    seed: u64,
) -> Run {
    let stream = |purpose: &str| Stream::new(&[names, &[purpose]].concat(), seed);
    let mut plant = Plant::new((machine, build), (hidden, size), peak, &mut stream("law"));
    let (mut encoder, mut meter) = (stream("encoder"), stream("meter"));
    let (controls, grid) = (machine.controls(), machine.control_interval());
    let steps = (grid / STEP).round() as usize;
    let samples = machine.wanted.len() / controls;
    let late = fault::jitter(hidden, size, samples, &mut stream("jitter"));
    let mut out = Run {
        time: Vec::with_capacity(samples),
        force: Vec::with_capacity(samples),
        position: Vec::with_capacity(samples),
        sign: Vec::with_capacity(samples),
        moving: Vec::with_capacity(samples),
        peak: 0.0,
        parameter: plant.parameter(peak),
    };
    let mut control = Control::default();
    let whole = controls * steps;
    for (k, late) in late.into_iter().enumerate() {
        let noise = machine.encoder_noise * encoder.normal();
        let read = |x: f64| ((x + noise) / machine.count).round() * machine.count;
        let taken_at = (late * whole as f64).round() as usize;
        let mut taken = read(plant.position());
        let meter = machine.force_noise * meter.normal();
        let measured = plant.force() + meter;
        let (mut sign, mut moving) = ([0.0; 2], [0.0; 2]);
        let mut first = 0.0;
        let mut range = (plant.position(), plant.position());
        for c in 0..controls {
            // Where the control runs faster than the recording it interpolates between counts.
            let seen = if controls == 1 { taken } else { plant.position() + noise };
            let command = control.command(machine, k * controls + c, seen);
            if c == 0 {
                first = command;
            }
            out.peak = out.peak.max(command.abs());
            for step in 0..steps {
                let gone = c * steps + step;
                if gone == taken_at && gone > 0 {
                    taken = read(plant.position());
                }
                let before = plant.velocity();
                plant.step(command, (k * whole + gone) as f64 * STEP);
                range = (range.0.min(plant.position()), range.1.max(plant.position()));
                let direction = before + plant.velocity();
                if direction != 0.0 {
                    let passed = (gone as f64 + 0.5) / whole as f64;
                    for (half, weight) in [1.0 - passed, passed].into_iter().enumerate() {
                        sign[half] += weight / whole as f64 * direction.signum();
                        moving[half] += weight / whole as f64;
                    }
                }
            }
        }
        if plant.is_elastic() && range.1 - range.0 < RESTING * machine.count {
            (sign, moving) = ([0.0; 2], [0.0; 2]);
        }
        out.time.push(k as f64 * machine.interval);
        out.force.push(match machine.force {
            Force::Command => first + meter,
            Force::Measured => measured,
        });
        out.position.push(taken);
        out.sign.push(sign);
        out.moving.push(moving);
    }
    fault::spoil((hidden, size), &mut out.time, &mut out.position, &mut stream("fault"));
    out
}

/// Proportional and derivative control with what is fed forward.
#[derive(Default)]
struct Control {
    error: f64,
    rate: f64,
}

impl Control {
    fn command(&mut self, machine: &Machine, k: usize, seen: f64) -> f64 {
        let [stiffness, damping, filter, inertia, friction] = machine.control;
        let (grid, wanted) = (machine.control_interval(), &machine.wanted);
        let at = |k: usize| wanted[k.min(wanted.len() - 1)];
        let error = at(k) - seen;
        let rate = if k == 0 { 0.0 } else { (error - self.error) / grid };
        self.rate += grid / (grid + filter) * (rate - self.rate);
        self.error = error;
        let speed = (at(k + 1) - at(k)) / grid;
        let acceleration = (at(k + 2) - 2.0 * at(k + 1) + at(k)) / (grid * grid);
        let resting = 1e-3 * machine.speed;
        let (weight, down) = machine.gravity;
        let ahead = inertia * (machine.mass * acceleration + machine.viscous * speed)
            + friction * machine.coulomb * (speed / resting).clamp(-1.0, 1.0)
            + weight * (seen - down).sin();
        let command = stiffness * error + damping * self.rate + ahead;
        if machine.force_step > 0.0 {
            (command / machine.force_step).round() * machine.force_step
        } else {
            command
        }
    }
}
