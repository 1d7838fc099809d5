//! Arrays of Python, `.npz`: a ZIP archive of arrays; every vector is a column, every column of a matrix one more.

use std::io::{Cursor, Read};
use std::path::Path;

use zip::ZipArchive;

use crate::error::{DataError, Problem};
use crate::memory_table::MemoryTable;

/// Most bytes of an array: an archive can claim any size.
const MOST_BYTES: u64 = 1 << 33;
/// Most columns of a matrix that become columns of their own.
const MOST_COLUMNS: usize = 64;

/// Whether these are the bytes of a `.npz`: a ZIP archive with arrays.
pub(crate) fn is_npz(bytes: &[u8]) -> bool {
    let Ok(archive) = ZipArchive::new(Cursor::new(bytes)) else { return false };
    archive.file_names().flatten().any(|name| name.ends_with(".npy"))
}

/// The arrays as columns.
pub(crate) fn read(path: &Path, bytes: &[u8]) -> Result<MemoryTable<'static>, DataError> {
    let damaged =
        |what: String| DataError::new(path, Problem::Damaged { format: "NumPy archive", what });
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|e| damaged(e.to_string()))?;
    let mut columns = Vec::new();
    for index in 0..archive.len() {
        let file = archive.by_index(index).map_err(|e| damaged(e.to_string()))?;
        let name = file.name().map_err(|e| damaged(e.to_string()))?.into_owned();
        let Some(name) = name.strip_suffix(".npy").map(str::to_owned) else { continue };
        let mut array = Vec::new();
        file.take(MOST_BYTES)
            .read_to_end(&mut array)
            .map_err(|e| damaged(format!("'{name}': {e}")))?;
        let found = array_of(&array).map_err(|what| damaged(format!("'{name}' {what}")))?;
        columns.extend(found.into_iter().flatten().enumerate().map(|(k, values)| {
            (if k == 0 && values.1 == 1 { name.clone() } else { format!("{name}_{k}") }, values.0)
        }));
    }
    MemoryTable::new(path, columns)
}

/// Columns of an array with how many there are; nothing where it holds no numbers or has too many dimensions.
type Columns = Option<Vec<(Vec<f64>, usize)>>;

fn array_of(bytes: &[u8]) -> Result<Columns, String> {
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or("is no array")?;
    let (version, rest) = rest.split_at_checked(2).ok_or("is cut off")?;
    let wide = version[0] >= 2;
    let (length, rest) = rest.split_at_checked(if wide { 4 } else { 2 }).ok_or("is cut off")?;
    let length = length.iter().rev().fold(0usize, |sum, byte| sum << 8 | usize::from(*byte));
    let (header, data) = rest.split_at_checked(length).ok_or("is cut off")?;
    let header = std::str::from_utf8(header).map_err(|_| "has no header")?;
    let entry = |key: &str| {
        let after = header.split_once(&format!("'{key}':"))?.1.trim_start();
        Some(after)
    };
    let descr = entry("descr").and_then(|text| text.strip_prefix('\'')?.split('\'').next());
    // A structured array has a list there.
    let Some(descr) = descr else { return Ok(None) };
    let fortran = entry("fortran_order").is_some_and(|text| text.starts_with("True"));
    let shape = entry("shape").and_then(|text| text.strip_prefix('(')?.split(')').next());
    let shape = shape.ok_or("has no shape")?;
    let sizes: Result<Vec<usize>, _> =
        shape.split(',').map(str::trim).filter(|size| !size.is_empty()).map(str::parse).collect();
    let sizes = sizes.map_err(|_| "has no shape")?;
    let (rows, columns) = match sizes.as_slice() {
        [] => (1, 1),
        [rows] => (*rows, 1),
        [1, columns] => (*columns, 1),
        [rows, columns] if *columns <= MOST_COLUMNS => (*rows, *columns),
        _ => return Ok(None),
    };
    let Some((width, number)) = reader(descr) else { return Ok(None) };
    let count = rows.checked_mul(columns).ok_or("is too large")?;
    if data.len() / width < count {
        return Err("is cut off".to_owned());
    }
    let at = |index: usize| number(&data[index * width..(index + 1) * width]);
    let column = |c: usize| {
        let index = |r: usize| if fortran { c * rows + r } else { r * columns + c };
        ((0..rows).map(|r| at(index(r))).collect(), columns)
    };
    Ok(Some((0..columns).map(column).collect()))
}

/// How many bytes a number has, and how it is read.
type Number = (usize, fn(&[u8]) -> f64);

/// How numbers of a type are read.
#[expect(clippy::cast_lossless, reason = "one macro for all widths")]
fn reader(descr: &str) -> Option<Number> {
    macro_rules! read {
        ($kind:ty, $from:ident) => {
            (size_of::<$kind>(), |bytes: &[u8]| {
                let mut own = [0; size_of::<$kind>()];
                own.copy_from_slice(bytes);
                <$kind>::$from(own) as f64
            })
        };
    }
    Some(match descr {
        "<f8" => read!(f64, from_le_bytes),
        ">f8" => read!(f64, from_be_bytes),
        "<f4" => read!(f32, from_le_bytes),
        ">f4" => read!(f32, from_be_bytes),
        "<i8" => read!(i64, from_le_bytes),
        "<i4" => read!(i32, from_le_bytes),
        "<i2" => read!(i16, from_le_bytes),
        "|i1" => read!(i8, from_le_bytes),
        "<u8" => read!(u64, from_le_bytes),
        "<u4" => read!(u32, from_le_bytes),
        "<u2" => read!(u16, from_le_bytes),
        "|u1" | "|b1" => read!(u8, from_le_bytes),
        _ => return None,
    })
}
