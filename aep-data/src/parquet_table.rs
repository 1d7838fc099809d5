//! Parquet, as `LeRobot` and pandas write it: every numeric column is one, every entry of a list one more.

use std::collections::BTreeMap;
use std::path::Path;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use crate::error::{DataError, Problem};
use crate::memory_table::MemoryTable;

/// Most entries of a list that become columns of their own.
const MOST_ENTRIES: usize = 64;

/// Whether these are the bytes of a Parquet file.
pub(crate) fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1")
}

/// The columns that hold numbers.
pub(crate) fn read(path: &Path, bytes: Vec<u8>) -> Result<MemoryTable<'static>, DataError> {
    let damaged =
        |what: String| DataError::new(path, Problem::Damaged { format: "Parquet file", what });
    // The crate takes much for granted: a column that begins in the file, a dictionary before what refers to it.
    aep_core::caught(|| numbers(path, bytes, &damaged))
        .unwrap_or_else(|_| Err(damaged("its columns contradict each other".to_owned())))
}

fn numbers(
    path: &Path,
    bytes: Vec<u8>,
    damaged: &dyn Fn(String) -> DataError,
) -> Result<MemoryTable<'static>, DataError> {
    let reader =
        SerializedFileReader::new(bytes::Bytes::from(bytes)).map_err(|e| damaged(e.to_string()))?;
    let rows = reader.get_row_iter(None).map_err(|e| damaged(e.to_string()))?;
    let mut names: Vec<String> = Vec::new();
    let mut columns: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (index, row) in rows.enumerate() {
        let row = row.map_err(|e| damaged(e.to_string()))?;
        let mut put = |name: String, value: f64| {
            let column = columns.entry(name.clone()).or_insert_with(|| {
                names.push(name);
                Vec::new()
            });
            // What was missing before is no number.
            column.resize(index, f64::NAN);
            column.push(value);
        };
        for (name, field) in row.get_column_iter() {
            match field {
                Field::ListInternal(list) if list.elements().len() <= MOST_ENTRIES => {
                    for (k, entry) in list.elements().iter().enumerate() {
                        if let Some(value) = number(entry) {
                            put(format!("{name}_{k}"), value);
                        }
                    }
                }
                field => {
                    if let Some(value) = number(field) {
                        put(name.clone(), value);
                    }
                }
            }
        }
    }
    let longest = columns.values().map(Vec::len).max().unwrap_or(0);
    let named = names.into_iter().map(|name| {
        let mut values = columns.remove(&name).unwrap_or_default();
        values.resize(longest, f64::NAN);
        (name, values)
    });
    MemoryTable::new(path, named.collect())
}

fn number(field: &Field) -> Option<f64> {
    Some(match field {
        Field::Bool(yes) => f64::from(u8::from(*yes)),
        Field::Byte(value) => f64::from(*value),
        Field::Short(value) => f64::from(*value),
        Field::Int(value) => f64::from(*value),
        Field::Long(value) => *value as f64,
        Field::UByte(value) => f64::from(*value),
        Field::UShort(value) => f64::from(*value),
        Field::UInt(value) => f64::from(*value),
        Field::ULong(value) => *value as f64,
        Field::Float(value) => f64::from(*value),
        Field::Double(value) => *value,
        // Times of a data frame, as seconds.
        Field::TimestampMillis(value) => *value as f64 * 1e-3,
        Field::TimestampMicros(value) => *value as f64 * 1e-6,
        _ => return None,
    })
}
