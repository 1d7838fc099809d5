//! Columns that were read as a whole: of formats whose readers give them so.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::error::{DataError, Problem};
use crate::table::{Column, Table, nearest};

/// Named columns in memory: its own, or lent by somebody else, whose unused ones are never copied.
pub(crate) struct MemoryTable<'a> {
    path: PathBuf,
    columns: Vec<(String, Cow<'a, [f64]>)>,
}

impl<'a> MemoryTable<'a> {
    /// Of columns with their names.
    pub fn new(
        path: &Path,
        columns: Vec<(String, impl Into<Cow<'a, [f64]>>)>,
    ) -> Result<Self, DataError> {
        if columns.is_empty() {
            return Err(DataError::new(path, Problem::Empty));
        }
        let columns = columns.into_iter().map(|(name, values)| (name, values.into()));
        Ok(Self { path: path.to_owned(), columns: columns.collect() })
    }
}

impl Table for MemoryTable<'_> {
    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|(name, _)| name.clone()).collect()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let found = self.columns.iter().find(|(own, _)| own == name);
        let column = |(name, values): &(String, Cow<'_, [f64]>)| Column {
            name: name.clone(),
            values: values.to_vec(),
            bad: None,
        };
        let missing = || DataError::new(&self.path, self.missing("column", Some(name)));
        found.map(column).ok_or_else(missing)
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
