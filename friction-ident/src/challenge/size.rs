//! How large a hidden effect is, and how to make it as large as asked for.

use nalgebra::{DMatrix, DVector};

use super::{ChallengeError, ENCODER, FORCE_NOISE, SAMPLE_TIME, record};
use crate::closed_loop::Run;
use crate::driven::{MeasuredMotion, columns_along, force_along};
use crate::effects::{Effect, ParameterRole, Slot};
use crate::model::{Model, address};
use crate::signal::derivative;

/// Bandwidth to which a force can be followed through the encoder, Hz.
const BANDWIDTH: f64 = 60.0;

/// Share of the samples by which an effect's size is measured: many effects act only now and then.
const SHARE: f64 = 0.05;

/// Error of the force on `mass` at one sample, N: the noise of the recorded force, and the mass
/// times the noise of an acceleration that comes from the encoder through [`BANDWIDTH`].
pub(super) fn noise_force(mass: f64) -> f64 {
    // White noise q / sqrt(12) of the position, differentiated twice up to the cut-off frequency:
    // variance q^2 / 12 * 2 T * integral_0^B (2 pi f)^4 df.
    let w = std::f64::consts::TAU * BANDWIDTH;
    let acceleration = ENCODER * w * w * (2.0 * SAMPLE_TIME * BANDWIDTH / 60.0).sqrt();
    FORCE_NOISE.hypot(mass * acceleration)
}

/// `full` with the effect scaled to `ratio` times the noise, as far as it can; and the force, N,
/// that it adds.
pub(super) fn scaled(
    base: &Model,
    full: &Model,
    effect: &'static dyn Effect,
    ratio: f64,
    seed: u64,
) -> Result<(Model, f64), ChallengeError> {
    if effect.about().acts_on(Slot::Contact) {
        return contact(base, full, effect, ratio, seed);
    }
    let target = ratio * noise_force(base.mass());
    let knob = Knob::of(effect);
    let (mut low, mut high) = (knob.low.ln(), knob.high.ln());
    let mut best = knob.turned(full, effect, 1.0)?;
    let mut size = 0.0;
    for _ in 0..10 {
        let middle = 0.5 * (low + high);
        best = knob.turned(full, effect, middle.exp())?;
        // A plant that runs away is one with too much of the effect.
        size = record(&best, seed).map_or(f64::INFINITY, |run| added_force(base, &best, &run));
        if size > target { high = middle } else { low = middle }
    }
    if !size.is_finite() {
        best = knob.turned(full, effect, low.exp())?;
        size = added_force(base, &best, &record(&best, seed)?);
    }
    Ok((best, size))
}

/// A contact adds a force over a distance after each reversal; how well that is seen is a matter of
/// the distance: `ratio` counts of the encoder up to breakaway.
fn contact(
    base: &Model,
    full: &Model,
    effect: &'static dyn Effect,
    ratio: f64,
    seed: u64,
) -> Result<(Model, f64), ChallengeError> {
    let mut model = full.clone();
    let stiffness = base.get("coulomb.F_C")? / (ratio * ENCODER);
    model.set(&address(effect, "k_t"), stiffness)?;
    let size = added_force(base, &model, &record(&model, seed)?);
    Ok((model, size))
}

/// What makes an effect larger or smaller.
struct Knob {
    /// The shape parameter to turn; none for the amplitudes.
    shape: Option<&'static str>,
    /// Factor that makes the effect small.
    low: f64,
    /// Factor that makes it large.
    high: f64,
}

impl Knob {
    fn of(effect: &dyn Effect) -> Self {
        let about = effect.about();
        let amplitude = about.parameters.iter().any(|p| p.role == ParameterRole::Amplitude);
        let first = about.parameters.iter().find(|p| p.role == ParameterRole::Shape);
        match first {
            Some(shape) if about.is_limit_of_drive(shape) => {
                Self { shape: Some(shape.name), low: 20.0, high: 1e-2 }
            }
            Some(shape) if !amplitude => Self { shape: Some(shape.name), low: 1e-2, high: 20.0 },
            _ => Self { shape: None, low: 1e-3, high: 1e2 },
        }
    }

    fn turned(&self, model: &Model, effect: &dyn Effect, by: f64) -> Result<Model, ChallengeError> {
        let mut turned = model.clone();
        for parameter in effect.about().parameters {
            let turns = match self.shape {
                Some(name) => name == parameter.name,
                None => parameter.role == ParameterRole::Amplitude,
            };
            if turns {
                let at = address(effect, parameter.name);
                turned.set(&at, model.get(&at)? * by)?;
            }
        }
        Ok(turned)
    }
}

/// Force that `full` has beyond the reach of `base`'s structure along the motion of `run`, N: rms
/// of the largest [`SHARE`].
fn added_force(base: &Model, full: &Model, run: &Run) -> f64 {
    let time = run.recording.time();
    let acceleration = derivative(time, &run.velocity);
    let motion = MeasuredMotion::new(time, &run.position, &run.velocity, &acceleration);
    let Ok(motion) =
        motion.and_then(|motion| motion.with_cutoff(BANDWIDTH).with_drive_force(&run.command))
    else {
        return 0.0;
    };
    let force = DVector::from_vec(force_along(full, &motion));
    let columns: Vec<DVector<f64>> =
        columns_along(base, &motion).columns.into_iter().map(DVector::from_vec).collect();
    let columns = DMatrix::from_columns(&columns);
    // Normal equations: four well-scaled columns.
    let solution = (columns.tr_mul(&columns)).cholesky().map(|c| c.solve(&columns.tr_mul(&force)));
    let Some(solution) = solution else { return 0.0 };
    let mut left: Vec<f64> = (force - columns * solution).iter().map(|f| f * f).collect();
    left.sort_by(|a, b| b.total_cmp(a));
    let count = ((left.len() as f64 * SHARE) as usize).max(1);
    (left[..count].iter().sum::<f64>() / count as f64).sqrt()
}
