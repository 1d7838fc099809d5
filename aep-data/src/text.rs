//! Text as programs write it: UTF-16, lines before the header, a row of units below it.

use std::borrow::Cow;

use crate::error::Problem;
use crate::{stamp, unit};

/// Lines in which a header is looked for.
const MOST_LINES: usize = 100;

/// UTF-16 with its byte-order mark as UTF-8; anything else as it is.
pub(crate) fn decoded(bytes: &[u8]) -> Result<Cow<'_, [u8]>, Problem> {
    let read: fn([u8; 2]) -> u16 = match bytes {
        [0xff, 0xfe, ..] => u16::from_le_bytes,
        [0xfe, 0xff, ..] => u16::from_be_bytes,
        _ => return Ok(bytes.into()),
    };
    let units = bytes[2..].chunks_exact(2).map(|pair| read([pair[0], pair[1]]));
    let text: Result<String, _> = char::decode_utf16(units).collect();
    match text {
        Ok(text) if bytes.len().is_multiple_of(2) => Ok(text.into_bytes().into()),
        _ => Err(Problem::NotText { what: "it begins as UTF-16, but is none" }),
    }
}

/// What is known of the lines above the numbers.
pub(crate) struct Head {
    /// The text; lines before the header are empty, so that all lines keep their numbers.
    pub bytes: Vec<u8>,
    /// Units below the header, one a column; empty where there is no such row.
    pub units: Vec<String>,
}

/// Finds lines before the header and a row of units; nothing where there is neither.
///
/// Numbers begin at the first line of which all fields are numbers. The header is the line above them with as many
/// fields; a row of which each field is a unit may stand between.
pub(crate) fn head(bytes: &[u8]) -> Option<Head> {
    let text = std::str::from_utf8(bytes).ok()?;
    let lines: Vec<&str> = text.split_inclusive('\n').take(MOST_LINES).collect();
    let is_text =
        |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with(['#', '%']);
    let first = lines.iter().position(is_text)?;
    let numbers = lines.iter().position(|line| is_text(line) && fields(line).is_some())?;
    let (_, delimiter) = fields(lines[numbers])?;
    let count = lines[numbers].trim().split(delimiter).count();
    let matches = |k: &usize| is_text(&lines[*k]) && split(lines[*k], delimiter).len() == count;
    let mut above = (first..numbers).rev().filter(matches);
    let mut header = above.next()?;
    // A row with a number in it is a broken row, no header.
    let is_name = |field: &&str| field.parse::<f64>().is_err();
    if !split(lines[header], delimiter).iter().all(is_name) {
        return None;
    }
    let mut units = Vec::new();
    let row = split(lines[header], delimiter);
    if row.iter().all(|field| is_unit(field))
        && row.iter().any(|field| !field.is_empty())
        && let Some(names) = above.next()
    {
        units = row.iter().map(|field| bare(field).to_owned()).collect();
        header = names;
    }
    if header == first && units.is_empty() {
        return None;
    }
    let mut kept = String::with_capacity(text.len());
    for (k, line) in lines.iter().enumerate() {
        let is_units = !units.is_empty() && (header + 1..numbers).contains(&k);
        if k < header || is_units {
            kept.push('\n');
        } else {
            kept.push_str(line);
        }
    }
    kept.push_str(&text[lines.iter().map(|line| line.len()).sum()..]);
    Some(Head { bytes: kept.into_bytes(), units })
}

/// The number of fields of a line of numbers and what separates them; nothing where one is no number.
fn fields(line: &str) -> Option<(usize, char)> {
    [';', '\t', ','].into_iter().find_map(|delimiter| {
        let fields = split(line, delimiter);
        let is_number = |field: &&str| {
            let point = field.replacen(',', ".", 1);
            field.parse::<f64>().is_ok()
                || stamp::nanoseconds(field).is_some()
                || (delimiter != ',' && point.parse::<f64>().is_ok())
        };
        (fields.len() > 1 && fields.iter().all(is_number)).then_some((fields.len(), delimiter))
    })
}

fn split(line: &str, delimiter: char) -> Vec<&str> {
    line.trim_end_matches(['\r', '\n'])
        .split(delimiter)
        .map(|f| f.trim().trim_matches('"'))
        .collect()
}

/// `N`, `[N]`, `(N)`, nothing, or a dash.
fn is_unit(field: &str) -> bool {
    let bare = bare(field);
    bare.is_empty() || bare == "-" || unit::find(bare).is_some()
}

fn bare(field: &str) -> &str {
    let within = |open, close| field.strip_prefix(open).and_then(|f| f.strip_suffix(close));
    within('[', ']').or_else(|| within('(', ')')).unwrap_or(field).trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn utf_16_of_either_order_is_read() {
        let text = "t_s;µ\n1;2\n";
        let little: Vec<u8> =
            std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> =
            std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect();
        assert_eq!(decoded(&little).unwrap(), text.as_bytes());
        assert_eq!(decoded(&big).unwrap(), text.as_bytes());
        assert!(decoded(&little[..little.len() - 1]).is_err());
        assert!(decoded(b"\xff\xfe\x00\xd8").is_err());
        assert_eq!(decoded(b"abc").unwrap(), b"abc".as_slice());
    }

    #[test]
    fn lines_before_the_header_go_and_numbers_of_lines_stay() {
        let text = "Recorder: X\nDate;2026-01-01\n\ntime;force\ns;N\n0;1\n1;2\n";
        let head = head(text.as_bytes()).unwrap();
        assert_eq!(head.units, ["s", "N"]);
        assert_eq!(head.bytes, b"\n\n\ntime;force\n\n0;1\n1;2\n");
    }

    #[test]
    fn a_plain_file_stays_as_it_is() {
        for text in [
            "t,f\n0,abc\n1,2\n",
            "t,f\n0,1\n",
            "# a comment\nt,f\n0,1\n",
            "t,f\n",
            "0,1\n1,2\n",
            "t;f\n0,5;1,5\n",
            "f\n1\n2\n",
        ] {
            assert!(head(text.as_bytes()).is_none(), "{text}");
        }
        // Names that are units are names where nothing stands above them.
        assert!(head(b"s,N\n0,1\n").is_none());
    }
}
