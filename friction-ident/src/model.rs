//! A plant: a mass (or an inertia) and the effects that act on it, with their parameters.

use serde::{Deserialize, Serialize};

use crate::axis::{Axis, Effort, Quantity};
use crate::effects::beside::is_beside;
use crate::effects::{Effect, Library, Parameter, ParameterRole, Slot, UnknownEffect};
use crate::known::Known;

mod file;
mod schema;

pub use schema::{SCHEMA, schema};

/// Why a model cannot be built, read or changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// An effect that the library does not know.
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    /// An address that the model does not have.
    #[error("the model has no parameter '{address}'\nit has: {}", .known.join(", "))]
    UnknownParameter {
        /// The address asked for.
        address: String,
        /// The addresses there are.
        known: Vec<String>,
    },
    /// A parameter without a value.
    #[error("effect '{effect}' lacks its parameter '{parameter}'\nit needs: {}", .needed.join(", "))]
    MissingParameter {
        /// The effect.
        effect: String,
        /// The parameter without a value.
        parameter: String,
        /// All parameters of the effect.
        needed: Vec<String>,
    },
    /// A value that is not finite, or not positive where it must be.
    #[error("'{address}' is {value}; {need}")]
    BadValue {
        /// The address.
        address: String,
        /// The value.
        value: f64,
        /// What it must be.
        need: &'static str,
    },
    /// The same effect twice.
    #[error("effect '{0}' stands twice in the model; name it once")]
    Duplicate(String),
    /// Two effects for a place that only one can take.
    #[error("'{first}' and '{second}' are both a {slot}; keep one of them")]
    Conflict {
        /// The effect that is there.
        first: String,
        /// The effect that comes in addition.
        second: String,
        /// The place.
        slot: &'static str,
    },
    /// An effect that only stands beside a force that another model gives.
    #[error(
        "'{0}' stands beside a force that another model gives: it needs a column of that force (--model-force)"
    )]
    NoPlace(String),
    /// Text that is not a model.
    #[error(
        "not a model: {0}\na model looks like {{\"axis\": \"linear\", \"mass\": 50.0, \"effects\": [{{\"effect\": \"coulomb\", \"parameters\": {{\"F_C\": 8.0}}}}]}}"
    )]
    Syntax(String),
}

/// An effect with the values of its parameters, in the order of its table.
#[derive(Clone)]
pub struct ModelEffect {
    effect: &'static dyn Effect,
    values: Vec<f64>,
}

impl ModelEffect {
    /// The effect.
    pub fn effect(&self) -> &'static dyn Effect {
        self.effect
    }

    /// Values of its parameters, in the order of its table.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same with amplitude `k` at 1 and all other amplitudes at 0.
    pub(crate) fn with_unit_amplitude(&self, k: usize) -> Self {
        let mut term = self.clone();
        for (index, parameter) in self.effect.about().parameters.iter().enumerate() {
            if parameter.role == ParameterRole::Amplitude {
                term.values[index] = f64::from(u8::from(index == k));
            }
        }
        term
    }

    /// The effect's name.
    pub fn name(&self) -> &'static str {
        self.effect.about().name
    }
}

impl std::fmt::Debug for ModelEffect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple(self.name()).field(&self.values).finish()
    }
}

impl PartialEq for ModelEffect {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name() && self.values == other.values
    }
}

/// The plant. A parameter's address is `effect.parameter`; the mass is `mass`.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    axis: Axis,
    effort: Effort,
    mass: f64,
    /// For a model beside a given force.
    timing: Option<Timing>,
    terms: Vec<ModelEffect>,
    known: Known,
}

/// Address of the mass or the inertia.
pub const MASS: &str = "mass";
/// Addresses of the timing of a model that stands beside a given force.
pub const SHIFT: &str = "timing.shift";
/// See [`SHIFT`].
pub const SMOOTHING: &str = "timing.smoothing";

/// How the force that another model gives stands to the recorded one: no physics, but what sampling and filters make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// How much later the recorded force is, s (half a sample where a command is held).
    #[serde(rename = "shift_s")]
    pub shift: f64,
    /// Variance of the smoothing that it went through, s^2: positions that were differentiated were smoothed.
    #[serde(rename = "smoothing_s2", default)]
    pub smoothing: f64,
}

const POSITIVE: &str = "it must be finite and above 0";
const FINITE: &str = "it must be finite";

impl Model {
    /// A mass (kg) or an inertia (kg m^2) without any effect.
    ///
    /// # Errors
    /// [`ModelError::BadValue`] unless `mass` is finite and positive.
    pub fn new(axis: Axis, mass: f64) -> Result<Self, ModelError> {
        check_mass(mass)?;
        let (effort, known) = (Effort::default(), Known::default());
        Ok(Self { axis, effort, mass, timing: None, terms: Vec::new(), known })
    }

    /// Effects beside a force that another model gives for every sample of a recording: without a mass of its own, so
    /// that it can be compared with a recording but not be simulated.
    ///
    /// # Errors
    /// [`ModelError::BadValue`] unless `timing` is finite.
    pub fn beside(axis: Axis, timing: Timing) -> Result<Self, ModelError> {
        let known = Known::default();
        let none = Some(Timing::default());
        let effort = Effort::default();
        let mut model = Self { axis, effort, mass: 0.0, timing: none, terms: Vec::new(), known };
        model.set(SHIFT, timing.shift)?;
        model.set(SMOOTHING, timing.smoothing)?;
        Ok(model)
    }

    /// The same with an effort in another unit: its forces are voltages or currents.
    #[must_use]
    pub fn with_effort(mut self, effort: Effort) -> Self {
        self.effort = effort;
        self
    }

    /// What its forces are measured in.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// The same with what is known of its parameters from elsewhere, for whoever fits it again.
    #[must_use]
    pub fn with_known(mut self, known: Known) -> Self {
        self.known = known;
        self
    }

    /// What is known of its parameters from elsewhere.
    pub fn known(&self) -> &Known {
        &self.known
    }

    /// Timing of a model beside a given force; nothing for a plant of its own.
    pub fn timing(&self) -> Option<Timing> {
        self.timing
    }

    /// The same with one effect more; parameters that `values` does not name get typical values.
    ///
    /// # Errors
    /// The name of the effect or of a parameter is unknown, a value is not acceptable, or the
    /// effect has no place beside those there are.
    pub fn with(self, effect: &str, values: &[(&str, f64)]) -> Result<Self, ModelError> {
        let effect = Library::builtin().find(effect)?;
        let mut model = self.with_effect(effect)?;
        for (name, value) in values {
            model.set(&address(effect, name), *value)?;
        }
        Ok(model)
    }

    /// The same with `effect` at typical values.
    ///
    /// # Errors
    /// The effect is there already, or another one takes its place.
    pub fn with_effect(mut self, effect: &'static dyn Effect) -> Result<Self, ModelError> {
        self.check_place(effect)?;
        let typical = |parameter: &Parameter| parameter.typical(self.axis);
        let values = effect.about().parameters.iter().map(typical).collect();
        self.terms.push(ModelEffect { effect, values });
        Ok(self)
    }

    fn check_place(&self, effect: &'static dyn Effect) -> Result<(), ModelError> {
        let stem = |name: &'static str| name.split(':').next().unwrap_or(name);
        let about = effect.about();
        if self.timing.is_none() && is_beside(effect) {
            return Err(ModelError::NoPlace(about.name.to_owned()));
        }
        for term in &self.terms {
            let other = term.effect.about();
            if stem(other.name) == stem(about.name) {
                return Err(ModelError::Duplicate(about.name.to_owned()));
            }
            if about.acts_on(Slot::Contact) && other.acts_on(Slot::Contact) {
                return Err(ModelError::Conflict {
                    first: other.name.to_owned(),
                    second: about.name.to_owned(),
                    slot: Slot::Contact.name(),
                });
            }
        }
        Ok(())
    }

    /// The same without the effect called `name`.
    #[must_use]
    pub fn without(mut self, name: &str) -> Self {
        self.terms.retain(|term| term.name() != name);
        self
    }

    /// Linear or rotary.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// Mass, kg, or inertia, kg m^2; 0 for a model beside a given force.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// The effects with their values.
    pub fn terms(&self) -> &[ModelEffect] {
        &self.terms
    }

    /// The term of the effect called `name`.
    pub fn term(&self, name: &str) -> Option<&ModelEffect> {
        self.terms.iter().find(|term| term.name() == name)
    }

    /// Names of the effects.
    pub fn effects(&self) -> Vec<&'static str> {
        self.terms.iter().map(ModelEffect::name).collect()
    }

    /// Addresses of all parameters, the mass first (beside a given force: the shift).
    pub fn addresses(&self) -> Vec<String> {
        let parameters = self.terms.iter().flat_map(|term| {
            term.effect.about().parameters.iter().map(|p| address(term.effect, p.name))
        });
        let first: &[&str] = if self.timing.is_some() { &[SHIFT, SMOOTHING] } else { &[MASS] };
        first.iter().map(|name| (*name).to_owned()).chain(parameters).collect()
    }

    /// Values of all parameters, in the order of [`Model::addresses`].
    pub fn values(&self) -> Vec<f64> {
        let parameters = self.terms.iter().flat_map(|term| term.values.iter().copied());
        let first = match self.timing {
            Some(timing) => vec![timing.shift, timing.smoothing],
            None => vec![self.mass],
        };
        first.into_iter().chain(parameters).collect()
    }

    /// SI unit of the parameter at `address`.
    ///
    /// # Errors
    /// [`ModelError::UnknownParameter`].
    pub fn unit(&self, address: &str) -> Result<&'static str, ModelError> {
        match self.timing {
            Some(_) if address == SHIFT => return Ok("s"),
            Some(_) if address == SMOOTHING => return Ok("s^2"),
            None if address == MASS => return Ok(self.effort.unit(self.axis, Quantity::Mass)),
            _ => {}
        }
        let (term, index) = self.locate(address)?;
        let parameter = &self.terms[term].effect.about().parameters[index];
        Ok(self.effort.unit(self.axis, parameter.quantity))
    }

    /// The parameter's entry in its effect's table; none for the mass.
    pub fn parameter(&self, address: &str) -> Option<&'static Parameter> {
        let (term, index) = self.locate(address).ok()?;
        Some(&self.terms[term].effect.about().parameters[index])
    }

    /// Value at `address`.
    ///
    /// # Errors
    /// [`ModelError::UnknownParameter`].
    pub fn get(&self, address: &str) -> Result<f64, ModelError> {
        match self.timing {
            Some(timing) if address == SHIFT => return Ok(timing.shift),
            Some(timing) if address == SMOOTHING => return Ok(timing.smoothing),
            None if address == MASS => return Ok(self.mass),
            _ => {}
        }
        self.locate(address).map(|(term, index)| self.terms[term].values[index])
    }

    /// Sets the value at `address`.
    ///
    /// # Errors
    /// The address is unknown, or the value is not finite (or not positive where it must be).
    pub fn set(&mut self, address: &str, value: f64) -> Result<(), ModelError> {
        if let Some(timing) = self.timing.as_mut().filter(|_| [SHIFT, SMOOTHING].contains(&address))
        {
            if !value.is_finite() {
                let address = address.to_owned();
                return Err(ModelError::BadValue { address, value, need: FINITE });
            }
            *(if address == SHIFT { &mut timing.shift } else { &mut timing.smoothing }) = value;
            return Ok(());
        }
        if self.timing.is_none() && address == MASS {
            check_mass(value)?;
            self.mass = value;
            return Ok(());
        }
        let (term, index) = self.locate(address)?;
        let parameter = &self.terms[term].effect.about().parameters[index];
        if !parameter.accepts(value) {
            let need = if value.is_finite() { POSITIVE } else { FINITE };
            return Err(ModelError::BadValue { address: address.to_owned(), value, need });
        }
        self.terms[term].values[index] = value;
        Ok(())
    }

    /// Sets all values, in the order of [`Model::addresses`].
    ///
    /// # Errors
    /// As [`Model::set`]; too few or too many values are an unknown parameter.
    pub fn set_values(&mut self, values: &[f64]) -> Result<(), ModelError> {
        let addresses = self.addresses();
        if values.len() != addresses.len() {
            return Err(self.unknown(&format!("#{}", values.len())));
        }
        addresses.iter().zip(values).try_for_each(|(address, value)| self.set(address, *value))
    }

    fn locate(&self, address: &str) -> Result<(usize, usize), ModelError> {
        let found = address.rsplit_once('.').and_then(|(effect, name)| {
            let term = self.terms.iter().position(|term| term.name() == effect)?;
            Some((term, self.terms[term].effect.about().parameter(name)?))
        });
        found.ok_or_else(|| self.unknown(address))
    }

    fn unknown(&self, address: &str) -> ModelError {
        ModelError::UnknownParameter { address: address.to_owned(), known: self.addresses() }
    }

    /// Whether an effect acts through `slot`.
    pub fn acts_on(&self, slot: Slot) -> bool {
        self.terms.iter().any(|term| term.effect.about().acts_on(slot))
    }

    /// Whether the force of the drive comes later than its command.
    pub(crate) fn is_late(&self) -> bool {
        self.terms.iter().any(|term| term.effect.lateness(&term.values).is_some())
    }
}

fn check_mass(value: f64) -> Result<(), ModelError> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(ModelError::BadValue { address: MASS.to_owned(), value, need: POSITIVE })
}

/// Address of the parameter `name` of `effect`.
pub fn address(effect: &dyn Effect, name: &str) -> String {
    format!("{}.{name}", effect.about().name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Model {
        Model::new(Axis::Linear, 30.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
            .and_then(|m| m.with("stribeck", &[("dF", 4.0), ("v_s", 1e-3)]))
            .unwrap()
    }

    #[test]
    fn parameters_have_addresses_values_and_units() {
        let mut model = table();
        assert_eq!(model.addresses(), ["mass", "coulomb.F_C", "stribeck.dF", "stribeck.v_s"]);
        assert_eq!(model.values(), [30.0, 8.0, 4.0, 1e-3]);
        assert_eq!(model.unit("stribeck.v_s").unwrap(), "m/s");
        model.set("stribeck.dF", 5.0).unwrap();
        assert_eq!(model.get("stribeck.dF").unwrap(), 5.0);
        model.set_values(&[31.0, 7.0, 3.0, 2e-3]).unwrap();
        assert_eq!(model.values(), [31.0, 7.0, 3.0, 2e-3]);
    }

    #[test]
    fn an_unknown_address_lists_what_there_is() {
        let error = table().get("stribeck.vs").unwrap_err().to_string();
        assert!(error.contains("'stribeck.vs'") && error.contains("stribeck.v_s"), "{error}");
        assert!(table().set_values(&[1.0]).is_err());
    }

    #[test]
    fn values_that_no_model_can_have_are_refused() {
        let mut model = table();
        assert!(matches!(model.set("mass", -1.0), Err(ModelError::BadValue { .. })));
        assert!(matches!(model.set("mass", f64::NAN), Err(ModelError::BadValue { .. })));
        assert!(matches!(model.set("stribeck.v_s", 0.0), Err(ModelError::BadValue { .. })));
        let flat = table().with("motor-gain:knee", &[("n", 0.0)]);
        assert!(matches!(flat, Err(ModelError::BadValue { .. })));
        assert!(model.set("stribeck.dF", 0.0).is_ok());
    }

    #[test]
    fn an_effect_or_a_form_of_it_stands_once_in_a_model() {
        let error = table().with("stribeck:gaussian", &[]).unwrap_err();
        assert_eq!(error, ModelError::Duplicate("stribeck:gaussian".into()));
    }
}
