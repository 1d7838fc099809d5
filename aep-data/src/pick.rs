//! Which column or product a quantity is read from, and in which unit.

use std::path::Path;

use crate::error::{DataError, Problem};
use crate::expression::Expression;
use crate::header::{Header, recognise, unit_unknown};
use crate::mapping::Source;
use crate::role::ColumnRole;
use crate::table::Table;
use crate::unit::{self, Dimension, Unit};

/// The unit of a quantity, as far as the file says it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Said {
    /// The name or the mapping gives the unit.
    Unit(&'static Unit),
    /// A voltage or a current that stays one: its factor to V or A.
    Electrical(&'static Unit),
    /// Only the word, such as `torque`, says that it is rotary, in SI.
    Rotary,
    /// Nothing says it: SI.
    Nothing,
}

/// Where a quantity comes from.
#[derive(Clone, Debug)]
pub(crate) struct Pick {
    pub role: ColumnRole,
    /// Column, product or formula, as it stands in the file.
    pub expression: Expression,
    pub said: Said,
    pub gain: f64,
}

impl Pick {
    /// Finds the source of `role` in `table`; nothing where it is not there and nobody asked for it.
    pub fn find(
        role: ColumnRole,
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
        let expression = Expression::find(role.facts().name, &expression, table)
            .map_err(|problem| DataError::new(path, problem))?;
        let said = said(role, source, expression.single())
            .map_err(|problem| DataError::new(path, problem).in_column(&expression.text))?;
        Ok(Some(Self { role, expression, said, gain }))
    }

    /// Whether it belongs to a rotary axis, where that is known.
    pub fn is_rotary(&self) -> Option<bool> {
        let facts = self.role.facts();
        match self.said {
            _ if facts.linear == facts.rotary => None,
            Said::Unit(unit) => Some(unit.quantity == facts.rotary),
            Said::Rotary => Some(true),
            Said::Nothing | Said::Electrical(_) => None,
        }
    }

    /// `V` or `A` where it is a voltage or a current in place of a force.
    pub fn electrical(&self) -> Option<&'static str> {
        match self.said {
            Said::Electrical(unit) => unit::electrical(unit),
            _ => None,
        }
    }

    /// The columns it is made of.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        self.expression.columns()
    }

    /// Its values in SI; one value where all factors are single.
    pub fn values(&self, table: &dyn Table, path: &Path) -> Result<Vec<f64>, DataError> {
        let values = self.expression.values(table, path)?;
        let (factor, shift) = match self.said {
            Said::Unit(unit) | Said::Electrical(unit) => (unit.factor * self.gain, unit.shift),
            _ => (self.gain, 0.0),
        };
        Ok(values.into_iter().map(|value| value * factor + shift).collect())
    }
}

fn no_column(
    role: ColumnRole,
    source: &Source,
    table: &dyn Table,
    path: &Path,
) -> Result<(), DataError> {
    if !role.is_required() && source.gain.is_none() && source.unit.is_none() {
        return Ok(());
    }
    let name = role.facts().name;
    let names = table.names();
    if let Some(column) =
        recognise(ColumnRole::Velocity, &names).filter(|_| role == ColumnRole::Position)
    {
        return Err(DataError::new(path, Problem::VelocityOnly { column: column.clone() }));
    }
    let Some((column, unit)) = unit_unknown(role, &names) else {
        return Err(DataError::new(path, table.missing(name, None)));
    };
    Err(DataError::new(path, unknown_unit(role, unit)).in_column(column))
}

fn checked_gain(role: ColumnRole, source: &Source) -> Result<f64, Problem> {
    let gain = source.gain.unwrap_or(1.0);
    if gain.is_finite() && gain != 0.0 {
        return Ok(gain);
    }
    let what = format!("the gain of the {}", role.facts().name);
    Err(Problem::BadNumber { what, value: gain, must: "finite and not zero" })
}

fn said(role: ColumnRole, source: &Source, column: Option<&str>) -> Result<Said, Problem> {
    if let Some(text) = &source.unit {
        let unit = unit::find(text).ok_or_else(|| unknown_unit(role, text))?;
        if is_effort(role) && unit::electrical(unit).is_some() {
            return Ok(Said::Electrical(unit));
        }
        return accepted(role, unit).map(Said::Unit);
    }
    let Some(name) = column else {
        return Ok(Said::Nothing);
    };
    let header = Header::parse(name);
    match (header.unit, header.bracketed) {
        (Some(unit), _) if role.accepts(unit.quantity) => Ok(Said::Unit(unit)),
        // A gain turns whatever it is into SI.
        _ if source.gain.is_some() => Ok(Said::Nothing),
        (Some(unit), _) if is_effort(role) && unit::electrical(unit).is_some() => {
            Ok(Said::Electrical(unit))
        }
        (Some(unit), _) if unit.quantity == Dimension::Raw => {
            Err(Problem::NeedsGain { role: role.facts().name, unit: unit.name.to_owned() })
        }
        (Some(unit), _) => accepted(role, unit).map(Said::Unit),
        (None, Some(text)) if !text.is_empty() => Err(unknown_unit(role, text)),
        _ if role.facts().rotary_aliases.contains(&header.base.as_str()) => Ok(Said::Rotary),
        _ => Ok(Said::Nothing),
    }
}

/// Whether a voltage or a current may stand in its place.
fn is_effort(role: ColumnRole) -> bool {
    matches!(role, ColumnRole::Force | ColumnRole::ModelForce)
}

fn known_units(role: ColumnRole) -> Vec<&'static str> {
    let facts = role.facts();
    let mut names = unit::names(facts.linear);
    if facts.rotary != facts.linear {
        names.extend(unit::names(facts.rotary));
    }
    names
}

fn unknown_unit(role: ColumnRole, text: &str) -> Problem {
    Problem::UnknownUnit {
        role: role.facts().name,
        unit: text.to_owned(),
        nearest: unit::nearest(text),
        known: known_units(role),
    }
}

fn accepted(role: ColumnRole, unit: &'static Unit) -> Result<&'static Unit, Problem> {
    if role.accepts(unit.quantity) {
        return Ok(unit);
    }
    let (role, known) = (role.facts().name, known_units(role));
    Err(Problem::WrongUnit { role, unit: unit.name.to_owned(), known })
}
