//! A sampled controller on the simulated plant: encoder, held force, limit, noise.

use missing_physics::{Channel, Hold, Recording, RecordingError};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::axis::Quantity;
use crate::model::Model;
use crate::reference::Reference;
use crate::simulator::{Plants, SimulationError, Start, check_step};

/// What a closed loop consists of besides plant, reference and controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Resolution of the encoder, m or rad; 0 for none.
    pub encoder_resolution: f64,
    /// The command is limited to this size, N or N m; the range of the D/A converter.
    pub force_limit: f64,
    /// Resolution of the D/A converter, N or N m; 0 for none.
    pub force_resolution: f64,
    /// Standard deviation of the noise of the recorded force, N or N m.
    pub force_noise: f64,
    /// Longest step of the simulation, s.
    pub max_step: f64,
    /// Seed of the noise.
    pub seed: u64,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            encoder_resolution: 1e-6,
            force_limit: f64::INFINITY,
            force_resolution: 0.0,
            force_noise: 0.0,
            max_step: 2.5e-4,
            seed: 0,
        }
    }
}

impl Setup {
    /// Checks the settings and the reference that a loop is to follow with them.
    fn check(&self, reference: &Reference) -> Result<(), SimulationError> {
        let samples = reference.position.len();
        for values in [reference.velocity.len(), reference.acceleration.len()] {
            if values != samples {
                return Err(SimulationError::Length { samples, values });
            }
        }
        let (name, value) = ("the sampling time", reference.sample_time);
        if !(value > 0.0 && value.is_finite()) {
            return Err(SimulationError::Setting { name, value, need: "it must be above 0 s" });
        }
        let (name, value) = ("the limit of the force", self.force_limit);
        if value.is_nan() || value < 0.0 {
            return Err(SimulationError::Setting { name, value, need: "it must be 0 or above" });
        }
        check_step(samples as f64 * reference.sample_time, self.max_step)
    }
}

/// What a controller sees at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time: f64,
    /// Reference position, m or rad.
    pub reference: f64,
    /// Reference velocity.
    pub reference_velocity: f64,
    /// Reference acceleration.
    pub reference_acceleration: f64,
    /// Position as the encoder shows it, m or rad.
    pub position: f64,
}

/// Turns samples into commands.
pub trait Controller {
    /// The command from `sample` to the next, N or N m.
    fn command(&mut self, sample: &Sample) -> f64;
}

/// Proportional and filtered derivative action with acceleration feed-forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pd {
    /// Proportional gain, N/m or N m/rad.
    proportional: f64,
    /// Derivative gain, N s/m or N m s/rad.
    derivative: f64,
    /// Mass or inertia of the feed-forward, kg or kg m^2.
    feedforward_mass: f64,
    /// Weight of the newest difference in the velocity filter, 0..1; 1 for no filter.
    smoothing: f64,
    last: Option<Sample>,
    velocity: f64,
}

impl Pd {
    /// Plain PD: no feed-forward, no filter.
    pub fn new(proportional: f64, derivative: f64) -> Self {
        let (feedforward_mass, smoothing) = (0.0, 1.0);
        Self { proportional, derivative, feedforward_mass, smoothing, last: None, velocity: 0.0 }
    }

    /// The same with `mass` times the reference's acceleration fed forward.
    #[must_use]
    pub fn with_feedforward(mut self, mass: f64) -> Self {
        self.feedforward_mass = mass;
        self
    }

    /// The same with the newest difference of the position weighed by `smoothing` (0..1).
    #[must_use]
    pub fn with_smoothing(mut self, smoothing: f64) -> Self {
        self.smoothing = smoothing;
        self
    }
}

impl Controller for Pd {
    fn command(&mut self, sample: &Sample) -> f64 {
        if let Some(last) = self.last {
            let raw = (sample.position - last.position) / (sample.time - last.time);
            self.velocity += self.smoothing * (raw - self.velocity);
        }
        self.last = Some(*sample);
        self.proportional * (sample.reference - sample.position)
            + self.derivative * (sample.reference_velocity - self.velocity)
            + self.feedforward_mass * sample.reference_acceleration
    }
}

/// Why a closed loop gives no recording.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClosedLoopError {
    /// The plant runs away.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// What came out is not a recording.
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

/// A closed loop as it ran: what the encoder and the amplifier show, and what really happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What is recorded: `force` (held), `position` (quantised), `reference`.
    pub recording: Recording,
    /// Position without encoder, m or rad.
    pub position: Vec<f64>,
    /// Velocity, m/s or rad/s.
    pub velocity: Vec<f64>,
    /// Command without noise, N or N m.
    pub command: Vec<f64>,
    /// Share of the time from this sample to the next in which the friction holds the axis, 0..1.
    pub stuck: Vec<f64>,
}

/// Runs `controller` on `model`, which starts at rest on the reference.
///
/// # Errors
/// The plant runs away, a setting or the reference makes no sense, or the reference is too short to be a recording.
pub fn closed_loop(
    model: &Model,
    reference: &Reference,
    controller: &mut dyn Controller,
    setup: &Setup,
) -> Result<Run, ClosedLoopError> {
    setup.check(reference)?;
    let mut batch = Plants::new(std::slice::from_ref(model))?.watched();
    let first = reference.position.first().copied().unwrap_or(0.0);
    batch.start(0, &Start::at(first, 0.0));
    let samples = reference.position.len();
    let (mut position, mut velocity) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let (mut command, mut shown) = (Vec::with_capacity(samples), Vec::with_capacity(samples));
    let mut stuck = Vec::with_capacity(samples);
    for k in 0..samples {
        let (x, v) = (batch.position()[0], batch.velocity()[0]);
        let sample = sample(reference, k, quantise(batch.shown()[0], setup.encoder_resolution));
        if !batch.is_finite(0) {
            let effect = batch.culprit(0);
            return Err(SimulationError::NotFinite { time: sample.time, effect }.into());
        }
        position.push(x);
        velocity.push(v);
        shown.push(sample.position);
        let force = quantise(controller.command(&sample), setup.force_resolution)
            .clamp(-setup.force_limit, setup.force_limit);
        command.push(force);
        let steps = (reference.sample_time / setup.max_step - 1e-6).ceil().max(1.0);
        let mut slides = 0.0;
        for _ in 0..steps as usize {
            batch.step(&[reference.sample_time / steps], &[force]);
            slides += batch.sliding()[0];
        }
        stuck.push(1.0 - slides / steps);
    }
    let force = noisy(&command, setup);
    let recording = record(model, reference, force, shown)?;
    Ok(Run { recording, position, velocity, command, stuck })
}

fn sample(reference: &Reference, k: usize, position: f64) -> Sample {
    Sample {
        time: k as f64 * reference.sample_time,
        reference: reference.position[k],
        reference_velocity: reference.velocity[k],
        reference_acceleration: reference.acceleration[k],
        position,
    }
}

/// What an encoder of this resolution shows; 0 for a perfect one.
pub(crate) fn quantise(x: f64, resolution: f64) -> f64 {
    if resolution > 0.0 { (x / resolution).round() * resolution } else { x }
}

fn noisy(command: &[f64], setup: &Setup) -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(setup.seed);
    match Normal::new(0.0, setup.force_noise) {
        Ok(noise) => command.iter().map(|force| force + noise.sample(&mut random)).collect(),
        Err(_) => command.to_vec(),
    }
}

fn record(
    model: &Model,
    reference: &Reference,
    force: Vec<f64>,
    position: Vec<f64>,
) -> Result<Recording, RecordingError> {
    let (newton, metre) =
        (model.effort().unit(model.axis(), Quantity::Force), model.axis().unit(Quantity::Length));
    let time = (0..force.len()).map(|k| k as f64 * reference.sample_time).collect();
    let channels = vec![
        Channel::new("force", newton, force),
        Channel::new("position", metre, position),
        Channel::new("reference", metre, reference.position.clone()),
    ];
    Ok(Recording::new("closed loop", time, channels)?.with_hold(Hold::ZeroOrder))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::reference::Profile;

    fn table() -> Model {
        Model::new(Axis::Linear, 33.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
            .and_then(|m| m.with("viscous", &[("F_v", 200.0)]))
            .unwrap()
    }

    fn pd() -> Pd {
        Pd::new(4e5, 5e3).with_feedforward(33.0).with_smoothing(0.4)
    }

    #[test]
    fn the_table_follows_the_reference_and_the_encoder_shows_whole_counts() {
        let reference = Profile::new(1e-3).round_trip(0.05, 0.1, 1.0).dwell(0.2).build(0.0, 0.02);
        let run = closed_loop(&table(), &reference, &mut pd(), &Setup::default()).unwrap();
        for (x, reference) in run.position.iter().zip(&reference.position) {
            assert!((x - reference).abs() < 5e-4);
        }
        for shown in run.recording.require("position").unwrap() {
            let counts = shown / 1e-6;
            assert!((counts - counts.round()).abs() < 1e-6);
        }
        assert_eq!(run.recording.hold(), Hold::ZeroOrder);
    }

    #[test]
    fn the_controller_sees_and_the_recording_holds_what_the_sensor_shows() {
        let error = [("a", 2e-6), ("b", -1e-6), ("p", 5e-3)];
        let table = table().with("encoder", &error).unwrap();
        let reference = Profile::new(1e-3).round_trip(0.05, 0.1, 1.0).build(0.0, 0.02);
        let setup = Setup { encoder_resolution: 0.0, ..Setup::default() };
        let run = closed_loop(&table, &reference, &mut pd(), &setup).unwrap();
        for (x, shown) in run.position.iter().zip(run.recording.require("position").unwrap()) {
            let (sin, cos) = (std::f64::consts::TAU * x / 5e-3).sin_cos();
            assert!((shown - x - 2e-6 * sin + 1e-6 * cos).abs() < 1e-15);
        }
    }

    #[test]
    fn noise_is_of_the_size_asked_for_and_of_the_seed() {
        let reference = Profile::new(1e-3).round_trip(0.05, 0.1, 1.0).build(0.0, 0.02);
        let at = |seed| {
            let setup = Setup { force_noise: 0.2, seed, ..Setup::default() };
            closed_loop(&table(), &reference, &mut pd(), &setup).unwrap()
        };
        let run = at(1);
        let force = run.recording.require("force").unwrap();
        let square: f64 = force.iter().zip(&run.command).map(|(f, c)| (f - c).powi(2)).sum();
        assert!(((square / force.len() as f64).sqrt() - 0.2).abs() < 0.02);
        assert_eq!(run, at(1));
        assert_ne!(run, at(2));
    }

    #[test]
    fn the_force_stays_within_its_limit() {
        let reference = Profile::new(1e-3).round_trip(0.05, 0.3, 10.0).build(0.0, 0.0);
        let setup = Setup { force_limit: 60.0, ..Setup::default() };
        let run = closed_loop(&table(), &reference, &mut pd(), &setup).unwrap();
        assert!(run.command.iter().all(|force| force.abs() <= 60.0));
        assert!(run.command.iter().any(|force| force.abs() == 60.0));
    }

    #[test]
    fn an_unstable_loop_ends_with_an_error() {
        let reference = Profile::new(1e-3).round_trip(0.05, 0.3, 10.0).build(0.0, 0.0);
        let mut wild = Pd::new(1e9, 1e9);
        let model = table().with("quadratic-drag", &[]).unwrap();
        let run = closed_loop(&model, &reference, &mut wild, &Setup::default());
        assert!(matches!(run, Err(ClosedLoopError::Simulation(_))), "{run:?}");
    }

    #[test]
    fn stick_is_noted_until_the_controller_overcomes_the_friction() {
        let n = 400;
        let velocity = vec![1e-3; n];
        let position = (0..n).map(|k| k as f64 * 1e-6).collect();
        let reference =
            Reference { sample_time: 1e-3, position, velocity, acceleration: vec![0.0; n] };
        let contact = table().with("presliding", &[("k_t", 1e7)]).unwrap();
        for model in [table(), contact] {
            let run = closed_loop(&model, &reference, &mut Pd::new(1e5, 0.0), &Setup::default());
            let run = run.unwrap();
            // 8 N at 1e5 N/m and 1 mm/s are 80 ms.
            let free = run.stuck.iter().position(|stuck| *stuck < 0.5).unwrap();
            assert!((78..=84).contains(&free), "{free}");
            assert!(run.stuck[..free].iter().all(|stuck| *stuck > 0.5));
            assert!(run.velocity[free + 5] > 0.0);
        }
    }

    #[test]
    fn watching_for_stick_changes_no_motion() {
        for contact in [None, Some("presliding:static"), Some("presliding:lugre")] {
            let model = contact.map_or_else(|| Ok(table()), |name| table().with(name, &[]));
            let model = model.unwrap();
            let motion = |mut plants: Plants| -> Vec<f64> {
                plants.start(0, &Start::at(0.0, 0.0));
                let force = |k: usize| 20.0 * (k as f64 * 0.02).sin();
                (0..2000)
                    .map(|k| {
                        plants.step(&[5e-4], &[force(k)]);
                        plants.position()[0]
                    })
                    .collect()
            };
            let plants = || Plants::uniform(&model, 1);
            assert_eq!(motion(plants()), motion(plants().watched()), "{contact:?}");
        }
    }
}
