//! Time stamps as text: ISO 8601 and what is near to it.

use chrono::{DateTime, NaiveDateTime};

/// Forms without a zone; all stamps of a file then are of one clock.
const FORMS: [&str; 4] =
    ["%Y-%m-%dT%H:%M:%S%.f", "%Y-%m-%d %H:%M:%S%.f", "%Y/%m/%d %H:%M:%S%.f", "%Y%m%dT%H%M%S%.f"];

/// Nanoseconds from 1970 on of a stamp: `2026-03-01T10:00:00.001`, with `Z` or `+01:00`, a blank in place of the `T`,
/// and a decimal comma.
pub(crate) fn nanoseconds(text: &str) -> Option<i64> {
    // Numbers are the usual case and must not cost much.
    let looks_so = text.len() >= 15 && text.as_bytes()[..4].iter().all(u8::is_ascii_digit);
    if !looks_so || text.parse::<f64>().is_ok() {
        return None;
    }
    let text = text.replacen(',', ".", 1);
    if let Ok(stamp) = DateTime::parse_from_rfc3339(&text) {
        return stamp.timestamp_nanos_opt();
    }
    let without = FORMS.iter().find_map(|form| NaiveDateTime::parse_from_str(&text, form).ok());
    without?.and_utc().timestamp_nanos_opt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_is_read_to_the_nanosecond_in_the_forms_that_recorders_write() {
        let start = nanoseconds("2026-03-01T10:00:00Z").unwrap();
        for text in [
            "2026-03-01T10:00:00.000000001Z",
            "2026-03-01T11:00:00.000000001+01:00",
            "2026-03-01 10:00:00.000000001",
            "2026-03-01T10:00:00,000000001",
            "2026/03/01 10:00:00.000000001",
            "20260301T100000.000000001",
        ] {
            assert_eq!(nanoseconds(text), Some(start + 1), "{text}");
        }
        for text in ["1772359200.25", "0.001", "", "2026-13-01T10:00:00", "2026-03-01", "abc"] {
            assert_eq!(nanoseconds(text), None, "{text}");
        }
    }
}
