//! The closed loop: a model under the controller that the recording shows, following its reference.
//!
//! The controller is taken from the recording: the recorded force as a linear function of position error,
//! velocities and acceleration of the reference. Where that describes the force, the loop is simulated.

use missing_physics::report::{Caveat, Compares, View};
use missing_physics::statistics::basis::{dot, gram, solve};
use missing_physics::statistics::split::Split;

use super::NoView;
use crate::axis::Quantity;
use crate::closed_loop::{ClosedLoopError, Controller, Sample, Setup, closed_loop};
use crate::family::FrictionFamily;
use crate::model::Model;
use crate::reference::Reference;

/// Least share of the force's variance that the controller must describe.
const DESCRIBED: f64 = 0.9;
/// A loop that tells models apart by less than this factor from a bare mass hides friction.
const HIDDEN: f64 = 20.0;

/// The view, or why there is none.
pub fn view(family: &FrictionFamily, model: &Model, split: &Split) -> Result<View, NoView> {
    let recording = &family.recording;
    if recording.channel("reference").is_none() {
        return Err(NoView::NoReference);
    }
    let [range] = recording.segments() else {
        return Err(NoView::SeveralSegments);
    };
    if family.prepared.time.len() != recording.len() {
        return Err(NoView::NotUniform);
    }
    let (force, position) = (recording.require("force")?, recording.require("position")?);
    let reference = reference(recording.require("reference")?, family.prepared.interval);
    let law = Law::of(&reference, position, force)?;
    let limit = force.iter().fold(0.0f64, |most, force| most.max(force.abs()));
    let run = |model: &Model| -> Result<Vec<f64>, ClosedLoopError> {
        // As fine as the model of the plant needs; the encoder plays no part in a difference of models.
        let setup = Setup { encoder_resolution: 0.0, force_limit: 1.5 * limit, ..Setup::default() };
        let mut law = law.clone();
        let run = closed_loop(model, &reference, &mut law, &setup)?;
        Ok(position.iter().zip(&run.position).map(|(a, b)| a - b).collect())
    };
    let error = run(model)?;
    let metrics = family.by_blocks(&error, position, range.clone(), split);
    let unit = family.axis.unit(Quantity::Length);
    let bare = Model::new(model.axis(), model.mass()).ok().and_then(|bare| run(&bare).ok());
    let bare = bare.map(|bare| family.by_blocks(&bare, position, range.clone(), split).validation);
    let hidden = bare.filter(|bare| {
        bare.relative.is_some_and(|share| share < 0.01)
            || bare.rms < HIDDEN * metrics.validation.rms
    });
    let hidden =
        hidden.map(|bare| Caveat::Hidden { bare: bare.rms, share: bare.relative.unwrap_or(0.0) });
    let lag: Vec<f64> = reference.position.iter().zip(position).map(|(r, x)| r - x).collect();
    let lag = (dot(&lag, &lag) / lag.len() as f64).sqrt();
    Ok(View {
        name: "closed loop".into(),
        compares: Compares::ClosedLoop { described: law.described, lag },
        unit: unit.to_owned(),
        metrics,
        floor: None,
        decides: false,
        caveat: hidden,
    })
}

fn reference(position: &[f64], interval: f64) -> Reference {
    let difference = |values: &[f64]| -> Vec<f64> {
        (0..values.len())
            .map(|k| {
                let (before, after) = (k.saturating_sub(1), (k + 1).min(values.len() - 1));
                (values[after] - values[before]) / (interval * (after - before).max(1) as f64)
            })
            .collect()
    };
    let velocity = difference(position);
    let acceleration = difference(&velocity);
    Reference { sample_time: interval, position: position.to_vec(), velocity, acceleration }
}

/// A controller that is linear in what it sees.
#[derive(Clone, Debug)]
struct Law {
    gains: Vec<f64>,
    described: f64,
    last: Option<(f64, f64)>,
}

impl Law {
    /// The controller behind a recorded force.
    fn of(reference: &Reference, position: &[f64], force: &[f64]) -> Result<Self, NoView> {
        let interval = reference.sample_time;
        let rows: Vec<Vec<f64>> = (1..position.len())
            .map(|k| {
                let velocity = (position[k] - position[k - 1]) / interval;
                let seen = Sample {
                    time: 0.0,
                    reference: reference.position[k],
                    reference_velocity: reference.velocity[k],
                    reference_acceleration: reference.acceleration[k],
                    position: position[k],
                };
                regressors(&seen, velocity).to_vec()
            })
            .collect();
        let mut columns: Vec<Vec<f64>> =
            (0..COUNT).map(|j| rows.iter().map(|row| row[j]).collect()).collect();
        let target = &force[1..];
        let sizes: Vec<f64> = columns
            .iter()
            .map(|column| (dot(column, column) / column.len() as f64).sqrt().max(f64::MIN_POSITIVE))
            .collect();
        for (column, size) in columns.iter_mut().zip(&sizes) {
            for value in column {
                *value /= size;
            }
        }
        let moment: Vec<f64> = columns.iter().map(|column| dot(column, target)).collect();
        let active: Vec<usize> = (0..COUNT).collect();
        let scaled = solve(&gram(&columns), &moment, &active);
        let mean = target.iter().sum::<f64>() / target.len() as f64;
        let total: f64 = target.iter().map(|f| (f - mean).powi(2)).sum();
        let left: f64 = (0..target.len())
            .map(|k| {
                let law: f64 = scaled.iter().zip(&columns).map(|(gain, c)| gain * c[k]).sum();
                (target[k] - law).powi(2)
            })
            .sum();
        let described = 1.0 - left / total.max(f64::MIN_POSITIVE);
        if described.is_nan() || described < DESCRIBED {
            return Err(NoView::UnknownController { described: described.max(0.0) });
        }
        let gains = scaled.iter().zip(&sizes).map(|(gain, size)| gain / size).collect();
        Ok(Self { gains, described, last: None })
    }
}

const COUNT: usize = 5;

/// Position error, velocities of reference and drive, acceleration of the reference, a constant.
fn regressors(seen: &Sample, velocity: f64) -> [f64; COUNT] {
    let error = seen.reference - seen.position;
    [error, seen.reference_velocity, velocity, seen.reference_acceleration, 1.0]
}

impl Controller for Law {
    fn command(&mut self, sample: &Sample) -> f64 {
        // Before the first sample the drive moves as the reference does.
        let velocity = match self.last {
            Some((time, position)) => (sample.position - position) / (sample.time - time),
            None => sample.reference_velocity,
        };
        self.last = Some((sample.time, sample.position));
        dot(&self.gains, &regressors(sample, velocity))
    }
}
