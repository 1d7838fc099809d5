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
//! `force` is a force that resists the motion; `level` in its place adds to the friction level. A formula may use `x`
//! (position), `v` (velocity), `a` (acceleration), `s` (sign of the velocity), `t` (time), `F` (force of the drive), the
//! parameters, `pi`, and any other name: a column of the recording. Parameters come first, so that one may be called `a`.
//! Its language is that of [`aep_formula`]. Parameters with `linear = true` are amplitudes: the law is proportional to them.

use std::collections::BTreeMap;

use missing_physics::Recording;
use serde::Deserialize;

use super::{
    About, Effect, Extent, Motion, Parameter, ParameterRole, Parameters, Scale, Signal, Slot,
    Smooth, UnknownEffect,
};
use crate::axis::{Axis, Effort, Quantity};

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
    #[error("the law of '{effect}': {reason}")]
    Syntax {
        /// The effect.
        effect: String,
        /// What is wrong, and where.
        reason: aep_formula::FormulaError,
    },
    /// More parameters than a search can tell apart.
    #[error(
        "effect '{effect}' has {count} parameters\nat most {MOST_PARAMETERS} can be searched: fix some as numbers in the law"
    )]
    Parameters {
        /// The effect.
        effect: String,
        /// How many.
        count: usize,
    },
    /// A name that another effect has.
    #[error(
        "'{0}' is the name of an effect of the library\ncall yours by another name, e.g. my-{0}"
    )]
    Taken(String),
    /// A name that a law and a regressor of the user share.
    #[error(
        "'{0}' is both a regressor and an effect of your own\ncall one of them by another name"
    )]
    Twice(String),
    /// A name that cannot stand in a list of effects.
    #[error(
        "'{0}' is no name of an effect\nuse lower-case letters, digits, - and _, and begin with a letter"
    )]
    BadName(String),
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
    /// What of a recording it is; it is not fitted then.
    from: Option<Extent>,
}

/// What formulas of the user name as their source.
pub const REFERENCE: &str = "a formula of the user";
/// Most parameters of an effect.
pub const MOST_PARAMETERS: usize = 16;
/// Prefix of the channels of a recording that hold columns for formulas.
pub const COLUMN: &str = "column ";

/// Where a name of the formula gets its value.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Source {
    Position,
    Velocity,
    Acceleration,
    Sign,
    Time,
    Drive,
    Number(f64),
    Parameter(usize),
    Column(usize),
}

/// See the module.
#[derive(Clone)]
pub struct Formula {
    about: &'static About,
    law: aep_formula::Formula,
    sources: Vec<Source>,
    /// Names of the columns that it reads.
    columns: Vec<String>,
    /// Their values; empty until a recording is known.
    signals: Vec<Signal>,
}

/// Reads an effect. It stays in memory for the rest of the program: models refer to effects for as
/// long as they like.
///
/// # Errors
/// [`FormulaError`], with what to change.
pub fn read(text: &str) -> Result<&'static dyn Effect, FormulaError> {
    let file: File = toml::from_str(text).map_err(|error| FormulaError::File(error.to_string()))?;
    check_name(&file.name)?;
    let (text, slot) = match (&file.force, &file.level) {
        (Some(force), None) => (force, Slot::SmoothForce),
        (None, Some(level)) => (level, Slot::FrictionLevel),
        _ => return Err(FormulaError::Law(file.name)),
    };
    let count = file.parameters.len();
    if count > MOST_PARAMETERS {
        return Err(FormulaError::Parameters { effect: file.name, count });
    }
    let law = aep_formula::Formula::parse(text)
        .map_err(|reason| FormulaError::Syntax { effect: file.name.clone(), reason })?;
    let mut columns = Vec::new();
    let sources = law.names().iter().map(|name| source(name, &file, &mut columns)).collect();
    let parameters = file.parameters.iter().map(|(name, p)| parameter(name, p));
    let parameters: Vec<Parameter> = parameters.collect::<Result<_, _>>()?;
    let about = About {
        name: keep(&file.name),
        title: keep(if file.title.is_empty() { &file.name } else { &file.title }),
        equation: keep(text),
        parameters: Vec::leak(parameters),
        slots: Vec::leak(vec![slot]),
        shows: keep(&file.shows),
        reference: REFERENCE,
    };
    let about = Box::leak(Box::new(about));
    let formula = Formula { about, law, sources, columns, signals: Vec::new() };
    formula.check_amplitudes()?;
    Ok(Box::leak(Box::new(formula)))
}

/// Whether an effect of the user's may be called so.
///
/// # Errors
/// The library has an effect of that name, or it cannot stand in a list.
pub fn check_name(name: &str) -> Result<(), FormulaError> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-' || c == '_';
    let named = name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(plain);
    if !named {
        return Err(FormulaError::BadName(name.to_owned()));
    }
    let found: Result<_, UnknownEffect> = super::find(name);
    if found.is_ok() || ["mass", "timing", "none"].contains(&name) {
        return Err(FormulaError::Taken(name.to_owned()));
    }
    Ok(())
}

fn keep(text: &str) -> &'static str {
    String::leak(text.to_owned())
}

fn source(name: &str, file: &File, columns: &mut Vec<String>) -> Source {
    if let Some(index) = file.parameters.keys().position(|parameter| parameter == name) {
        return Source::Parameter(index);
    }
    match name {
        "x" => Source::Position,
        "v" => Source::Velocity,
        "a" => Source::Acceleration,
        "s" => Source::Sign,
        "t" => Source::Time,
        "F" => Source::Drive,
        _ => aep_formula::constant(name).map_or_else(
            || {
                columns.push(name.to_owned());
                Source::Column(columns.len() - 1)
            },
            Source::Number,
        ),
    }
}

fn parameter(name: &str, p: &FileParameter) -> Result<Parameter, FormulaError> {
    let wrong = |reason: String| FormulaError::Parameter { name: name.to_owned(), reason };
    let within = p.low < p.high && (p.low..=p.high).contains(&p.default);
    if !(within && p.low.is_finite() && p.high.is_finite()) {
        return Err(wrong("low < high, and default between them, all finite".into()));
    }
    if p.linear && p.from.is_some() {
        let what = "it is either taken from the recording or linear: leave out linear or from";
        return Err(wrong(what.into()));
    }
    let quantity = quantity(&p.unit).ok_or_else(|| {
        let known: Vec<&str> = units().into_iter().map(|(unit, _)| unit).collect();
        wrong(format!("unknown unit '{}'; one of: {}", p.unit, known.join(", ")))
    })?;
    Ok(Parameter {
        name: keep(name),
        meaning: keep(&p.meaning),
        quantity,
        role: match p.from {
            Some(_) => ParameterRole::Fixed,
            None if p.linear => ParameterRole::Amplitude,
            None => ParameterRole::Shape,
        },
        low: p.low,
        high: p.high,
        scale: if p.linear || p.low <= 0.0 { Scale::Linear } else { Scale::Log },
        default: p.default,
        extent: p.from,
    })
}

const QUANTITIES: [Quantity; 12] = [
    Quantity::One,
    Quantity::Force,
    Quantity::Length,
    Quantity::Velocity,
    Quantity::Time,
    Quantity::Frequency,
    Quantity::Mass,
    Quantity::Damping,
    Quantity::Drag,
    Quantity::Stiffness,
    Quantity::PerForce,
    Quantity::Temperature,
];

/// Every unit that a parameter may have: of either kind of axis, with a force, a voltage or a current for an effort.
fn units() -> Vec<(&'static str, Quantity)> {
    let mut units: Vec<(&str, Quantity)> = Vec::new();
    for effort in [Effort::Si, Effort::Volt, Effort::Ampere] {
        for quantity in QUANTITIES {
            for unit in [Axis::Linear, Axis::Rotary].map(|axis| effort.unit(axis, quantity)) {
                if units.iter().all(|(known, _)| *known != unit) {
                    units.push((unit, quantity));
                }
            }
        }
    }
    units
}

fn quantity(unit: &str) -> Option<Quantity> {
    units().into_iter().find(|(name, _)| *name == unit).map(|(_, quantity)| quantity)
}

impl Formula {
    /// The law where the variables are `[x, v, a, s, t, F]`; `columns` are the values of those that it reads.
    fn evaluate(&self, p: &[f64], at: [f64; 6], columns: &[f64], work: &mut Work) -> f64 {
        work.values.clear();
        work.values.extend(self.sources.iter().map(|source| match *source {
            Source::Position => at[0],
            Source::Velocity => at[1],
            Source::Acceleration => at[2],
            Source::Sign => at[3],
            Source::Time => at[4],
            Source::Drive => at[5],
            Source::Number(number) => number,
            Source::Parameter(k) => p[k],
            Source::Column(k) => columns.get(k).copied().unwrap_or(0.0),
        }));
        self.law.value_on(&work.values, &mut work.stack)
    }

    /// The law must be proportional to what it calls linear, all of that together.
    fn check_amplitudes(&self) -> Result<(), FormulaError> {
        let table = self.about.parameters;
        let at = [0.0123, 0.0456, 0.321, 1.0, 0.789, 12.3];
        let columns = vec![0.654; self.columns.len()];
        let scaled = |by: f64| -> f64 {
            let p: Vec<f64> = table
                .iter()
                .map(|p| {
                    if p.role == ParameterRole::Amplitude {
                        by * (p.default + 0.1)
                    } else {
                        p.default
                    }
                })
                .collect();
            self.evaluate(&p, at, &columns, &mut Work::default())
        };
        let (once, twice) = (scaled(1.0), scaled(2.0));
        match table.iter().find(|p| p.role == ParameterRole::Amplitude) {
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
        let (mut work, mut near) = (Work::default(), vec![0; self.signals.len()]);
        let mut columns = vec![0.0; self.signals.len()];
        for (i, out) in out.iter_mut().enumerate() {
            values.iter_mut().enumerate().for_each(|(k, value)| *value = p.get(k)[i]);
            for ((column, signal), near) in columns.iter_mut().zip(&self.signals).zip(&mut near) {
                *column = signal.at(m.time[i], near);
            }
            let at = [
                m.position[i],
                m.velocity[i],
                m.acceleration[i],
                m.direction[i],
                m.time[i],
                m.drive_force[i],
            ];
            *out += self.evaluate(&values, at, &columns, &mut work);
        }
    }
}

/// Room for the evaluation of a law.
#[derive(Default)]
struct Work {
    values: Vec<f64>,
    stack: Vec<f64>,
}

impl Effect for Formula {
    fn about(&self) -> &'static About {
        self.about
    }

    fn columns(&self) -> &[String] {
        &self.columns
    }

    fn is_bound(&self) -> bool {
        self.signals.len() == self.columns.len()
    }

    fn bound(&self, recording: &Recording) -> Option<&'static dyn Effect> {
        if self.columns.is_empty() {
            return None;
        }
        let signal = |name: &String| Signal::of(recording, &format!("{COLUMN}{name}"));
        let signals = self.columns.iter().map(signal).collect::<Option<Vec<_>>>()?;
        Some(Box::leak(Box::new(Self { signals, ..self.clone() })))
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
    fn a_parameter_may_come_from_the_recording_and_is_not_linear_then() {
        let file = |more: &str| {
            format!(
                "name = \"bump\"\nforce = \"a*exp(-(((x - x_m)/0.01)^2))\"\n[parameters]\n\
                 a = {{ unit = \"N\", low = -9.0, high = 9.0, default = 1.0, linear = true }}\n\
                 x_m = {{ unit = \"m\", low = -1.0, high = 1.0, default = 0.1{more} }}\n"
            )
        };
        let middle = |more: &str| {
            let about = read(&file(more)).unwrap().about();
            let k = about.parameter("x_m").unwrap();
            (about.parameters[k].role, about.parameters[k].extent)
        };
        let taken = middle(", from = \"stroke-middle\"");
        assert_eq!(taken, (ParameterRole::Fixed, Some(Extent::StrokeMiddle)));
        assert_eq!(middle(""), (ParameterRole::Shape, None));
        let both = file(", from = \"stroke-middle\", linear = true");
        assert!(refused(&both).contains("leave out linear or from"), "{}", refused(&both));
        assert!(refused(&file(", from = \"stroke\"")).contains("stroke-begin"));
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
    fn other_names_are_columns_of_the_recording() {
        let effect = read(&COGGING.replace("x / p", "x / p + q*v")).unwrap();
        assert_eq!(effect.columns(), ["q"]);
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let values = time.iter().map(|t| 0.5 * t).collect();
        let channel = missing_physics::Channel::new("column q", "", values);
        let recording = Recording::new("run", time.clone(), vec![channel]).unwrap();
        let bound = effect.bound(&recording).unwrap();
        let point = Point { time: 3.0, ..Point::at(0.003, 0.1) };
        let law = 3.0 * (std::f64::consts::TAU * 0.003 / 0.012 + 1.5 * 0.1).sin();
        assert!((smooth(bound, &[3.0, 0.012], point).0 - law).abs() < 1e-12);
        let without = Recording::new("run", time, vec![]).unwrap();
        assert!(effect.bound(&without).is_none());
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert!(refused(&COGGING.replace("sin(2", "sin((2")).contains("not closed"));
        assert!(refused(&COGGING.replace("sin(2", "sine(2")).contains("no function 'sine'"));
        assert!(refused(&COGGING.replace("cogging", "stribeck")).contains("of the library"));
        assert!(refused(&COGGING.replace("cogging", "stribeck:free")).contains("no name"));
        assert!(refused(&COGGING.replace("cogging", "My Effect")).contains("no name"));
        let one =
            |k: i32| format!("b{k} = {{ unit = \"1\", low = 0.0, high = 1.0, default = 0.5 }}");
        let many = (0..17).map(one).collect::<Vec<String>>().join("\n");
        assert!(refused(&(COGGING.to_owned() + &many)).contains("19 parameters"));
        assert!(
            refused(&COGGING.replace("\"m\"", "\"furlong\"")).contains("unknown unit 'furlong'")
        );
        assert!(refused(&COGGING.replace("force", "farce")).contains("farce"));
        assert!(refused(&COGGING.replace("a * sin", "a * a * sin")).contains("not proportional"));
        assert!(refused(&COGGING.replace("low = 1e-3", "low = 1.0")).contains("low < high"));
        assert!(refused("name = \"a\"\n[parameters]").contains("needs one law"));
    }
}
