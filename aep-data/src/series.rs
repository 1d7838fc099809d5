//! Tables of results, a row a sample, as CSV or Parquet.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use crate::save::{SaveError, save_with};

/// Rows of a group of a Parquet file.
const GROUP: usize = 1 << 20;

/// What a table is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A header and a line a row; numbers exact to the bit, nothing where there is no number.
    Csv,
    /// Doubles and texts, Snappy; NaN where there is no number.
    Parquet,
}

impl Format {
    /// The format that the name of a file asks for.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        match () {
            () if ending.eq_ignore_ascii_case("csv") => Some(Self::Csv),
            () if ending.eq_ignore_ascii_case("parquet") => Some(Self::Parquet),
            () => None,
        }
    }
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values<'a> {
    /// Numbers; NaN where there is none.
    Numbers(&'a [f64]),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Texts, nothing where there is none.
    Texts(Vec<&'a str>),
}

impl Values<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }
}

/// Writes columns of one length to `path`, completely or not at all.
///
/// # Errors
/// The path and what the system says.
pub fn save_series(
    path: &Path,
    format: Format,
    columns: &[(String, Values<'_>)],
) -> Result<(), SaveError> {
    save_with(path, |file| match format {
        Format::Csv => csv(&mut BufWriter::new(file), columns),
        Format::Parquet => parquet(file, columns).map_err(std::io::Error::other),
    })
}

fn rows(columns: &[(String, Values<'_>)]) -> usize {
    columns.iter().map(|(_, values)| values.len()).min().unwrap_or(0)
}

fn csv(out: &mut impl Write, columns: &[(String, Values<'_>)]) -> std::io::Result<()> {
    let names: Vec<String> = columns.iter().map(|(name, _)| quoted(name)).collect();
    writeln!(out, "{}", names.join(","))?;
    for row in 0..rows(columns) {
        for (k, (_, values)) in columns.iter().enumerate() {
            if k > 0 {
                out.write_all(b",")?;
            }
            match values {
                // {:?} is the shortest text that reads back the same.
                Values::Numbers(values) if values[row].is_finite() => {
                    write!(out, "{:?}", values[row])?;
                }
                Values::Numbers(_) => {}
                Values::Whole(values) => write!(out, "{}", values[row])?,
                Values::Texts(values) => write!(out, "{}", quoted(values[row]))?,
            }
        }
        out.write_all(b"\n")?;
    }
    out.flush()
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn parquet(file: &mut File, columns: &[(String, Values<'_>)]) -> Result<(), ParquetError> {
    let field = |(name, values): &(String, Values<'_>)| {
        let physical = match values {
            Values::Numbers(_) => Physical::DOUBLE,
            Values::Whole(_) => Physical::INT64,
            Values::Texts(_) => Physical::BYTE_ARRAY,
        };
        let text = matches!(values, Values::Texts(_)).then_some(LogicalType::String);
        Type::primitive_type_builder(name, physical)
            .with_repetition(Repetition::REQUIRED)
            .with_logical_type(text)
            .build()
            .map(Arc::new)
    };
    let fields: Result<Vec<_>, _> = columns.iter().map(field).collect();
    let schema = Arc::new(Type::group_type_builder("schema").with_fields(fields?).build()?);
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties))?;
    let rows = rows(columns);
    for start in (0..rows).step_by(GROUP) {
        let part = start..rows.min(start + GROUP);
        let mut group = writer.next_row_group()?;
        for (_, values) in columns {
            let Some(mut column) = group.next_column()? else { break };
            match values {
                Values::Numbers(values) => {
                    column.typed::<DoubleType>().write_batch(&values[part.clone()], None, None)?;
                }
                Values::Whole(values) => {
                    column.typed::<Int64Type>().write_batch(&values[part.clone()], None, None)?;
                }
                Values::Texts(values) => {
                    let texts: Vec<ByteArray> =
                        values[part.clone()].iter().map(|text| ByteArray::from(*text)).collect();
                    column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
                }
            }
            column.close()?;
        }
        group.close()?;
    }
    // Flushes, too.
    writer.into_inner().map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parquet_table;
    use crate::table::Table;

    #[test]
    fn a_table_reads_back_to_the_bit_in_either_format() {
        let folder = tempfile::tempdir().unwrap();
        let numbers = [0.1, f64::NAN, -1e-300, 1.0 / 3.0];
        let columns = [
            ("x_m".to_owned(), Values::Numbers(&numbers)),
            ("piece".to_owned(), Values::Whole(vec![0, 0, 1, 1])),
            ("why".to_owned(), Values::Texts(vec!["", "a, b", "say \"c\"", ""])),
        ];
        let path = folder.path().join("out.csv");
        save_series(&path, Format::Csv, &columns).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().next(), Some("x_m,piece,why"));
        assert_eq!(text.lines().nth(2), Some(",0,\"a, b\""));
        assert_eq!(text.lines().nth(4), Some("0.3333333333333333,1,"));
        let path = folder.path().join("out.parquet");
        save_series(&path, Format::Parquet, &columns).unwrap();
        let table = parquet_table::read(&path, std::fs::read(&path).unwrap()).unwrap();
        let back = table.column("x_m").unwrap().values;
        assert!(back.iter().zip(&numbers).all(|(a, b)| a.to_bits() == b.to_bits() || b.is_nan()));
        assert_eq!(table.column("piece").unwrap().values, [0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn the_name_of_a_file_says_its_format() {
        assert_eq!(Format::of(Path::new("a/b.CSV")), Some(Format::Csv));
        assert_eq!(Format::of(Path::new("b.parquet")), Some(Format::Parquet));
        assert_eq!(Format::of(Path::new("b.txt")), None);
    }
}
