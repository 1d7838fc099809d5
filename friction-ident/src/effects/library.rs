//! The effects that a program knows by name: those built in, and a user's own.

use missing_physics::Recording;

use super::beside::{BESIDE, MODEL_FORCE};
use super::formula::FormulaError;
use super::regressor::{self, regressor, regressors};
use super::{ALL, Effect, formula};

/// A name that no effect has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown effect '{name}'{}\nknown effects: {}", nearest(.hint.as_deref()), .known.join(", "))]
pub struct UnknownEffect {
    /// The name asked for.
    pub name: String,
    /// The nearest name, if one is near.
    pub hint: Option<String>,
    /// All names.
    pub known: Vec<String>,
}

fn nearest(hint: Option<&str>) -> String {
    hint.map(|name| format!("; did you mean '{name}'?")).unwrap_or_default()
}

/// Similarity (0..1) from which a name is offered as the one that was meant.
const NEAR: f64 = 0.6;

/// A set of effects, found by name.
#[derive(Clone)]
pub struct Library {
    effects: Vec<&'static dyn Effect>,
}

/// What a comparison of forces can show of [`ALL`]: see [`Effect::shows_in_force`].
impl Default for Library {
    fn default() -> Self {
        let mut library = Self::builtin();
        library.effects.retain(|effect| {
            effect.shows_in_force() || effect.forms().iter().any(|form| form.shows_in_force())
        });
        library
    }
}

impl Library {
    /// [`ALL`].
    pub fn builtin() -> Self {
        Self { effects: ALL.to_vec() }
    }

    /// The same with one effect more. An effect of the same name is replaced.
    #[must_use]
    pub fn with(mut self, effect: &'static dyn Effect) -> Self {
        self.effects.retain(|other| other.about().name != effect.about().name);
        self.effects.push(effect);
        self
    }

    /// The same with the regressors that a recording holds.
    ///
    /// # Errors
    /// A regressor that is called like another effect, or that cannot stand in a list.
    pub fn with_regressors(mut self, recording: &Recording) -> Result<Self, FormulaError> {
        for name in regressors(recording) {
            let known = self.find(name).ok().map(|effect| effect.about().reference);
            if known == Some(formula::REFERENCE) {
                return Err(FormulaError::Twice(name.to_owned()));
            }
            if known != Some(regressor::REFERENCE) {
                self = self.with(regressor(name)?);
            }
        }
        Ok(self)
    }

    /// Names of the effects of a base model that nobody named: those that every axis has; none beside a force that the
    /// user's own model gives.
    pub fn usual(recording: &Recording) -> Vec<String> {
        let own = recording.channel(MODEL_FORCE).is_some();
        let usual = ALL.iter().filter(|effect| effect.is_usual() && !own);
        usual.map(|effect| effect.about().name.to_owned()).collect()
    }

    /// All effects, in their default form.
    pub fn effects(&self) -> &[&'static dyn Effect] {
        &self.effects
    }

    /// The effect called `name`: `effect` or `effect:form`; those that stand beside a given force are found, too.
    ///
    /// # Errors
    /// [`UnknownEffect`] with the nearest name and the list of all.
    pub fn find(&self, name: &str) -> Result<&'static dyn Effect, UnknownEffect> {
        let mut all = self
            .effects
            .iter()
            .flat_map(|effect| std::iter::once(*effect).chain(effect.forms().iter().copied()))
            .chain(BESIDE.iter().copied());
        all.find(|effect| effect.about().name == name).ok_or_else(|| self.unknown(name))
    }

    fn unknown(&self, name: &str) -> UnknownEffect {
        let known: Vec<String> =
            self.effects.iter().map(|effect| effect.about().name.to_owned()).collect();
        let hint = known
            .iter()
            .map(|other| (strsim::jaro_winkler(&name.to_lowercase(), other), other))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|(similarity, _)| *similarity > NEAR)
            .map(|(_, other)| other.clone());
        UnknownEffect { name: name.to_owned(), hint, known }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ParameterRole, Scale, find};
    use super::*;

    #[test]
    fn a_misspelt_effect_gets_the_nearest_name() {
        let error = find("stribek").err().unwrap();
        assert_eq!(error.hint.as_deref(), Some("stribeck"));
        assert!(error.to_string().contains("did you mean 'stribeck'"));
        assert!(error.to_string().contains("coulomb, viscous"));
    }

    #[test]
    fn names_are_unique_and_found() {
        for effect in ALL {
            let name = effect.about().name;
            assert_eq!(find(name).unwrap().about().name, name);
            assert_eq!(ALL.iter().filter(|other| other.about().name == name).count(), 1);
            for form in effect.forms() {
                let form = form.about().name;
                assert!(form.starts_with(&format!("{name}:")), "{form}");
                assert_eq!(find(form).unwrap().about().name, form);
            }
        }
    }

    #[test]
    fn tables_of_parameters_are_sound() {
        for effect in ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())) {
            let about = effect.about();
            assert!(!about.parameters.is_empty() && !about.slots.is_empty(), "{}", about.name);
            assert!(!about.equation.is_empty() && !about.shows.is_empty(), "{}", about.name);
            for p in about.parameters {
                assert!(p.low < p.high, "{}.{}", about.name, p.name);
                assert!(p.low <= p.default && p.default <= p.high, "{}.{}", about.name, p.name);
                assert!(p.accepts(p.low) && p.accepts(p.default), "{}.{}", about.name, p.name);
                assert!(
                    p.role != ParameterRole::Amplitude || p.scale == Scale::Linear,
                    "{}",
                    p.name
                );
            }
        }
    }
}
