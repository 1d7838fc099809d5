//! What is known of a task.

use aep_core::{Domain, Scale};

use super::Identification;

/// An identification task: parameters, model, recording, the best that is known.
#[derive(Clone, Copy, Debug)]
pub struct Task {
    /// Short name, as used on the command line.
    pub name: &'static str,
    /// What is identified from what.
    pub subject: &'static str,
    /// What makes it easy or hard.
    pub character: &'static str,
    /// Where the model comes from.
    pub reference: &'static str,
    /// The unknown parameters.
    pub parameters: &'static [Parameter],
    /// Standard deviation of what the simulator itself adds to each prediction, in standard deviations
    /// of the sensor; 0 for a simulator that gives the same again.
    pub noise: f64,
    /// How far above the best cost, as a share of it, a run counts as successful.
    pub tolerance: f64,
    /// The best that is known.
    pub best: Best,
    /// Makes the model, with what it knows of the recording.
    pub model: fn() -> Box<dyn Model>,
}

/// A parameter to be identified.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// Its unit; "1" for a number.
    pub unit: &'static str,
    /// The value that the recording was made with.
    pub truth: f64,
    /// Where it is looked for.
    pub limits: (f64, f64),
    /// How it is looked for.
    pub scale: Scale,
}

/// The best parameters that an independent search found.
#[derive(Clone, Copy, Debug)]
pub struct Best {
    /// Their cost, without the noise of the simulator.
    pub cost: f64,
    /// The parameters, in the order of [`Task::parameters`].
    pub position: &'static [f64],
}

/// What the sensors say for given parameters.
pub trait Model: Send + Sync {
    /// Appends the predictions, each in standard deviations of its sensor, as many for every `p`; NaN
    /// where there is none.
    fn predict(&self, p: &[f64], out: &mut Vec<f64>);

    /// The recording, where it is not the prediction with the true parameters and noise.
    fn recording(&self) -> Option<Vec<f64>> {
        None
    }
}

impl Task {
    /// The task as a problem.
    pub fn problem(&'static self) -> Identification {
        Identification::new(self)
    }

    /// Where the parameters are looked for.
    pub fn domain(&self) -> Domain {
        let of = |value: fn(&Parameter) -> f64| self.parameters.iter().map(value).collect();
        let scales = self.parameters.iter().map(|parameter| parameter.scale).collect();
        let names = self.parameters.iter().map(|parameter| parameter.name);
        Domain::new(of(|p| p.limits.0), of(|p| p.limits.1))
            .and_then(|domain| domain.with_scales(scales))
            .and_then(|domain| domain.with_names(names))
            .expect("limits in this crate are valid")
    }

    /// The parameters that the recording was made with.
    pub fn truth(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.truth).collect()
    }
}

/// A parameter on a linear scale.
pub(super) const fn linear(
    name: &'static str,
    unit: &'static str,
    truth: f64,
    limits: (f64, f64),
) -> Parameter {
    Parameter { name, unit, truth, limits, scale: Scale::Linear }
}

/// A parameter whose order of magnitude is unknown.
pub(super) const fn decades(
    name: &'static str,
    unit: &'static str,
    truth: f64,
    limits: (f64, f64),
) -> Parameter {
    Parameter { name, unit, truth, limits, scale: Scale::Log }
}
