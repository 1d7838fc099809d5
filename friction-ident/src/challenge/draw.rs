//! Random tables and random parameters of the effect to hide.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{ChallengeError, Hide, Level, STROKE};
use crate::axis::Axis;
use crate::effects::{ALL, Effect, Role, find};
use crate::model::{Model, ModelError, address};

/// Effects that every axis has.
const BASE: [&str; 3] = ["coulomb", "viscous", "offset"];

/// Effects that change another one: the table has that as well, and `random` does not choose them.
const COMPANIONS: [(&str, &str); 1] = [("frictional-memory", "stribeck")];

/// Screw leads on the market, m.
const LEADS: [f64; 4] = [2.5e-3, 4e-3, 5e-3, 10e-3];

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
                let alone = |name: &str| COMPANIONS.iter().all(|(effect, _)| *effect != name);
                let able: Vec<_> = ALL
                    .iter()
                    .filter(|effect| can_hide(**effect) && alone(effect.about().name))
                    .collect();
                Ok(Some(*able[self.random.random_range(0..able.len())]))
            }
            Hide::Effect(name) if BASE.contains(&name.as_str()) => {
                Err(ChallengeError::Base(name.clone()))
            }
            Hide::Effect(name) => {
                let effect = find(name)?;
                if can_hide(effect) {
                    Ok(Some(effect))
                } else {
                    Err(ChallengeError::NotHere(name.clone()))
                }
            }
        }
    }

    /// `base` with what `effect` acts on, if that is an effect of its own.
    pub fn companion(&mut self, base: Model, effect: &dyn Effect) -> Result<Model, ModelError> {
        match COMPANIONS.iter().find(|(name, _)| *name == effect.about().name) {
            None => Ok(base),
            Some((_, companion)) => self.full(&base, find(companion)?),
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
            let value = match (parameter.role, parameter.name) {
                (Role::Amplitude, _) => sign * self.amplitude(effect, parameter.name),
                (Role::Shape, "l") => LEADS[self.random.random_range(0..LEADS.len())],
                (Role::Shape, "x_0") => self.random.random_range(0.0..STROKE),
                (Role::Shape, _) => size * parameter.default,
                (Role::Fixed, "start") => 0.0,
                (Role::Fixed, "end") => STROKE,
                (Role::Fixed, _) => parameter.default,
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
    !BASE.contains(&effect.about().name) && effect.suits(Axis::Linear) && effect.shows_in_force()
}
