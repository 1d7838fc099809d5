//! Random tables and random parameters of the effect to hide.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{ChallengeError, Hide, Level, STROKE};
use crate::axis::Axis;
use crate::effects::{ALL, Effect, Extent, ParameterRole, find};
use crate::model::{Model, ModelError, address};

pub(super) struct Draw {
    random: Xoshiro256PlusPlus,
}

impl Draw {
    pub fn new(seed: u64) -> Self {
        Self { random: Xoshiro256PlusPlus::seed_from_u64(seed) }
    }

    /// A table around typical values.
    pub fn base(&mut self) -> Result<Model, ModelError> {
        Model::new(Axis::Linear, self.log_uniform(25.0, 60.0))?
            .with("coulomb", &[("F_C", self.log_uniform(7.0, 16.0))])?
            .with("viscous", &[("F_v", self.log_uniform(120.0, 350.0))])?
            .with("offset", &[("F_0", self.random.random_range(-2.0..2.0))])
    }

    pub fn hidden(&mut self, hide: &Hide) -> Result<Option<&'static dyn Effect>, ChallengeError> {
        match hide {
            Hide::Nothing => Ok(None),
            Hide::Random => {
                // What changes another effect is hidden with that one, where it is asked for.
                let alone = |effect: &&&dyn Effect| effect.companion().is_none();
                let able: Vec<_> =
                    ALL.iter().filter(|effect| can_hide(**effect)).filter(alone).collect();
                Ok(Some(*able[self.random.random_range(0..able.len())]))
            }
            Hide::Effect(name) => {
                let effect = find(name)?;
                if effect.is_usual() {
                    Err(ChallengeError::Base(name.clone()))
                } else if can_hide(effect) {
                    Ok(Some(effect))
                } else {
                    Err(ChallengeError::NotHere(name.clone()))
                }
            }
        }
    }

    /// `base` with what `effect` acts on, if that is an effect of its own.
    pub fn companion(&mut self, base: Model, effect: &dyn Effect) -> Result<Model, ModelError> {
        match effect.companion() {
            None => Ok(base),
            Some(companion) => self.full(&base, find(companion)?),
        }
    }

    /// Size of the hidden effect against the noise.
    pub fn ratio(&mut self, level: Level) -> f64 {
        let (low, high) = level.range();
        self.log_uniform(low, high)
    }

    /// `base` with `effect` at random values, of no particular size yet.
    pub fn full(&mut self, base: &Model, effect: &'static dyn Effect) -> Result<Model, ModelError> {
        let mut model = base.clone().with_effect(effect)?;
        for parameter in effect.about().parameters {
            let size = self.log_uniform(0.5, 2.0);
            let sign = if parameter.low < 0.0 && self.random.random() { -1.0 } else { 1.0 };
            let value = match (parameter.role, parameter.extent) {
                (ParameterRole::Amplitude, _) => sign * self.amplitude(effect, parameter.name),
                (ParameterRole::Shape, Some(Extent::StrokeMiddle)) => {
                    self.random.random_range(0.0..STROKE)
                }
                (ParameterRole::Shape, _) => match effect.drawn_from(parameter.name) {
                    Some(sold) => sold[self.random.random_range(0..sold.len())],
                    None => size * parameter.default,
                },
                (ParameterRole::Fixed, Some(Extent::StrokeBegin)) => 0.0,
                (ParameterRole::Fixed, Some(Extent::StrokeEnd)) => STROKE,
                (ParameterRole::Fixed, _) => parameter.default,
            };
            model.set(&address(effect, parameter.name), value)?;
        }
        Ok(model)
    }

    /// Amplitudes of one effect relative to each other; higher terms of a series are smaller.
    fn amplitude(&mut self, effect: &dyn Effect, name: &str) -> f64 {
        let parameter = effect.about().parameter(name).map(|k| effect.about().parameters[k]);
        let unit = parameter.map_or(1.0, |p| if p.default == 0.0 { 1.0 } else { p.default.abs() });
        let order = name.rsplit_once('_').and_then(|(_, k)| k.parse().ok()).unwrap_or(1.0f64);
        unit * self.log_uniform(0.5, 1.0) / order
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.random.random())
    }
}

fn can_hide(effect: &dyn Effect) -> bool {
    !effect.is_usual() && effect.suits(Axis::Linear) && effect.shows_in_force()
}
