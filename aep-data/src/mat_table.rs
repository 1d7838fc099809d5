//! MATLAB v5 files: every numeric variable is a column, and every numeric field of a structure.

use std::path::{Path, PathBuf};

use matfile::{MatFile, NumericData};

use crate::error::{DataError, Problem};
use crate::mat_fields;
use crate::mat_index::{self, Entry, HEADER, Order};
use crate::table::{Column, Table, nearest};

/// An opened MATLAB file.
pub(crate) struct MatTable {
    path: PathBuf,
    bytes: Vec<u8>,
    entries: Vec<Entry>,
}

impl MatTable {
    /// Lists the variables in `bytes`, the content of `path`.
    pub fn parse(path: &Path, bytes: Vec<u8>) -> Result<Self, DataError> {
        let entries = mat_index::list(&bytes)
            .map_err(|what| DataError::new(path, Problem::DamagedMat { what }))?;
        Ok(Self { path: path.to_owned(), bytes, entries })
    }

    /// A file with this one variable, which is all that the reader of arrays gets to see.
    fn alone(&self, entry: &Entry) -> Vec<u8> {
        let variable = match &entry.within {
            None => self.bytes[entry.bytes.clone()].to_vec(),
            Some(structure) => {
                let field = structure[entry.bytes.clone()].to_vec();
                mat_fields::named(Order::of(&self.bytes), field)
            }
        };
        [&self.bytes[..HEADER], &variable].concat()
    }

    fn fail(&self, problem: Problem) -> DataError {
        DataError::new(&self.path, problem)
    }
}

impl Table for MatTable {
    fn names(&self) -> Vec<String> {
        let numeric = self.entries.iter().filter(|entry| entry.numeric);
        numeric.map(|entry| entry.name.clone()).collect()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let found = self.entries.iter().find(|entry| entry.name == name);
        let entry = found.ok_or_else(|| self.fail(self.missing("variable", Some(name))))?;
        check_vector(entry).map_err(|problem| self.fail(problem))?;
        let damaged = |what: String| self.fail(Problem::DamagedMat { what });
        let file = MatFile::parse(self.alone(entry).as_slice())
            .map_err(|error| damaged(format!("'{name}': {error}")))?;
        let array = file.arrays().first().ok_or_else(|| damaged(format!("'{name}' is cut off")))?;
        let values = real(array.data());
        Ok(Column { name: name.to_owned(), values, bad: None })
    }

    fn line(&self, _sample: usize) -> Option<u64> {
        None
    }

    fn missing(&self, role: &str, column: Option<&str>) -> Problem {
        let dropped = self.entries.iter().find(|e| !e.numeric && Some(e.name.as_str()) == column);
        if let Some(entry) = dropped {
            let (name, class) = (entry.name.clone(), entry.class);
            return Problem::NotNumeric { name, class, field: None };
        }
        // A structure whose fields are listed.
        let inside = column.map(|column| format!("{column}."));
        let field = inside.and_then(|inside| {
            self.entries.iter().find(|e| e.numeric && e.name.starts_with(&inside))
        });
        if let (Some(name), Some(field)) = (column, field) {
            let (name, field) = (name.to_owned(), Some(field.name.clone()));
            return Problem::NotNumeric { name, class: mat_index::STRUCTURE, field };
        }
        let present = self.entries.iter().map(Entry::label).collect();
        let nearest = nearest(column.unwrap_or(role), &self.names());
        Problem::MissingVariable {
            role: role.to_owned(),
            column: column.map(str::to_owned),
            present,
            nearest,
        }
    }
}

fn check_vector(entry: &Entry) -> Result<(), Problem> {
    let rows = entry.size.first().copied().unwrap_or(0);
    let columns: usize = entry.size.iter().skip(1).product();
    if rows == 1 || columns == 1 {
        return Ok(());
    }
    Err(Problem::NotAVector { name: entry.name.clone(), rows, columns })
}

fn real(data: &NumericData) -> Vec<f64> {
    match data {
        NumericData::Int8 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::UInt8 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::Int16 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::UInt16 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::Int32 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::UInt32 { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::Int64 { real, .. } => real.iter().map(|&value| value as f64).collect(),
        NumericData::UInt64 { real, .. } => real.iter().map(|&value| value as f64).collect(),
        NumericData::Single { real, .. } => real.iter().map(|&value| f64::from(value)).collect(),
        NumericData::Double { real, .. } => real.clone(),
    }
}
