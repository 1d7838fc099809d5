//! An effect of one's own as one line of text, in a TOML file.
//!
//! ```toml
//! name = "cogging"
//! force = "a * sin(2 * pi * x / p)"
//!
//! [parameters]
//! a = { unit = "N", low = -20.0, high = 20.0, default = 1.0, linear = true }
//! p = { unit = "m", low = 1e-3, high = 0.1, default = 0.012 }
//! ```
//!
//! `force` is a force that resists the motion; `level` in its place adds to the friction level. A
//! formula may use `x` (position), `v` (velocity), `s` (sign of the velocity), `t` (time), `F` (force
//! of the drive), `pi` and the parameters. Parameters with `linear = true` are amplitudes: the law is
//! proportional to them. A minus sign binds tighter than a power: write `exp(-1*x^2)`, for `exp(-x^2)` is
//! `exp((-x)^2)`.

use std::collections::BTreeMap;

use exmex::{Express, FlatEx};
use serde::Deserialize;

use super::{About, Effect, Motion, Parameter, Parameters, Role, Scale, Slot, Smooth};
use crate::axis::Quantity;

/// Why a text is no effect.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FormulaError {
    /// Not TOML of the form in the module's documentation.
    #[error("not an effect: {0}\nan effect needs name, force (or level) and [parameters]")]
    File(String),
    /// Both or neither of `force` and `level`.
    #[error("effect '{0}' needs one law: force = \"...\" or level = \"...\"")]
    Law(String),
    /// The formula cannot be read.
    #[error("the law '{law}' cannot be read: {reason}")]
    Syntax {
        /// The law.
        law: String,
        /// What the parser says.
        reason: String,
    },
    /// A name that is neither a variable nor a parameter.
    #[error(
        "the law '{law}' uses '{name}', which is no parameter\nvariables: x, v, s, t, F, pi; add [parameters] {name} = {{ unit = .., low = .., high = .., default = .. }}"
    )]
    Name {
        /// The law.
        law: String,
        /// The unknown name.
        name: String,
    },
    /// A parameter that cannot be searched.
    #[error("parameter '{name}': {reason}")]
    Parameter {
        /// The parameter.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: String,
    #[serde(default)]
    title: String,
    force: Option<String>,
    level: Option<String>,
    #[serde(default)]
    shows: String,
    parameters: BTreeMap<String, FileParameter>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileParameter {
    unit: String,
    low: f64,
    high: f64,
    default: f64,
    #[serde(default)]
    linear: bool,
    #[serde(default)]
    meaning: String,
}

/// Where a name of the formula gets its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    Position,
    Velocity,
    Sign,
    Time,
    Drive,
    Pi,
    Parameter(usize),
}

/// See the module.
pub struct Formula {
    about: &'static About,
    law: FlatEx<f64>,
    sources: Vec<Source>,
}

/// Reads an effect. It stays in memory for the rest of the program: models refer to effects for as
/// long as they like.
///
/// # Errors
/// [`FormulaError`], with what to change.
pub fn read(text: &str) -> Result<&'static dyn Effect, FormulaError> {
    let file: File = toml::from_str(text).map_err(|error| FormulaError::File(error.to_string()))?;
    let (text, slot) = match (&file.force, &file.level) {
        (Some(force), None) => (force, Slot::SmoothForce),
        (None, Some(level)) => (level, Slot::FrictionLevel),
        _ => return Err(FormulaError::Law(file.name)),
    };
    let law = exmex::parse::<f64>(text)
        .map_err(|error| FormulaError::Syntax { law: text.clone(), reason: error.to_string() })?;
    let sources = law.var_names().iter().map(|name| source(name, text, &file));
    let sources = sources.collect::<Result<Vec<_>, _>>()?;
    let parameters = file.parameters.iter().map(|(name, p)| parameter(name, p));
    let parameters: Vec<Parameter> = parameters.collect::<Result<_, _>>()?;
    let about = About {
        name: keep(&file.name),
        title: keep(if file.title.is_empty() { &file.name } else { &file.title }),
        equation: keep(text),
        parameters: Vec::leak(parameters),
        slots: Vec::leak(vec![slot]),
        shows: keep(&file.shows),
        reference: "a formula of the user",
    };
    let formula = Formula { about: Box::leak(Box::new(about)), law, sources };
    formula.check_amplitudes()?;
    Ok(Box::leak(Box::new(formula)))
}

fn keep(text: &str) -> &'static str {
    String::leak(text.to_owned())
}

fn source(name: &str, law: &str, file: &File) -> Result<Source, FormulaError> {
    if let Some(index) = file.parameters.keys().position(|parameter| parameter == name) {
        return Ok(Source::Parameter(index));
    }
    match name {
        "x" => Ok(Source::Position),
        "v" => Ok(Source::Velocity),
        "s" => Ok(Source::Sign),
        "t" => Ok(Source::Time),
        "F" => Ok(Source::Drive),
        "pi" => Ok(Source::Pi),
        _ => Err(FormulaError::Name { law: law.to_owned(), name: name.to_owned() }),
    }
}

fn parameter(name: &str, p: &FileParameter) -> Result<Parameter, FormulaError> {
    let wrong = |reason: String| FormulaError::Parameter { name: name.to_owned(), reason };
    let within = p.low < p.high && (p.low..=p.high).contains(&p.default);
    if !(within && p.low.is_finite() && p.high.is_finite()) {
        return Err(wrong("low < high, and default between them, all finite".into()));
    }
    let quantity = quantity(&p.unit).ok_or_else(|| {
        wrong(format!("unknown unit '{}'; one of: {}", p.unit, UNITS.map(|(u, _)| u).join(", ")))
    })?;
    Ok(Parameter {
        name: keep(name),
        meaning: keep(&p.meaning),
        quantity,
        role: if p.linear { Role::Amplitude } else { Role::Shape },
        low: p.low,
        high: p.high,
        scale: if p.linear || p.low <= 0.0 { Scale::Linear } else { Scale::Log },
        default: p.default,
    })
}

const UNITS: [(&str, Quantity); 17] = [
    ("1", Quantity::One),
    ("N", Quantity::Force),
    ("N m", Quantity::Force),
    ("m", Quantity::Length),
    ("rad", Quantity::Length),
    ("m/s", Quantity::Velocity),
    ("rad/s", Quantity::Velocity),
    ("s", Quantity::Time),
    ("Hz", Quantity::Frequency),
    ("kg", Quantity::Mass),
    ("kg m^2", Quantity::Mass),
    ("N s/m", Quantity::Damping),
    ("N m s/rad", Quantity::Damping),
    ("N s^2/m^2", Quantity::Drag),
    ("N/m", Quantity::Stiffness),
    ("N m/rad", Quantity::Stiffness),
    ("K", Quantity::Temperature),
];

fn quantity(unit: &str) -> Option<Quantity> {
    UNITS.iter().find(|(name, _)| *name == unit).map(|(_, quantity)| *quantity)
}

impl Formula {
    /// The law where the variables are `[x, v, s, t, F]`.
    fn evaluate(&self, p: &[f64], at: [f64; 5]) -> f64 {
        let value = |source: &Source| match *source {
            Source::Position => at[0],
            Source::Velocity => at[1],
            Source::Sign => at[2],
            Source::Time => at[3],
            Source::Drive => at[4],
            Source::Pi => std::f64::consts::PI,
            Source::Parameter(k) => p[k],
        };
        let values: Vec<f64> = self.sources.iter().map(value).collect();
        self.law.eval(&values).unwrap_or(f64::NAN)
    }

    /// The law must be proportional to what it calls linear, all of that together.
    fn check_amplitudes(&self) -> Result<(), FormulaError> {
        let table = self.about.parameters;
        let at = [0.0123, 0.0456, 1.0, 0.789, 12.3];
        let scaled = |by: f64| -> f64 {
            let p: Vec<f64> = table
                .iter()
                .map(|p| if p.role == Role::Amplitude { by * (p.default + 0.1) } else { p.default })
                .collect();
            self.evaluate(&p, at)
        };
        let (once, twice) = (scaled(1.0), scaled(2.0));
        match table.iter().find(|p| p.role == Role::Amplitude) {
            Some(p) if (twice - 2.0 * once).abs() > 1e-9 * once.abs() => {
                Err(FormulaError::Parameter {
                    name: p.name.to_owned(),
                    reason: "the law is not proportional to its linear parameters; leave out linear = true".into(),
                })
            }
            _ => Ok(()),
        }
    }

    fn add(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut [f64]) {
        let mut values = vec![0.0; self.about.parameters.len()];
        for (i, out) in out.iter_mut().enumerate() {
            values.iter_mut().enumerate().for_each(|(k, value)| *value = p.get(k)[i]);
            let at = [m.position[i], m.velocity[i], m.direction[i], m.time[i], m.drive_force[i]];
            *out += self.evaluate(&values, at);
        }
    }
}

impl Effect for Formula {
    fn about(&self) -> &'static About {
        self.about
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        if self.about.acts_on(Slot::SmoothForce) {
            self.add(p, m, out.force);
        }
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        if self.about.acts_on(Slot::FrictionLevel) {
            self.add(p, m, level);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level, smooth};
    use super::*;
    use crate::effects::Library;
    use crate::model::Model;

    const COGGING: &str = r#"
        name = "cogging"
        force = "a * sin(2 * pi * x / p)"
        [parameters]
        a = { unit = "N", low = -20.0, high = 20.0, default = 1.0, linear = true }
        p = { unit = "m", low = 1e-3, high = 0.1, default = 0.012 }
    "#;

    fn refused(text: &str) -> String {
        read(text).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn a_line_of_text_is_an_effect_like_any_other() {
        let effect = read(COGGING).unwrap();
        assert!((smooth(effect, &[3.0, 0.012], Point::at(0.003, 0.1)).0 - 3.0).abs() < 1e-12);
        let library = Library::builtin().with(effect);
        let text = r#"{"axis":"linear","mass":2.0,"effects":[{"effect":"cogging","parameters":{"a":1.5,"p":0.02}}]}"#;
        let model = Model::from_json(text, &library).unwrap();
        assert_eq!(model.get("cogging.a").unwrap(), 1.5);
        assert_eq!(model.unit("cogging.p").unwrap(), "m");
    }

    #[test]
    fn a_level_follows_direction_and_load() {
        let effect = read(
            r#"
            name = "worn-side"
            level = "mu * abs(F) * (1 - s) / 2"
            [parameters]
            mu = { unit = "1", low = 0.0, high = 0.5, default = 0.1, linear = true }
            "#,
        )
        .unwrap();
        let point = |v| Point { drive_force: -40.0, ..Point::at(0.0, v) };
        assert_eq!(level(effect, &[0.1], point(-0.1)), 4.0);
        assert_eq!(level(effect, &[0.1], point(0.1)), 0.0);
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert!(refused(&COGGING.replace("x / p", "x / q")).contains("uses 'q'"));
        assert!(refused(&COGGING.replace("sin(2", "sin((2")).contains("cannot be read"));
        assert!(
            refused(&COGGING.replace("\"m\"", "\"furlong\"")).contains("unknown unit 'furlong'")
        );
        assert!(refused(&COGGING.replace("force", "farce")).contains("farce"));
        assert!(refused(&COGGING.replace("a * sin", "a * a * sin")).contains("not proportional"));
        assert!(refused(&COGGING.replace("low = 1e-3", "low = 1.0")).contains("low < high"));
        assert!(refused("name = \"a\"\n[parameters]").contains("needs one law"));
    }
}
