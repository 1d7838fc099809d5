//! A recording and models of it that tests have in common.

use missing_physics::{Channel, Fitted, Recording, TermParameter};

use super::{FrictionFamily, Options};

/// A mass of 20 kg on a sine with counts of 1 um, 20 N (rms) at 1 ms.
pub(super) fn recording() -> Recording {
    moved("N", "m")
}

/// The same of an axis with these units.
pub(super) fn moved(force_unit: &str, position_unit: &str) -> Recording {
    let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
    let (w, size) = (2.0 * std::f64::consts::PI, 0.0358);
    let position = time.iter().map(|t| (size * (w * t).sin() / 1e-6).round() * 1e-6);
    let force = time.iter().map(|t| -20.0 * size * w * w * (w * t).sin());
    let channel = |name: &str, unit: &str, values: Vec<f64>| Channel::new(name, unit, values);
    let channels = vec![
        channel("force", force_unit, force.collect()),
        channel("position", position_unit, position.collect()),
    ];
    Recording::new("sine", time.clone(), channels).unwrap()
}

pub(super) fn family() -> FrictionFamily {
    of_axis("N", "m")
}

pub(super) fn of_axis(force_unit: &str, position_unit: &str) -> FrictionFamily {
    FrictionFamily::new(&moved(force_unit, position_unit), &Options::default()).unwrap()
}

/// A model of so many terms, those with `values` in the place of where they begin.
pub(super) fn model(family: &FrictionFamily, terms: &[&str], values: &[(&str, f64)]) -> Fitted {
    let place = |name: &str| family.terms.iter().position(|term| term.name == name).unwrap();
    let begin = Fitted { terms: Vec::new(), values: Vec::new() };
    terms.iter().map(|name| place(name)).fold(begin, |model, term| {
        let parameters = family.terms[term].parameters.iter();
        let value = |p: &TermParameter| {
            values.iter().find(|(name, _)| *name == p.name).map_or(p.start, |(_, value)| *value)
        };
        model.with(term, &parameters.map(value).collect::<Vec<f64>>())
    })
}
