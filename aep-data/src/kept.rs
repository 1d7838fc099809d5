//! Rows of a file that make a recording: those that have a number in every column that is used, and a time of their own.

use std::collections::BTreeSet;
use std::path::Path;

use crate::error::{DataError, Problem};
use crate::table::{Column, Table};

/// Share of the rows from which on what is left out is no exception: the whole file is refused.
pub(crate) const MOST: f64 = 0.25;

/// How many rows were left out, and why.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Rows without a number (empty, NaN, infinite) in a column that is used.
    pub missing: usize,
    /// Rows that have the time of the row before.
    pub repeated: usize,
}

/// A table without some of its rows.
pub(crate) struct Kept<'a> {
    table: &'a dyn Table,
    rows: usize,
    /// Those that are left, where some are not.
    left: Option<Vec<usize>>,
}

impl<'a> Kept<'a> {
    /// The rows that have a number in every one of `columns`.
    pub fn of(
        table: &'a dyn Table,
        columns: &BTreeSet<&str>,
        path: &Path,
    ) -> Result<Self, DataError> {
        let mut missing: Vec<bool> = Vec::new();
        let mut first = None;
        for name in columns {
            let column = table.column(name)?;
            // A single value holds for all rows: without a number there is nothing.
            if column.values.len() < 2 {
                continue;
            }
            missing.resize(missing.len().max(column.values.len()), false);
            for (k, value) in column.values.iter().enumerate() {
                // What is no number by mistake is told with its place where it is used.
                let is_mistake = column.bad.as_ref().is_some_and(|bad| bad.sample == k);
                if !value.is_finite() && !is_mistake {
                    missing[k] = true;
                    if first.as_ref().is_none_or(|(row, _)| k < *row) {
                        first = Some((k, (*name).to_owned()));
                    }
                }
            }
        }
        let rows = missing.len();
        let out = missing.iter().filter(|missing| **missing).count();
        let left = (out > 0).then(|| (0..rows).filter(|k| !missing[*k]).collect());
        if let Some((row, column)) = first.filter(|_| out as f64 > MOST * rows as f64) {
            let problem = Problem::TooManyMissing { missing: out, rows };
            return Err(DataError::new(path, problem)
                .at_sample(row, table.line(row))
                .in_column(column));
        }
        Ok(Self { table, rows, left })
    }

    /// Number of rows that are left.
    pub fn len(&self) -> usize {
        self.left.as_ref().map_or(self.rows, Vec::len)
    }

    /// Number of rows that were left out.
    pub fn left_out(&self) -> usize {
        self.rows - self.len()
    }

    /// The same without these of its rows.
    pub fn without(mut self, rows: &[usize]) -> Self {
        if rows.is_empty() {
            return self;
        }
        let mut out = rows.iter().copied().peekable();
        let mut at = 0;
        self.left.get_or_insert_with(|| (0..self.rows).collect()).retain(|_| {
            let keeps = out.next_if_eq(&at).is_none();
            at += 1;
            keeps
        });
        self
    }
}

impl Table for Kept<'_> {
    fn names(&self) -> Vec<String> {
        self.table.names()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let mut column = self.table.column(name)?;
        // Columns of another length are told where they are used.
        if let Some(left) = self.left.as_ref().filter(|_| column.values.len() == self.rows) {
            column.values = left.iter().map(|k| column.values[*k]).collect();
            if let Some(bad) = &mut column.bad {
                bad.sample = left.partition_point(|k| *k < bad.sample);
            }
        }
        Ok(column)
    }

    fn line(&self, sample: usize) -> Option<u64> {
        let left = self.left.as_ref().and_then(|left| left.get(sample).copied());
        self.table.line(left.unwrap_or(sample))
    }

    fn missing(&self, role: &str, column: Option<&str>) -> Problem {
        self.table.missing(role, column)
    }
}

/// Rows whose time is that of the row before them, in the same piece.
pub(crate) fn repeated(time: &[f64], segment: Option<&[f64]>) -> Vec<usize> {
    let same = |k: &usize| {
        let piece = |k: usize| segment.and_then(|segment| segment.get(k));
        time[*k] == time[*k - 1] && piece(*k) == piece(*k - 1)
    };
    (1..time.len()).filter(same).collect()
}
