//! A reference alone: time and the position that is asked for.

use std::path::Path;

use crate::csv_table::CsvTable;
use crate::error::{DataError, Problem};
use crate::mapping::Source;
use crate::pick::Pick;
use crate::role::ColumnRole;
use crate::table::Table;
use crate::unreadable;

/// Positions over time, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferencePath {
    /// s, increasing.
    pub time: Vec<f64>,
    /// m or rad.
    pub position: Vec<f64>,
    /// Whether the file says that it is an angle, or a length; none where it says neither.
    pub rotary: Option<bool>,
}

/// Reads a CSV file with a time and a reference (or position): `time_s,reference_mm`.
///
/// # Errors
/// Whatever is wrong with the file, with the place and a way to mend it.
pub fn read_reference(path: &Path) -> Result<ReferencePath, DataError> {
    let bytes = std::fs::read(path).map_err(|error| DataError::new(path, unreadable(&error)))?;
    let table = CsvTable::parse(path, &bytes)?;
    let find = |role| Pick::find(role, &Source::default(), &table, path);
    let missing = |role| DataError::new(path, table.missing(role, None));
    let time = find(ColumnRole::Time)?.ok_or_else(|| missing("time"))?;
    let position = match find(ColumnRole::Reference)? {
        Some(pick) => pick,
        None => find(ColumnRole::Position)?.ok_or_else(|| missing("reference"))?,
    };
    let rotary = position.is_rotary();
    let (time, position) = (time.values(&table, path)?, position.values(&table, path)?);
    if let Some(late) = time
        .windows(2)
        .position(|pair| pair[1].partial_cmp(&pair[0]).is_none_or(std::cmp::Ordering::is_le))
    {
        let problem = Problem::TimeBackwards { before: time[late], after: time[late + 1] };
        return Err(DataError::new(path, problem).at_line(table.line(late + 1)));
    }
    Ok(ReferencePath { time, position, rotary })
}
