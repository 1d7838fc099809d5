//! CSV: comma, semicolon or tab between the columns, comment lines, decimal commas.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use csv::{ByteRecord, ReaderBuilder, Trim};

use crate::error::{DataError, Problem};
use crate::header::Header;
use crate::table::{Bad, Column, Table, nearest};
use crate::{stamp, unit};

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A parsed CSV file.
pub(crate) struct CsvTable {
    path: PathBuf,
    columns: Vec<Column>,
    /// The first time stamp of each column that holds such, ns.
    stamps: Vec<Option<i64>>,
    lines: Lines,
}

/// The line of each sample: nearly always the one after that of the sample before.
#[derive(Default)]
struct Lines {
    samples: usize,
    /// Samples whose line is not the next one, and that line.
    jumps: Vec<(usize, u64)>,
}

impl Lines {
    fn of(&self, sample: usize) -> Option<u64> {
        let last = self.jumps.partition_point(|(begin, _)| *begin <= sample).checked_sub(1)?;
        let (begin, line) = self.jumps[last];
        (sample < self.samples).then_some(line + (sample - begin) as u64)
    }

    fn push(&mut self, line: u64) {
        let next = self.samples.checked_sub(1).and_then(|last| Some(self.of(last)? + 1));
        if next != Some(line) {
            self.jumps.push((self.samples, line));
        }
        self.samples += 1;
    }
}

impl CsvTable {
    /// Parses `bytes`, the content of `path`.
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, DataError> {
        let fail = |problem| DataError::new(path, problem);
        let bytes = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
        check_text(bytes).map_err(fail)?;
        let delimiter = delimiter(bytes).ok_or_else(|| fail(Problem::Empty))?;
        let mut reader = ReaderBuilder::new()
            .delimiter(delimiter)
            .comment(Some(comment(bytes)))
            .trim(Trim::All)
            .flexible(true)
            .from_reader(bytes);
        let header = reader.byte_headers().map_err(|error| fail(unreadable(&error)))?.clone();
        // As much as there will be: growing step by step takes up to twice that. A number and its separator take two bytes.
        let rows = bytes.split(|byte| *byte == b'\n').count();
        let rows = rows.min(bytes.len() / (2 * header.len().max(1)));
        let columns = columns(&header, rows);
        let stamps = vec![None; columns.len()];
        let mut table = Self { path: path.to_owned(), columns, stamps, lines: Lines::default() };
        table.check_header(header.position().map(csv::Position::line))?;
        let mut record = ByteRecord::new();
        while reader.read_byte_record(&mut record).map_err(|error| fail(unreadable(&error)))? {
            table.push(&record, delimiter)?;
        }
        if table.lines.samples == 0 {
            return Err(fail(Problem::HeaderOnly));
        }
        Ok(table)
    }

    /// The same with units that stand in a row of their own, for columns whose name says none.
    pub fn with_units(mut self, units: &[String]) -> Self {
        for (column, unit) in self.columns.iter_mut().zip(units) {
            let header = Header::parse(&column.name);
            if header.unit.is_none() && header.bracketed.is_none() && unit::find(unit).is_some() {
                column.name = format!("{} [{unit}]", column.name);
            }
        }
        self
    }

    fn check_header(&self, line: Option<u64>) -> Result<(), DataError> {
        let fail = |problem| Err(DataError::new(&self.path, problem).at_line(line));
        if self.columns.iter().all(|column| column.name.parse::<f64>().is_ok()) {
            return fail(Problem::NoHeader { columns: self.columns.len() });
        }
        let mut seen = BTreeSet::new();
        let twice = self.columns.iter().find(|c| !c.name.is_empty() && !seen.insert(&c.name));
        match twice {
            Some(column) => fail(Problem::DuplicateColumn { name: column.name.clone() }),
            None => Ok(()),
        }
    }

    fn push(&mut self, record: &ByteRecord, delimiter: u8) -> Result<(), DataError> {
        let line = record.position().map_or(0, csv::Position::line);
        let (fields, columns) = (record.len(), self.columns.len());
        // A separator at the end of each line is common and harmless.
        let surplus = (columns..fields).any(|index| !record[index].is_empty());
        if fields < columns || surplus {
            let problem = Problem::RaggedRow { fields: fields as u64, columns: columns as u64 };
            return Err(DataError::new(&self.path, problem).at_line(Some(line)));
        }
        let sample = self.lines.samples;
        self.lines.push(line);
        let columns = self.columns.iter_mut().zip(&mut self.stamps);
        for ((column, first), field) in columns.zip(record) {
            let value = number(field, delimiter).or_else(|| stamped(field, first, sample));
            if value.is_none() && column.bad.is_none() && !is_missing(field) {
                let text = String::from_utf8_lossy(field).into_owned();
                column.bad = Some(Bad { sample, text });
            }
            column.values.push(value.unwrap_or(f64::NAN));
        }
        Ok(())
    }
}

impl Table for CsvTable {
    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn column(&self, name: &str) -> Result<Column, DataError> {
        let found = self.columns.iter().position(|column| column.name == name);
        let found =
            found.ok_or_else(|| DataError::new(&self.path, self.missing("column", Some(name))))?;
        let mut column = self.columns[found].clone();
        let unit = Header::parse(name).unit;
        if let Some(unit) = unit.filter(|_| self.stamps[found].is_some()) {
            // Stamps are in seconds, whatever the name says.
            column.values.iter_mut().for_each(|value| *value /= unit.factor);
        }
        Ok(column)
    }

    fn line(&self, sample: usize) -> Option<u64> {
        self.lines.of(sample)
    }

    fn missing(&self, role: &str, column: Option<&str>) -> Problem {
        let present = self.names();
        let nearest = nearest(column.unwrap_or(role), &present);
        Problem::MissingColumn {
            role: role.to_owned(),
            column: column.map(str::to_owned),
            present,
            nearest,
        }
    }
}

fn columns(header: &ByteRecord, rows: usize) -> Vec<Column> {
    let names = header.iter().map(|name| String::from_utf8_lossy(name).into_owned());
    names.map(|name| Column { name, values: Vec::with_capacity(rows), bad: None }).collect()
}

fn check_text(bytes: &[u8]) -> Result<(), Problem> {
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Problem::Empty);
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Problem::NotText { what: "it is UTF-16" });
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return Err(Problem::NotText { what: "it is a ZIP archive or a spreadsheet" });
    }
    if bytes[..bytes.len().min(4096)].contains(&0) {
        return Err(Problem::NotText { what: "it holds zero bytes" });
    }
    Ok(())
}

fn first_line(bytes: &[u8]) -> Option<&[u8]> {
    let lines = bytes.split(|byte| matches!(byte, b'\n' | b'\r')).map(<[u8]>::trim_ascii);
    let mut lines = lines.filter(|line| !line.is_empty());
    lines.find(|line| !matches!(line[0], b'#' | b'%'))
}

/// What separates the columns: whatever occurs most often in the header.
fn delimiter(bytes: &[u8]) -> Option<u8> {
    let line = first_line(bytes)?;
    let count = |wanted: u8| line.split(|&byte| byte == wanted).count();
    [b'\t', b';', b','].into_iter().max_by_key(|&candidate| count(candidate))
}

/// Comments begin with `#`, or with `%` as MATLAB writes them.
fn comment(bytes: &[u8]) -> u8 {
    match bytes.trim_ascii_start().first() {
        Some(b'%') => b'%',
        _ => b'#',
    }
}

fn number(field: &[u8], delimiter: u8) -> Option<f64> {
    let text = std::str::from_utf8(field).ok()?.trim();
    let value = text.parse().ok().or_else(|| {
        let decimal_comma = delimiter != b',' && text.contains(',');
        decimal_comma.then(|| text.replacen(',', ".", 1).parse().ok()).flatten()
    })?;
    f64::is_finite(value).then_some(value)
}

/// A time stamp as seconds from the first one of its column on, which keeps all its digits.
fn stamped(field: &[u8], first: &mut Option<i64>, sample: usize) -> Option<f64> {
    // A column of stamps begins with one; nothing else pays for the look.
    if sample > 0 && first.is_none() {
        return None;
    }
    let now = stamp::nanoseconds(std::str::from_utf8(field).ok()?.trim())?;
    let start = *first.get_or_insert(now);
    Some((now - start) as f64 / 1e9)
}

/// Whether a field says that there is no number: empty, NaN, infinite, or a word for it.
fn is_missing(field: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(field) else { return false };
    let text = text.trim();
    let words = ["", "-", "na", "n/a", "#n/a", "null", "none", "missing"];
    words.iter().any(|word| text.eq_ignore_ascii_case(word))
        || text.parse::<f64>().is_ok_and(|value| !value.is_finite())
}

fn unreadable(error: &csv::Error) -> Problem {
    Problem::Unreadable { message: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_know_their_lines_where_some_lines_are_none() {
        let mut lines = Lines::default();
        for line in [3, 4, 7, 8, 9, 20] {
            lines.push(line);
        }
        let told: Vec<Option<u64>> = (0..7).map(|sample| lines.of(sample)).collect();
        assert_eq!(told, [Some(3), Some(4), Some(7), Some(8), Some(9), Some(20), None]);
        assert_eq!(lines.jumps.len(), 3);
    }
}
