//! HDF5: MATLAB files of version 7.3, and plain files as `h5py` writes them. Every numeric vector is a column, every
//! column of a matrix one more; fields of structures and members of groups are called `run.q`.

use std::path::{Path, PathBuf};

use hdf5_pure::{AttrValue, DType, Dataset, File, Group};

use crate::error::{DataError, Problem};
use crate::table::{Column, Table, nearest};

/// Most columns of a matrix that become columns of their own.
const MOST_COLUMNS: u64 = 64;
/// Most values that a byte of a file can stand for: what deflate makes of one value of a byte, repeated.
const DENSEST: u64 = 1032;
/// Most levels of groups within groups.
const DEEPEST: usize = 8;

/// An opened HDF5 file.
pub(crate) struct Hdf5Table {
    path: PathBuf,
    file: File,
    entries: Vec<Entry>,
    /// What is there but is no vector of numbers, in words.
    others: Vec<String>,
}

/// A column, and where it stands.
struct Entry {
    name: String,
    dataset: String,
    /// Rows, columns, number of this one.
    place: (usize, usize, usize),
    /// Whether values of a column follow one another, as MATLAB keeps them.
    by_columns: bool,
}

impl Hdf5Table {
    /// Lists the datasets in `bytes`, the content of `path`.
    pub fn parse(path: &Path, bytes: Vec<u8>) -> Result<Self, DataError> {
        let damaged =
            |what: String| DataError::new(path, Problem::Damaged { format: "HDF5 file", what });
        let most = DENSEST * bytes.len() as u64;
        let file = File::from_bytes(bytes).map_err(|error| damaged(error.to_string()))?;
        let (mut entries, mut others) = (Vec::new(), Vec::new());
        list(&file.root(), ("", 0), most, &mut entries, &mut others)
            .map_err(|error| damaged(error.to_string()))?;
        without_common_group(&mut entries);
        Ok(Self { path: path.to_owned(), file, entries, others })
    }
}

/// Where all columns are in one structure, its name tells nothing.
fn without_common_group(entries: &mut [Entry]) {
    let Some((first, _)) = entries.first().and_then(|entry| entry.name.rsplit_once('.')) else {
        return;
    };
    let prefix = format!("{first}.");
    if entries.iter().all(|entry| entry.name.starts_with(&prefix)) {
        for entry in entries {
            entry.name = entry.name[prefix.len()..].to_owned();
        }
    }
}

fn list(
    group: &Group,
    (prefix, depth): (&str, usize),
    most: u64,
    entries: &mut Vec<Entry>,
    others: &mut Vec<String>,
) -> Result<(), hdf5_pure::Error> {
    for name in group.datasets()? {
        let full = format!("{prefix}{name}");
        let dataset = group.dataset(&name)?;
        match shape(&dataset, most) {
            Ok((rows, columns, by_columns)) => {
                for k in 0..columns {
                    let own = if columns == 1 { full.clone() } else { format!("{full}_{k}") };
                    entries.push(Entry {
                        name: own.replace('/', "."),
                        dataset: full.clone(),
                        place: (rows, columns, k),
                        by_columns,
                    });
                }
            }
            Err(what) => others.push(format!("{} ({what})", full.replace('/', "."))),
        }
    }
    for name in group.groups()? {
        // MATLAB keeps what cells and objects refer to in groups of its own.
        if !name.starts_with('#') && depth < DEEPEST {
            let prefix = format!("{prefix}{name}/");
            list(&group.group(&name)?, (&prefix, depth + 1), most, entries, others)?;
        }
    }
    Ok(())
}

/// Rows and columns of a dataset of at most so many values, and whether values of a column follow one another; else what it
/// is.
fn shape(dataset: &Dataset, most: u64) -> Result<(usize, usize, bool), String> {
    let unreadable = |error: hdf5_pure::Error| error.to_string();
    let class = match dataset.attrs().map_err(unreadable)?.get("MATLAB_class") {
        Some(AttrValue::AsciiString(class) | AttrValue::String(class)) => Some(class.clone()),
        Some(_) => Some(String::new()),
        None => None,
    };
    match class.as_deref() {
        Some("char") => return Err("text".to_owned()),
        Some("cell") => return Err("cell array".to_owned()),
        Some(class) if !is_numeric(class) => return Err(format!("{class}, an object of MATLAB")),
        _ => {}
    }
    let is_number = matches!(
        dataset.dtype().map_err(unreadable)?,
        DType::F32
            | DType::F64
            | DType::I8
            | DType::I16
            | DType::I32
            | DType::I64
            | DType::U8
            | DType::U16
            | DType::U32
            | DType::U64
    );
    if !is_number {
        return Err("no numbers".to_owned());
    }
    let sizes = dataset.shape().map_err(unreadable)?;
    let (rows, columns) = match (sizes.as_slice(), class.is_some()) {
        ([] | [1] | [1, 1], _) => (1, 1),
        ([rows] | [1, rows] | [rows, 1], _) => (*rows, 1),
        // MATLAB writes the last dimension first.
        ([columns, rows], true) | ([rows, columns], false) if *columns <= MOST_COLUMNS => {
            (*rows, *columns)
        }
        (sizes, _) => {
            let sizes: Vec<String> = sizes.iter().map(u64::to_string).collect();
            return Err(sizes.join(" x "));
        }
    };
    // What is told is reserved before it is read.
    if rows.checked_mul(columns).is_none_or(|values| values > most) {
        return Err(format!("damaged: {rows} x {columns} values, more than its file can hold"));
    }
    Ok((rows as usize, columns as usize, class.is_some()))
}

fn is_numeric(class: &str) -> bool {
    matches!(class, "double" | "single" | "logical")
        || class.starts_with("int")
        || class.starts_with("uint")
}

impl Table for Hdf5Table {
    fn names(&self) -> Vec<String> {
        self.entries.iter().map(|entry| entry.name.clone()).collect()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let fail = |problem| DataError::new(&self.path, problem);
        let found = self.entries.iter().find(|entry| entry.name == name);
        let entry = found.ok_or_else(|| fail(self.missing("variable", Some(name))))?;
        let all = self.file.dataset(&entry.dataset).and_then(|dataset| dataset.read_f64());
        let all = all.map_err(|error| {
            fail(Problem::Damaged { format: "HDF5 file", what: format!("'{name}': {error}") })
        })?;
        let (rows, columns, k) = entry.place;
        if all.len() != rows * columns {
            let what = format!("'{name}' is cut off");
            return Err(fail(Problem::Damaged { format: "HDF5 file", what }));
        }
        let values = match (columns, entry.by_columns) {
            (1, _) => all,
            (_, true) => all[k * rows..(k + 1) * rows].to_vec(),
            (_, false) => all.iter().skip(k).step_by(columns).copied().collect(),
        };
        Ok(Column { name: name.to_owned(), values, bad: None })
    }

    fn line(&self, _sample: usize) -> Option<u64> {
        None
    }

    fn missing(&self, role: &str, column: Option<&str>) -> Problem {
        let names = self.names();
        let nearest = nearest(column.unwrap_or(role), &names);
        Problem::MissingVariable {
            role: role.to_owned(),
            column: column.map(str::to_owned),
            present: names.into_iter().chain(self.others.iter().cloned()).collect(),
            nearest,
        }
    }
}
