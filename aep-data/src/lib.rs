//! Recordings from files: CSV, MATLAB, HDF5, `.npz`, Parquet, Excel and MCAP, with column mapping, units and errors that say how to
//! mend them.
//!
//! A CSV with the header `time_s,force_N,position_m` needs nothing else. Other units are recognised
//! by the ending of the name (`t_ms`, `Force [mN]`, `angle_deg`), other names are given by a
//! [`Mapping`], from flags or from `DATA.toml` beside the data. Whatever the file holds, the
//! recording is in SI: channels `force` (N or Nm), `position` (m or rad), `velocity`, `reference`,
//! `temperature` (C).
//!
//! ```
//! use aep_data::{Mapping, Source, parse};
//! use std::path::Path;
//!
//! let mut text = String::from("t_ms;enc_mm;u_V\n");
//! for k in 0..100 {
//!     text += &format!("{k};{};{}\n", 0.25 * f64::from(k), 1.5);
//! }
//! let mapping = Mapping {
//!     position: Source::column("enc_mm"),
//!     force: Source { column: Some("u_V".into()), gain: Some(35.15), ..Source::default() },
//!     ..Mapping::default()
//! };
//! let loaded = parse(Path::new("run.csv"), text.into_bytes(), &mapping)?;
//! assert!((loaded.recording.interval() - 0.001).abs() < 1e-12);
//! assert!((loaded.recording.require("force").unwrap()[0] - 52.725).abs() < 1e-9);
//! # Ok::<(), aep_data::DataError>(())
//! ```

mod assemble;
mod axes;
mod csv_table;
mod enabled;
mod error;
mod expression;
mod hdf5_table;
mod header;
mod joint_state;
mod kept;
mod layouts;
mod mapping;
mod mat_fields;
mod mat_index;
mod mat_table;
mod mcap_table;
mod memory_table;
mod npz;
mod parquet_table;
mod part;
mod pick;
mod preview;
mod reference;
mod role;
mod save;
mod series;
mod several;
mod sheet;
mod stamp;
mod table;
mod text;
pub mod unit;
mod write;

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

pub use assemble::{Loaded, Origin};
pub use axes::{Axes, LoadedAxes, PLACE, read_axes};
pub use error::{DataError, Problem};
pub use kept::LeftOut;
pub use layouts::{LAYOUTS, Layout};
pub use mapping::{Mapping, Source, column_channel, hold_name, parse_hold, regressor_channel};
pub use part::{Part, part};
pub use preview::{Preview, PreviewColumn, preview};
pub use reference::{ReferencePath, read_reference};
pub use role::{ALL as ROLES, ColumnRole, Facts};
pub use save::{SaveError, save, save_with};
pub use series::{Format, Values, save_series};
pub use several::read_all;
pub use write::{to_csv, to_csv_rounded, to_toml};

use csv_table::CsvTable;
use mat_table::MatTable;
use missing_physics::Recording;
use table::Table;

/// The name of a file that stands for standard input.
pub const STANDARD_INPUT: &str = "-";

/// The recording in `path`, read by `mapping`, by `DATA.toml` beside it and by the columns' names,
/// in this order.
///
/// # Errors
/// Whatever is wrong with the file, with the place and a way to mend it.
pub fn load(path: &Path, mapping: &Mapping) -> Result<Recording, DataError> {
    read(path, mapping).map(|loaded| loaded.recording)
}

/// Like [`load`], and says how it was read.
///
/// # Errors
/// Like [`load`].
pub fn read(path: &Path, mapping: &Mapping) -> Result<Loaded, DataError> {
    let (table, mapping) = open(path, mapping)?;
    assemble::assemble(path_of(path), &*table, &mapping)
}

/// The name by which a file is told.
fn path_of(path: &Path) -> &Path {
    if path.as_os_str() == STANDARD_INPUT { Path::new("standard input") } else { path }
}

/// The file as named columns, and how it is read: by `mapping` and by `DATA.toml` beside it.
fn open(path: &Path, mapping: &Mapping) -> Result<(Box<dyn Table>, Mapping), DataError> {
    if path.is_dir() {
        return Err(DataError::new(path, Problem::Directory { files: data_files(path) }));
    }
    if path.as_os_str() == STANDARD_INPUT {
        let (mut bytes, name) = (Vec::new(), path_of(path));
        std::io::stdin()
            .lock()
            .read_to_end(&mut bytes)
            .map_err(|error| DataError::new(name, unreadable(&error)))?;
        return Ok((table(name, bytes, mapping)?, mapping.clone()));
    }
    let bytes = std::fs::read(path).map_err(|error| DataError::new(path, unreadable(&error)))?;
    let mapping = mapping.or(&Mapping::beside(path)?);
    Ok((table(path, bytes, &mapping)?, mapping))
}

/// The recording in `bytes`, the content of a file called `path`; its format is told by the bytes.
///
/// # Errors
/// Like [`load`].
pub fn parse(path: &Path, bytes: Vec<u8>, mapping: &Mapping) -> Result<Loaded, DataError> {
    assemble::assemble(path, &*table(path, bytes, mapping)?, mapping)
}

/// The recording in named columns that are in memory already, called `name`: a row for every sample, and in a column no number
/// (NaN) where there is none.
///
/// ```
/// use aep_data::{Mapping, of_columns};
///
/// let samples = |f: fn(f64) -> f64| (0..200).map(|k| f(f64::from(k))).collect::<Vec<f64>>();
/// let columns = vec![
///     ("t_ms".to_owned(), samples(|k| k)),
///     ("force_N".to_owned(), samples(|k| (0.1 * k).sin())),
///     ("position_mm".to_owned(), samples(|k| (0.1 * k).cos())),
/// ];
/// let loaded = of_columns("table", columns, &Mapping::default())?;
/// assert_eq!(loaded.recording.require("position").unwrap()[0], 1e-3);
/// # Ok::<(), aep_data::DataError>(())
/// ```
///
/// Columns may be lent as slices: what nothing is read from is not copied.
///
/// # Errors
/// Like [`load`].
pub fn of_columns<'a>(
    name: &str,
    columns: Vec<(String, impl Into<Cow<'a, [f64]>>)>,
    mapping: &Mapping,
) -> Result<Loaded, DataError> {
    let name = Path::new(name);
    assemble::assemble(name, &memory_table::MemoryTable::new(name, columns)?, mapping)
}

/// The columns in `bytes`, the content of a file called `path`.
fn table(path: &Path, bytes: Vec<u8>, mapping: &Mapping) -> Result<Box<dyn Table>, DataError> {
    let named_mat = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mat"));
    if bytes.is_empty() {
        return Err(DataError::new(path, Problem::Empty));
    }
    if mcap_table::is_mcap(&bytes) {
        return Ok(Box::new(mcap_table::read(path, &bytes, mapping.topic.as_deref())?));
    }
    if mapping.topic.is_some() {
        return Err(DataError::new(path, Problem::NoTopics));
    }
    if mat_index::is_hdf5(&bytes) {
        return Ok(Box::new(hdf5_table::Hdf5Table::parse(path, bytes)?));
    }
    if mat_index::is_mat5(&bytes) {
        return Ok(Box::new(MatTable::parse(path, bytes)?));
    }
    if named_mat {
        return Err(DataError::new(path, Problem::NotMat));
    }
    if parquet_table::is_parquet(&bytes) {
        return Ok(Box::new(parquet_table::read(path, bytes)?));
    }
    if npz::is_npz(&bytes) {
        return Ok(Box::new(npz::read(path, &bytes)?));
    }
    let bytes = if sheet::is_xlsx(&bytes) { sheet::as_text(path, &bytes)? } else { bytes };
    let bytes = text::decoded(&bytes).map_err(|problem| DataError::new(path, problem))?;
    let table = match text::head(&bytes) {
        Some(head) => CsvTable::parse(path, &head.bytes)?.with_units(&head.units),
        None => CsvTable::parse(path, &bytes)?,
    };
    Ok(Box::new(table))
}

fn unreadable(error: &std::io::Error) -> Problem {
    match error.kind() {
        std::io::ErrorKind::NotFound => Problem::Absent,
        _ => Problem::Unreadable { message: error.to_string() },
    }
}

/// Endings of files that are read.
const FORMATS: [&str; 7] = ["csv", "mat", "parquet", "npz", "xlsx", "h5", "mcap"];

/// The files of a folder that could be recordings, sorted.
fn data_files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let is_data = |path: &std::path::PathBuf| {
        path.extension().is_some_and(|ending| FORMATS.iter().any(|format| ending == *format))
    };
    let mut files: Vec<String> =
        paths.filter(is_data).map(|path| path.display().to_string()).collect();
    files.sort();
    files
}

/// The examples of the README, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
