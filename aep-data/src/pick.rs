//! Which column or product a quantity is read from, and in which unit.

use std::path::Path;

use crate::error::{DataError, Problem};
use crate::header::{Header, recognise, unit_unknown};
use crate::mapping::Source;
use crate::role::Role;
use crate::table::{Column, Table};
use crate::unit::{self, Quantity, Unit};

/// One factor of a product.
#[derive(Clone, Debug, PartialEq)]
enum Factor {
    Column(String),
    Number(f64),
}

/// The unit of a quantity, as far as the file says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Said {
    /// The name or the mapping gives the unit.
    Unit(&'static Unit),
    /// Only the word, such as `torque`, says that it is rotary, in SI.
    Rotary,
    /// Nothing says it: SI.
    Nothing,
}

/// Where a quantity comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pick {
    pub role: Role,
    /// Column or product, as it stands in the file.
    pub expression: String,
    factors: Vec<Factor>,
    pub said: Said,
    pub gain: f64,
}

impl Pick {
    /// Finds the source of `role` in `table`; nothing where it is not there and nobody asked for it.
    pub fn find(
        role: Role,
        source: &Source,
        table: &dyn Table,
        path: &Path,
    ) -> Result<Option<Self>, DataError> {
        let names = table.names();
        let expression = match &source.column {
            Some(expression) => expression.trim().to_owned(),
            None => match recognise(role, &names) {
                Some(name) => name.clone(),
                None => return no_column(role, source, table, path).map(|()| None),
            },
        };
        let gain = checked_gain(role, source).map_err(|problem| DataError::new(path, problem))?;
        let factors = factors(role, &expression, table).map_err(|p| DataError::new(path, p))?;
        let said = said(role, source, &factors)
            .map_err(|problem| DataError::new(path, problem).in_column(&expression))?;
        Ok(Some(Self { role, expression, factors, said, gain }))
    }

    /// Whether it belongs to a rotary axis, where that is known.
    pub fn is_rotary(&self) -> Option<bool> {
        let facts = self.role.facts();
        match self.said {
            _ if facts.linear == facts.rotary => None,
            Said::Unit(unit) => Some(unit.quantity == facts.rotary),
            Said::Rotary => Some(true),
            Said::Nothing => None,
        }
    }

    /// The columns it is made of.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.factors.iter().filter_map(|factor| match factor {
            Factor::Column(name) => Some(name.as_str()),
            Factor::Number(_) => None,
        })
    }

    /// Its values in SI; one value where all factors are single.
    pub fn values(&self, table: &dyn Table, path: &Path) -> Result<Vec<f64>, DataError> {
        let mut product = vec![1.0];
        for factor in &self.factors {
            match factor {
                Factor::Number(number) => product.iter_mut().for_each(|value| *value *= number),
                Factor::Column(name) => {
                    let column = checked(table.column(name)?, table, path)?;
                    product = multiplied(product, column, path)?;
                }
            }
        }
        let (factor, shift) = match self.said {
            Said::Unit(unit) => (unit.factor * self.gain, unit.shift),
            _ => (self.gain, 0.0),
        };
        Ok(product.into_iter().map(|value| value * factor + shift).collect())
    }
}

fn no_column(role: Role, source: &Source, table: &dyn Table, path: &Path) -> Result<(), DataError> {
    if !role.is_required() && source.gain.is_none() && source.unit.is_none() {
        return Ok(());
    }
    let name = role.facts().name;
    let names = table.names();
    let Some((column, unit)) = unit_unknown(role, &names) else {
        return Err(DataError::new(path, table.missing(name, None)));
    };
    Err(DataError::new(path, unknown_unit(role, unit)).in_column(column))
}

fn checked_gain(role: Role, source: &Source) -> Result<f64, Problem> {
    let gain = source.gain.unwrap_or(1.0);
    if gain.is_finite() && gain != 0.0 {
        return Ok(gain);
    }
    let what = format!("the gain of the {}", role.facts().name);
    Err(Problem::BadNumber { what, value: gain, must: "finite and not zero" })
}

fn factors(role: Role, expression: &str, table: &dyn Table) -> Result<Vec<Factor>, Problem> {
    let names = table.names();
    let whole = [expression];
    let parts: Vec<&str> = if names.iter().any(|name| name == expression) {
        whole.to_vec()
    } else {
        expression.split('*').map(str::trim).collect()
    };
    parts
        .into_iter()
        .map(|part| {
            let exact = names.iter().find(|name| *name == part);
            let found = exact.or_else(|| names.iter().find(|name| name.eq_ignore_ascii_case(part)));
            match (found, part.parse::<f64>()) {
                (Some(name), _) => Ok(Factor::Column(name.clone())),
                (None, Ok(number)) if number.is_finite() => Ok(Factor::Number(number)),
                _ => Err(table.missing(role.facts().name, Some(part))),
            }
        })
        .collect()
}

fn said(role: Role, source: &Source, factors: &[Factor]) -> Result<Said, Problem> {
    if let Some(text) = &source.unit {
        let unit = unit::find(text).ok_or_else(|| unknown_unit(role, text))?;
        return accepted(role, unit).map(Said::Unit);
    }
    let [Factor::Column(name)] = factors else {
        return Ok(Said::Nothing);
    };
    let header = Header::parse(name);
    match (header.unit, header.bracketed) {
        (Some(unit), _) if role.accepts(unit.quantity) => Ok(Said::Unit(unit)),
        // A gain turns whatever it is into SI.
        _ if source.gain.is_some() => Ok(Said::Nothing),
        (Some(unit), _) if unit.quantity == Quantity::Raw => {
            Err(Problem::NeedsGain { role: role.facts().name, unit: unit.name.to_owned() })
        }
        (Some(unit), _) => accepted(role, unit).map(Said::Unit),
        (None, Some(text)) if !text.is_empty() => Err(unknown_unit(role, text)),
        _ if role.facts().rotary_aliases.contains(&header.base.as_str()) => Ok(Said::Rotary),
        _ => Ok(Said::Nothing),
    }
}

fn known_units(role: Role) -> Vec<&'static str> {
    let facts = role.facts();
    let mut names = unit::names(facts.linear);
    if facts.rotary != facts.linear {
        names.extend(unit::names(facts.rotary));
    }
    names
}

fn unknown_unit(role: Role, text: &str) -> Problem {
    Problem::UnknownUnit {
        role: role.facts().name,
        unit: text.to_owned(),
        nearest: unit::nearest(text),
        known: known_units(role),
    }
}

fn accepted(role: Role, unit: &'static Unit) -> Result<&'static Unit, Problem> {
    if role.accepts(unit.quantity) {
        return Ok(unit);
    }
    let (role, known) = (role.facts().name, known_units(role));
    Err(Problem::WrongUnit { role, unit: unit.name.to_owned(), known })
}

fn checked(column: Column, table: &dyn Table, path: &Path) -> Result<Column, DataError> {
    let Some(bad) = column.bad else {
        return Ok(column);
    };
    let error = DataError::new(path, Problem::NotANumber { value: bad.text });
    Err(error.at_sample(bad.sample, table.line(bad.sample)).in_column(column.name))
}

fn multiplied(product: Vec<f64>, column: Column, path: &Path) -> Result<Vec<f64>, DataError> {
    let (samples, values) = (product.len(), column.values.len());
    if values == 1 {
        return Ok(product.into_iter().map(|value| value * column.values[0]).collect());
    }
    if samples == 1 {
        return Ok(column.values.into_iter().map(|value| value * product[0]).collect());
    }
    if samples != values {
        let problem = Problem::Length { name: column.name, values, samples };
        return Err(DataError::new(path, problem));
    }
    Ok(product.into_iter().zip(column.values).map(|(a, b)| a * b).collect())
}
