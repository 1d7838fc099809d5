//! Values of terms as a plant, and a plant as values of terms.

use missing_physics::Fitted;

use super::{FrictionFamily, PreparationError, limits};
use crate::driven::force_along;
use crate::effects::{Effect, Library, formula};
use crate::model::{MASS, Model, ModelError, SHIFT, SMOOTHING, Timing, address};

impl FrictionFamily {
    /// A fitted model as a plant.
    ///
    /// # Errors
    /// The terms do not fit together.
    pub fn model(&self, fitted: &Fitted) -> Result<Model, ModelError> {
        let mut mass = self.known.fixed.get(MASS).copied().unwrap_or(1.0);
        let known = |address: &str| self.known.fixed.get(address).copied().unwrap_or(0.0);
        let mut timing = Timing { shift: known(SHIFT), smoothing: known(SMOOTHING) };
        let mut effects = Vec::new();
        for (position, &index) in fitted.terms.iter().enumerate() {
            let values = &fitted.values[fitted.range(self, position)];
            match index {
                0 => {
                    for (parameter, value) in self.terms[0].parameters.iter().zip(values) {
                        match parameter.name.as_str() {
                            "shift" => timing.shift = *value,
                            "smoothing" => timing.smoothing = *value,
                            _ => mass = *value,
                        }
                    }
                }
                _ => effects.push((self.effects[index - 1], values)),
            }
        }
        let mut model = match &self.given {
            Some(_) => Model::beside(self.axis, timing)?,
            None => Model::new(self.axis, mass)?,
        }
        .with_effort(self.effort);
        for (effect, values) in effects {
            model = model.with_effect(effect)?;
            let mut values = values.iter();
            for parameter in effect.about().parameters {
                let value = if let Some(known) = self.known_value(effect, parameter.name) {
                    Some(known)
                } else if limits::is_fixed(parameter) {
                    parameter.extent.and_then(|extent| self.extent(extent))
                } else {
                    values.next().copied()
                };
                if let Some(value) = value {
                    model.set(&address(effect, parameter.name), value)?;
                }
            }
        }
        Ok(model)
    }

    /// A plant as values of this family's terms.
    ///
    /// # Errors
    /// An effect of the plant is not in the family's library.
    pub fn fitted(&self, model: &Model) -> Result<Fitted, ModelError> {
        let mut fitted = match model.timing() {
            Some(timing) => self.timed(timing),
            None => self.bare(model.mass()),
        };
        for term in model.terms() {
            let found = self.effects.iter().position(|e| e.about().name == term.name());
            let Some(index) = found else {
                return Err(Library::builtin().find(term.name()).err().map_or_else(
                    || ModelError::Syntax(format!("effect '{}' cannot be compared", term.name())),
                    ModelError::from,
                ));
            };
            fitted.terms.push(index + 1);
            let parameters = term.effect().about().parameters.iter().zip(term.values());
            let is_free = |p: &crate::effects::Parameter| {
                !limits::is_fixed(p) && self.known_value(term.effect(), p.name).is_none()
            };
            fitted.values.extend(parameters.filter(|(p, _)| is_free(p)).map(|(_, value)| *value));
        }
        Ok(fitted)
    }

    /// The force that a model requires along the measured motion, sample by sample.
    pub(super) fn required(&self, fitted: &Fitted) -> Result<Vec<f64>, ModelError> {
        let model = self.model(fitted)?;
        match &self.given {
            Some(given) => given.required(self, &model),
            None => Ok(self.driven(|motion| force_along(&model, motion))),
        }
    }

    /// A given force with this timing alone.
    pub(super) fn timed(&self, timing: Timing) -> Fitted {
        let parameters = self.terms[0].parameters.iter();
        let value = |shift: bool| if shift { timing.shift } else { timing.smoothing };
        Fitted { terms: vec![0], values: parameters.map(|p| value(p.name == "shift")).collect() }
    }

    pub(super) fn known_value(&self, effect: &dyn Effect, parameter: &str) -> Option<f64> {
        if self.known.fixed.is_empty() {
            return None;
        }
        self.known.fixed.get(&address(effect, parameter)).copied()
    }

    /// A model of the first term alone.
    pub(super) fn bare(&self, value: f64) -> Fitted {
        Fitted { terms: vec![0], values: vec![value; self.terms[0].parameters.len()] }
    }

    /// Whether a model requires a force everywhere along the measured motion.
    ///
    /// # Errors
    /// A law of it has no value somewhere.
    pub fn check(&self, model: &Model) -> Result<(), PreparationError> {
        let Ok(force) = self.fitted(model).and_then(|fitted| self.required(&fitted)) else {
            return Ok(());
        };
        let name = || {
            let user =
                model.terms().iter().find(|t| t.effect().about().reference == formula::REFERENCE);
            user.or(model.terms().first()).map_or("the model", |term| term.name()).to_owned()
        };
        self.finite(&force, name)
    }

    pub(super) fn finite(
        &self,
        force: &[f64],
        effect: impl Fn() -> String,
    ) -> Result<(), PreparationError> {
        let Some(k) = force.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let p = &self.prepared;
        Err(PreparationError::Law {
            effect: effect(),
            value: force[k],
            sample: k + 1,
            time: p.time[k],
            position: p.position[k],
            velocity: p.velocity[k],
        })
    }

    /// Laws of the user must have a value along the whole motion, where nothing of them is fitted yet.
    pub(super) fn check_laws(&self) -> Result<(), PreparationError> {
        for effect in self.effects.iter().filter(|e| e.about().reference == formula::REFERENCE) {
            if let Some(name) = effect.columns().iter().find(|_| !effect.is_bound()) {
                let (effect, column) = (effect.about().name.to_owned(), name.clone());
                return Err(PreparationError::Column { effect, column });
            }
            let Ok(plant) = Model::new(self.axis, 1.0).and_then(|m| m.with_effect(*effect)) else {
                continue;
            };
            let force = self.driven(|motion| force_along(&plant, motion));
            self.finite(&force, || effect.about().name.to_owned())?;
        }
        Ok(())
    }

    /// The value of the first term at which a term alone is looked at.
    pub(super) fn neutral(&self) -> f64 {
        if self.given.is_some() { 0.0 } else { 1.0 }
    }

    /// Mass of a model; beside a given force what that one seems to have.
    pub(super) fn mass_of(&self, fitted: &Fitted) -> f64 {
        match &self.given {
            Some(given) => given.mass,
            None => match self.known.fixed.get(MASS) {
                Some(mass) => *mass,
                None => fitted.values.first().copied().unwrap_or(1.0),
            },
        }
    }
}
