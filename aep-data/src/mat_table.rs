//! MATLAB v5 files: every numeric variable is a column.

use std::path::{Path, PathBuf};

use matfile::{MatFile, NumericData};

use crate::error::{DataError, Problem};
use crate::mat_index::{self, Entry, HEADER};
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
        [&self.bytes[..HEADER], &self.bytes[entry.bytes.clone()]].concat()
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
            return Problem::NotNumeric { name: entry.name.clone(), class: entry.class };
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
