//! Parameters that are known from elsewhere: fixed at a value, or kept within bounds.

use std::collections::BTreeMap;

use missing_physics::{Term, TermParameter};
use serde::{Deserialize, Serialize};

/// What is known of parameters, by address (`mass`, `viscous.F_v`).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Known {
    /// Values that are not fitted, SI.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub fixed: BTreeMap<String, f64>,
    /// Least and largest value of a fit, SI.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub bounds: BTreeMap<String, (f64, f64)>,
}

/// What is said to be known and cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KnownError {
    /// No effect has such a parameter.
    #[error("there is no parameter '{address}'{}\nparameters are called mass or EFFECT.PARAMETER; 'aep effects EFFECT' lists them", nearest(.hint.as_deref()))]
    Unknown {
        /// The address asked for.
        address: String,
        /// The nearest one, if one is near.
        hint: Option<String>,
    },
    /// A value that the parameter cannot have.
    #[error("'{address}' cannot be {value}: {need}\ngive a value that the parameter can have")]
    Value {
        /// The address.
        address: String,
        /// The value.
        value: f64,
        /// What it must be.
        need: String,
    },
    /// Bounds that leave nothing between them.
    #[error(
        "the bounds of '{address}' are {low} and {high}: the first one must be below the second\nwrite --bound {address}=LOW..HIGH, or --fix {address}=VALUE"
    )]
    Bounds {
        /// The address.
        address: String,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
}

fn nearest(hint: Option<&str>) -> String {
    hint.map(|name| format!("; did you mean '{name}'?")).unwrap_or_default()
}

/// Similarity (0..1) from which an address is offered as the one that was meant.
const NEAR: f64 = 0.8;

impl Known {
    /// Whether nothing is known.
    pub fn is_empty(&self) -> bool {
        self.fixed.is_empty() && self.bounds.is_empty()
    }

    /// This, with what it leaves open taken from `other`.
    #[must_use]
    pub fn or(&self, other: &Self) -> Self {
        let mut all = self.clone();
        for (address, value) in &other.fixed {
            if !self.bounds.contains_key(address) {
                all.fixed.entry(address.clone()).or_insert(*value);
            }
        }
        for (address, bounds) in &other.bounds {
            if !self.fixed.contains_key(address) {
                all.bounds.entry(address.clone()).or_insert(*bounds);
            }
        }
        all
    }

    /// Takes what is fixed out of the parameters that are fitted, and sets the bounds of others.
    pub(crate) fn apply(&self, terms: &mut [Term]) -> Result<(), KnownError> {
        for (address, value) in &self.fixed {
            let (term, k) = place(terms, address)?;
            check(&terms[term].parameters[k], address, *value)?;
        }
        for (address, (low, high)) in &self.bounds {
            if low.partial_cmp(high) != Some(std::cmp::Ordering::Less) {
                let (address, low, high) = (address.clone(), *low, *high);
                return Err(KnownError::Bounds { address, low, high });
            }
            let (term, k) = place(terms, address)?;
            let parameter = &mut terms[term].parameters[k];
            check(parameter, address, *high)?;
            let least = if parameter.scale == aep_core::Scale::Log && *low <= 0.0 {
                parameter.lower.min(0.5 * high)
            } else {
                check(parameter, address, *low)?;
                *low
            };
            (parameter.lower, parameter.upper) = (least, *high);
            let start = parameter.start;
            if !(least..=*high).contains(&start) {
                parameter.start = 0.5 * (least + high);
            }
        }
        for term in terms {
            let name = term.name.clone();
            term.parameters.retain(|parameter| !self.fixed.contains_key(&key(&name, parameter)));
        }
        Ok(())
    }
}

fn key(term: &str, parameter: &TermParameter) -> String {
    if term == parameter.name { term.to_owned() } else { format!("{term}.{}", parameter.name) }
}

fn place(terms: &[Term], address: &str) -> Result<(usize, usize), KnownError> {
    let all = terms.iter().enumerate().flat_map(|(t, term)| {
        term.parameters.iter().enumerate().map(move |(k, p)| (t, k, key(&term.name, p)))
    });
    let all: Vec<(usize, usize, String)> = all.collect();
    if let Some((term, k, _)) = all.iter().find(|(.., key)| key == address) {
        return Ok((*term, *k));
    }
    let likeness = |key: &str| strsim::jaro_winkler(address, key);
    let best = all.iter().map(|(.., key)| key).max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let hint = best.filter(|key| likeness(key) > NEAR).cloned();
    Err(KnownError::Unknown { address: address.to_owned(), hint })
}

fn check(parameter: &TermParameter, address: &str, value: f64) -> Result<(), KnownError> {
    let need = if !value.is_finite() {
        "it must be finite"
    } else if (parameter.scale == aep_core::Scale::Log || parameter.lower > 0.0) && value <= 0.0 {
        "it must be above 0"
    } else if parameter.lower >= 0.0 && value < 0.0 {
        "it cannot be negative"
    } else {
        return Ok(());
    };
    Err(KnownError::Value { address: address.to_owned(), value, need: need.to_owned() })
}

#[cfg(test)]
mod tests {
    use aep_core::Scale;
    use missing_physics::Role;

    use super::*;

    fn terms() -> Vec<Term> {
        let parameter = |name: &str, lower: f64, scale| TermParameter {
            name: name.into(),
            unit: "1".into(),
            role: Role::Amplitude,
            lower,
            upper: 10.0,
            scale,
            start: 1.0,
        };
        let term = |name: &str, parameters| Term {
            name: name.into(),
            title: String::new(),
            equation: String::new(),
            parameters,
            always: false,
        };
        vec![
            term("mass", vec![parameter("mass", 1e-6, Scale::Linear)]),
            term(
                "stribeck",
                vec![parameter("dF", 0.0, Scale::Linear), parameter("v_s", 1e-3, Scale::Log)],
            ),
        ]
    }

    fn known(fixed: &[(&str, f64)], bounds: &[(&str, (f64, f64))]) -> Known {
        let named = |(name, value): &(&str, f64)| ((*name).to_owned(), *value);
        let within = |(name, value): &(&str, (f64, f64))| ((*name).to_owned(), *value);
        Known {
            fixed: fixed.iter().map(named).collect(),
            bounds: bounds.iter().map(within).collect(),
        }
    }

    #[test]
    fn what_is_fixed_is_no_longer_fitted_and_bounds_hold() {
        let mut all = terms();
        known(&[("mass", 95.1)], &[("stribeck.v_s", (0.0, 0.02)), ("stribeck.dF", (2.0, 3.0))])
            .apply(&mut all)
            .unwrap();
        assert!(all[0].parameters.is_empty());
        let [height, speed] = all[1].parameters.as_slice() else { panic!("two are left") };
        assert_eq!((height.lower, height.upper, height.start), (2.0, 3.0, 2.5));
        assert!(speed.lower > 0.0 && speed.upper == 0.02 && speed.start <= 0.02);
    }

    #[test]
    fn what_cannot_be_is_said() {
        let said = |known: Known| known.apply(&mut terms()).unwrap_err().to_string();
        assert!(said(known(&[("masss", 1.0)], &[])).contains("did you mean 'mass'"));
        assert!(said(known(&[("mass", -1.0)], &[])).contains("above 0"));
        assert!(said(known(&[("stribeck.dF", -1.0)], &[])).contains("negative"));
        assert!(said(known(&[("stribeck.v_s", 0.0)], &[])).contains("above 0"));
        assert!(said(known(&[("mass", f64::NAN)], &[])).contains("finite"));
        assert!(said(known(&[], &[("mass", (3.0, 2.0))])).contains("below the second"));
    }

    #[test]
    fn flags_come_before_the_model_file() {
        let flags = known(&[("mass", 2.0)], &[]);
        let file = known(&[("mass", 3.0), ("stribeck.dF", 1.0)], &[]);
        assert_eq!(flags.or(&file), known(&[("mass", 2.0), ("stribeck.dF", 1.0)], &[]));
        let flags = known(&[], &[("mass", (1.0, 2.0))]);
        assert_eq!(flags.or(&file).fixed.len(), 1);
    }
}
