//! Spreadsheets (`.xlsx`): the first sheet with numbers, read like a CSV.

use std::fmt::Write;
use std::io::Cursor;
use std::path::Path;

use calamine::{Data, Reader, Xlsx};

use crate::error::{DataError, Problem};

/// Whether these bytes may be a spreadsheet: a ZIP archive with a workbook.
pub(crate) fn is_xlsx(bytes: &[u8]) -> bool {
    let archive = zip::ZipArchive::new(Cursor::new(bytes));
    archive
        .is_ok_and(|archive| archive.file_names().flatten().any(|name| name == "xl/workbook.xml"))
}

/// The first sheet that has numbers, as text with tabs between the cells; its lines are the rows of the sheet.
pub(crate) fn as_text(path: &Path, bytes: &[u8]) -> Result<Vec<u8>, DataError> {
    let damaged =
        |what: String| DataError::new(path, Problem::Damaged { format: "spreadsheet", what });
    let mut book = Xlsx::new(Cursor::new(bytes)).map_err(|error| damaged(error.to_string()))?;
    for name in book.sheet_names() {
        let range = book.worksheet_range(&name).map_err(|error| damaged(error.to_string()))?;
        let is_number = |cell: &Data| matches!(cell, Data::Float(_) | Data::Int(_));
        if !range.rows().flatten().any(is_number) {
            continue;
        }
        let mut text = "\n".repeat(range.start().map_or(0, |(row, _)| row as usize));
        for row in range.rows() {
            for (k, cell) in row.iter().enumerate() {
                if k > 0 {
                    text.push('\t');
                }
                // Writing to a string cannot fail.
                let _ = match cell {
                    Data::Empty => Ok(()),
                    // As many digits as give the same number again.
                    Data::Float(number) => write!(text, "{number}"),
                    Data::Int(number) => write!(text, "{number}"),
                    Data::Bool(yes) => write!(text, "{}", u8::from(*yes)),
                    other => write!(text, "{}", other.to_string().replace(['\t', '\n', '\r'], " ")),
                };
            }
            text.push('\n');
        }
        return Ok(text.into_bytes());
    }
    Err(DataError::new(path, Problem::Empty))
}
