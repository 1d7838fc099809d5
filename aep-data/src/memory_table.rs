//! Columns that were read as a whole: of formats whose readers give them so.

use std::path::{Path, PathBuf};

use crate::error::{DataError, Problem};
use crate::table::{Column, Table, nearest};

/// Named columns in memory.
pub(crate) struct MemoryTable {
    path: PathBuf,
    columns: Vec<Column>,
}

impl MemoryTable {
    /// Of columns with their names.
    pub fn new(path: &Path, columns: Vec<(String, Vec<f64>)>) -> Result<Self, DataError> {
        if columns.is_empty() {
            return Err(DataError::new(path, Problem::Empty));
        }
        let columns = columns.into_iter().map(|(name, values)| Column { name, values, bad: None });
        Ok(Self { path: path.to_owned(), columns: columns.collect() })
    }
}

impl Table for MemoryTable {
    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let found = self.columns.iter().find(|column| column.name == name);
        found.cloned().ok_or_else(|| DataError::new(&self.path, self.missing("column", Some(name))))
    }

    fn line(&self, _sample: usize) -> Option<u64> {
        None
    }

    fn missing(&self, role: &str, column: Option<&str>) -> Problem {
        let present = self.names();
        let nearest = nearest(column.unwrap_or(role), &present);
        let (role, column) = (role.to_owned(), column.map(str::to_owned));
        Problem::MissingColumn { role, column, present, nearest }
    }
}
