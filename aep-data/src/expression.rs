//! A column, a product of columns, or a formula over columns.

use std::path::Path;

use aep_formula::{Formula, constant};

use crate::error::{DataError, Problem};
use crate::table::{Column, Table};

/// One factor of a product.
#[derive(Clone, Debug)]
enum Factor {
    Column(String),
    Number(f64),
}

/// What a name of a formula stands for.
type Name = Factor;

/// Where values come from.
#[derive(Clone, Debug)]
enum Kind {
    Product(Vec<Factor>),
    Formula(Formula, Vec<Name>),
}

/// Where values come from, as it stands in a command or in `DATA.toml`.
#[derive(Clone, Debug)]
pub(crate) struct Expression {
    pub text: String,
    kind: Kind,
}

impl Expression {
    /// Finds the columns of `text` in `table`; `role` is what is read from them, in words.
    pub fn find(role: &str, text: &str, table: &dyn Table) -> Result<Self, Problem> {
        let text = text.trim();
        let product = product(text, table);
        let kind = match product {
            Ok(factors) => Kind::Product(factors),
            Err(missing) => match Formula::parse(text) {
                Ok(formula) => {
                    let names = formula.names().iter();
                    let names =
                        names.map(|name| named(role, name, table)).collect::<Result<_, _>>()?;
                    Kind::Formula(formula, names)
                }
                // A product of names that are no formula: the name of a column with a mistake in it.
                Err(_) if is_name(text) => return Err(table.missing(role, Some(&missing))),
                Err(error) => return Err(Problem::Formula { role: role.to_owned(), error }),
            },
        };
        Ok(Self { text: text.to_owned(), kind })
    }

    /// The one column that it is, if it is no more than that.
    pub fn single(&self) -> Option<&str> {
        match &self.kind {
            Kind::Product(factors) => match factors.as_slice() {
                [Factor::Column(name)] => Some(name),
                _ => None,
            },
            Kind::Formula(..) => None,
        }
    }

    /// The columns it is made of.
    pub fn columns(&self) -> impl Iterator<Item = &str> {
        let (Kind::Product(names) | Kind::Formula(_, names)) = &self.kind;
        names.iter().filter_map(|factor| match factor {
            Factor::Column(name) => Some(name.as_str()),
            Factor::Number(_) => None,
        })
    }

    /// Its values; one value where everything in it is single.
    pub fn values(&self, table: &dyn Table, path: &Path) -> Result<Vec<f64>, DataError> {
        match &self.kind {
            Kind::Product(factors) => multiplied(factors, table, path),
            Kind::Formula(formula, names) => evaluated(formula, names, table, path),
        }
    }
}

/// A name without any operator but `*`, or with none at all.
fn is_name(text: &str) -> bool {
    !text.is_empty() && !text.contains(['+', '/', '^', '(', ')', '<', '>', '=', '%', ',', '`'])
}

/// The factors, or the first part that is neither a column nor a number.
fn product(text: &str, table: &dyn Table) -> Result<Vec<Factor>, String> {
    let names = table.names();
    if names.iter().any(|name| name == text) {
        return Ok(vec![Factor::Column(text.to_owned())]);
    }
    let part = |part: &str| match (column(part, &names), part.parse::<f64>()) {
        (Some(name), _) => Ok(Factor::Column(name)),
        (None, Ok(number)) if number.is_finite() => Ok(Factor::Number(number)),
        _ => Err(part.to_owned()),
    };
    text.split('*').map(str::trim).map(part).collect()
}

fn column(wanted: &str, names: &[String]) -> Option<String> {
    let exact = names.iter().find(|name| *name == wanted);
    let any_case = || names.iter().find(|name| name.eq_ignore_ascii_case(wanted));
    // A unit in brackets may be left out.
    let bare = |name: &&String| name.split(" [").next() == Some(wanted) && name.ends_with(']');
    exact.or_else(any_case).or_else(|| names.iter().find(bare)).cloned()
}

fn named(role: &str, name: &str, table: &dyn Table) -> Result<Name, Problem> {
    match (column(name, &table.names()), constant(name)) {
        (Some(name), _) => Ok(Factor::Column(name)),
        (None, Some(number)) => Ok(Factor::Number(number)),
        (None, None) => Err(table.missing(role, Some(name))),
    }
}

fn checked(column: Column, table: &dyn Table, path: &Path) -> Result<Column, DataError> {
    let Some(bad) = column.bad else {
        return Ok(column);
    };
    let error = DataError::new(path, Problem::NotANumber { value: bad.text });
    Err(error.at_sample(bad.sample, table.line(bad.sample)).in_column(column.name))
}

fn multiplied(factors: &[Factor], table: &dyn Table, path: &Path) -> Result<Vec<f64>, DataError> {
    let mut product = vec![1.0];
    for factor in factors {
        match factor {
            Factor::Number(number) => product.iter_mut().for_each(|value| *value *= number),
            Factor::Column(name) => {
                let column = checked(table.column(name)?, table, path)?;
                let samples = common(product.len(), &column, path)?;
                let all = (0..samples).map(|k| at(&product, k) * at(&column.values, k));
                product = all.collect();
            }
        }
    }
    Ok(product)
}

fn evaluated(
    formula: &Formula,
    names: &[Name],
    table: &dyn Table,
    path: &Path,
) -> Result<Vec<f64>, DataError> {
    let mut columns = Vec::new();
    let mut samples = 1;
    for name in names {
        columns.push(match name {
            Factor::Number(number) => vec![*number],
            Factor::Column(name) => {
                let column = checked(table.column(name)?, table, path)?;
                samples = common(samples, &column, path)?;
                column.values
            }
        });
    }
    let (mut stack, mut row) = (Vec::new(), vec![0.0; columns.len()]);
    let mut values = Vec::with_capacity(samples);
    for k in 0..samples {
        row.iter_mut().zip(&columns).for_each(|(value, column)| *value = at(column, k));
        let value = formula.value_on(&row, &mut stack);
        if !value.is_finite() {
            let with: Vec<String> = formula
                .names()
                .iter()
                .zip(&row)
                .map(|(name, value)| format!("{name} = {value}"))
                .collect();
            let formula = formula.text().to_owned();
            let problem = Problem::NotFinite { formula, value, with: with.join(", ") };
            return Err(DataError::new(path, problem).at_sample(k, table.line(k)));
        }
        values.push(value);
    }
    Ok(values)
}

fn at(values: &[f64], k: usize) -> f64 {
    values[if values.len() == 1 { 0 } else { k }]
}

/// Number of samples of values and a column, each of them one for all or one a sample.
fn common(samples: usize, column: &Column, path: &Path) -> Result<usize, DataError> {
    let values = column.values.len();
    match (samples, values) {
        (_, 1) => return Ok(samples),
        (1, _) => return Ok(values),
        _ if samples == values => return Ok(samples),
        _ => {}
    }
    let problem = Problem::Length { name: column.name.clone(), values, samples };
    Err(DataError::new(path, problem))
}
