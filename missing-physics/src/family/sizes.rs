//! The values of a term as numbers with names and units.

use super::term::{Role, Term, TermParameter};
use crate::report::{DetectionLimit, NamedValue};

/// The values of all parameters of a term.
pub fn sizes(term: &Term, values: &[f64]) -> Vec<NamedValue> {
    term.parameters.iter().zip(values).map(|(parameter, value)| named(parameter, *value)).collect()
}

/// The limit of detection of a term at the shapes among `values`: `size` of its first amplitude.
pub fn detection_limit(
    term: &Term,
    values: &[f64],
    amplitude: &TermParameter,
    size: f64,
) -> DetectionLimit {
    let shapes = term.parameters.iter().zip(values).filter(|(p, _)| p.role == Role::Shape);
    DetectionLimit {
        parameter: amplitude.name.clone(),
        unit: amplitude.unit.clone(),
        size: Some(size).filter(|size| *size <= amplitude.upper),
        at: shapes.map(|(parameter, value)| named(parameter, *value)).collect(),
    }
}

fn named(parameter: &TermParameter, value: f64) -> NamedValue {
    NamedValue { name: parameter.name.clone(), value, unit: parameter.unit.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use aep_core::Scale;

    fn term() -> Term {
        let parameter = |name: &str, unit: &str, role| TermParameter {
            name: name.into(),
            unit: unit.into(),
            role,
            lower: 0.0,
            upper: 10.0,
            scale: Scale::Linear,
            start: 1.0,
        };
        Term {
            name: "hump".into(),
            title: String::new(),
            equation: String::new(),
            parameters: vec![
                parameter("dF", "N", Role::Amplitude),
                parameter("v", "m/s", Role::Shape),
            ],
            always: false,
        }
    }

    #[test]
    fn a_limit_is_told_with_its_shapes_and_only_within_the_bounds_of_the_amplitude() {
        let term = term();
        let limit = |size| detection_limit(&term, &[3.0, 0.02], &term.parameters[0], size);
        let speed = NamedValue { name: "v".into(), value: 0.02, unit: "m/s".into() };
        assert_eq!(limit(4.0).size, Some(4.0));
        assert_eq!(limit(4.0).at, [speed]);
        assert_eq!((limit(10.5).size, limit(f64::NAN).size), (None, None));
        assert_eq!(sizes(&term, &[3.0, 0.02]).len(), 2);
    }
}
