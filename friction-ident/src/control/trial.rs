//! A controller on a plant along a reference, with and without compensation.

use crate::closed_loop::{ClosedLoopError, Pd, Run, Sample, Setup, closed_loop};
use crate::model::Model;
use crate::reference::Reference;

use super::compensator::{Compensated, Compensator, CompensatorError, Settings};
use super::measures::Measures;
use super::response::LinearLoop;

/// PD gains and the hardware around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Proportional gain, N/m or N m/rad.
    pub proportional: f64,
    /// Derivative gain on encoder differences, N s/m or N m s/rad.
    pub derivative: f64,
    /// Mass of an acceleration feed-forward, kg or kg m^2; 0 for none.
    pub feedforward: f64,
    /// Encoder, D/A converter, noise, step of the simulation.
    pub setup: Setup,
}

/// Natural frequency of a loop that is designed for a mass, in 1/sampling time.
const FREQUENCY: f64 = 0.2;
/// Highest natural frequency of such a loop, rad/s.
const HIGHEST: f64 = 150.0;
/// Its damping ratio.
const DAMPING: f64 = 0.7;

impl Servo {
    /// A loop that suits `mass` at `sample_time`: natural frequency 0.2 / sampling time, at most
    /// 150 rad/s, damping ratio 0.7.
    pub fn for_mass(mass: f64, sample_time: f64) -> Self {
        let frequency = (FREQUENCY / sample_time).min(HIGHEST);
        Self {
            proportional: mass * frequency * frequency,
            derivative: 2.0 * DAMPING * mass * frequency,
            feedforward: 0.0,
            setup: Setup::default(),
        }
    }

    /// The linear part of the loop around `model`.
    pub fn linear(&self, model: &Model, sample_time: f64) -> LinearLoop {
        LinearLoop {
            mass: model.mass(),
            damping: model.get("viscous.F_v").unwrap_or(0.0),
            proportional: self.proportional,
            derivative: self.derivative,
            sample_time,
        }
    }

    fn pd(&self) -> Pd {
        Pd::new(self.proportional, self.derivative).with_feedforward(self.feedforward)
    }
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ControlError {
    /// The compensator cannot be built.
    #[error(transparent)]
    Compensator(#[from] CompensatorError),
    /// The loop cannot be simulated.
    #[error(transparent)]
    Loop(#[from] ClosedLoopError),
}

/// A run and what is measured of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// The run.
    pub run: Run,
    /// Its measures.
    pub measures: Measures,
    /// Force of the compensator at each sample, N or N m; empty without one.
    pub compensation: Vec<f64>,
}

/// Runs `servo` on `plant`, with `compensator` on top where there is one.
///
/// # Errors
/// The plant runs away.
pub fn run(
    plant: &Model,
    reference: &Reference,
    servo: &Servo,
    compensator: Option<&Compensator>,
) -> Result<Trial, ControlError> {
    let run = match compensator {
        None => closed_loop(plant, reference, &mut servo.pd(), &servo.setup)?,
        Some(compensator) => {
            let mut controller = Compensated::new(servo.pd(), compensator.clone());
            closed_loop(plant, reference, &mut controller, &servo.setup)?
        }
    };
    let measures = Measures::of(&run, reference, servo.setup.encoder_resolution);
    let compensation = match compensator {
        None => Vec::new(),
        Some(compensator) => {
            let mut compensator = compensator.clone();
            samples(&run, reference).iter().map(|sample| compensator.force(sample)).collect()
        }
    };
    Ok(Trial { run, measures, compensation })
}

/// What the controller saw in a run.
pub fn samples(run: &Run, reference: &Reference) -> Vec<Sample> {
    let shown = run.recording.require("position").unwrap_or(&run.position);
    (0..shown.len())
        .map(|k| Sample {
            time: k as f64 * reference.sample_time,
            reference: reference.position[k],
            reference_velocity: reference.velocity[k],
            reference_acceleration: reference.acceleration[k],
            position: shown[k],
        })
        .collect()
}

/// PD alone and PD with the compensator of `model`, on the same plant.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// PD alone.
    pub pd: Trial,
    /// PD with compensation.
    pub compensated: Trial,
}

/// Runs both.
///
/// # Errors
/// The compensator cannot be built, or the plant runs away.
pub fn compare(
    plant: &Model,
    model: &Model,
    reference: &Reference,
    servo: &Servo,
    settings: Settings,
) -> Result<Comparison, ControlError> {
    let compensator = Compensator::new(model, settings)?;
    Ok(Comparison {
        pd: run(plant, reference, servo, None)?,
        compensated: run(plant, reference, servo, Some(&compensator))?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::course::Course;
    use super::*;
    use crate::axis::Axis;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn an_exact_model_cancels_the_friction(
            coulomb in 2.0f64..20.0, viscous in 0.0f64..400.0, speed in 2e-3f64..0.05, offset in -3.0f64..3.0,
        ) {
            let model = Model::new(Axis::Linear, 30.0)
                .and_then(|m| m.with("coulomb", &[("F_C", coulomb)]))
                .and_then(|m| m.with("viscous", &[("F_v", viscous)]))
                .and_then(|m| m.with("offset", &[("F_0", offset)]))
                .unwrap();
            let mut servo = Servo::for_mass(30.0, 1e-3);
            servo.setup.encoder_resolution = 0.0;
            let reference = Course::Ramp { speed }.sampled(1e-3, 2.0);
            let settings = Settings::new(1e-3, 1e-4);
            let both = compare(&model, &model, &reference, &servo, settings).unwrap();
            // What is left is the start: nothing accelerates the mass but the controller.
            let late = |trial: &Trial| {
                (1500..2000).map(|k| (reference.position[k] - trial.run.position[k]).abs()).fold(0.0, f64::max)
            };
            prop_assert!(late(&both.compensated) < 1e-8, "{}", late(&both.compensated));
            // Alone, PD needs the friction's force as an error.
            let needed = (coulomb + viscous * speed + offset) / servo.proportional;
            prop_assert!((late(&both.pd) / needed - 1.0).abs() < 1e-3, "{} {needed}", late(&both.pd));
        }
    }

    #[test]
    fn the_converter_has_steps_and_a_range() {
        let model =
            Model::new(Axis::Linear, 30.0).unwrap().with("coulomb", &[("F_C", 8.0)]).unwrap();
        let mut servo = Servo::for_mass(30.0, 1e-3);
        (servo.setup.force_resolution, servo.setup.force_limit) = (0.5, 9.0);
        let reference = Course::Ramp { speed: 0.05 }.sampled(1e-3, 0.5);
        let trial = run(&model, &reference, &servo, None).unwrap();
        let steps = trial.run.command.iter().map(|f| f / 0.5);
        assert!(steps.clone().all(|step| step == step.round() && step.abs() <= 18.0));
        assert!(steps.clone().any(|step| step == 18.0));
    }
}
