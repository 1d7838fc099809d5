//! Numbers with their unit, as people write them: `8.2 N`, `1.1 mm/s`, `0.30 µm`.

/// `value` in `unit` with three significant digits and the prefix that fits.
///
/// Prefixes go to the simple units (`m`, `s`, `N`, `Nm`, `rad`, `m/s`, `rad/s`, ...); compounds such as
/// `N s/m` keep theirs.
///
/// ```
/// use missing_physics::measurement::quantity::quantity;
/// assert_eq!(quantity(0.0011, "m/s"), "1.10 mm/s");
/// assert_eq!(quantity(203.5, "N s/m"), "204 N s/m");
/// assert_eq!(quantity(5e-8, "m"), "50.0 nm");
/// ```
pub fn quantity(value: f64, unit: &str) -> String {
    if unit.is_empty() || unit == "1" {
        return number(value);
    }
    let (factor, prefix) = prefix(value, unit);
    format!("{} {prefix}{unit}", number(value * factor))
}

/// `value` with three significant digits: `0.00123`, `12.3`, `1230`, `1.23e7`.
pub fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !size.is_finite() {
        return value.to_string();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.2e}");
    }
    // 9.996 is 10.0, not 10.00: the digits count after rounding.
    let exponent = format!("{size:.2e}").split_once('e').and_then(|(_, e)| e.parse::<i32>().ok());
    let decimals = (2 - exponent.unwrap_or(0)).max(0) as usize;
    format!("{value:.decimals$}")
}

/// `share`, a fraction, in per cent.
pub fn percent(share: f64) -> String {
    let value = 100.0 * share;
    let decimals = if value.abs() < 9.95 && value != 0.0 { 2 } else { 1 };
    format!("{value:.decimals$} %")
}

fn prefix(value: f64, unit: &str) -> (f64, &'static str) {
    const SIMPLE: &[&str] = &["m", "s", "N", "Nm", "N/m", "rad", "m/s", "rad/s", "m/s²", "rad/s²"];
    let size = value.abs();
    if size == 0.0 || !SIMPLE.contains(&unit) {
        return (1.0, "");
    }
    match size {
        _ if size < 0.999_5e-6 => (1e9, "n"),
        _ if size < 0.999_5e-3 => (1e6, "µ"),
        // Forces are read in newtons, seconds in seconds: 0.29 N, not 290 mN.
        _ if size < 0.1 || (size < 0.999_5 && unit.starts_with('m')) => (1e3, "m"),
        _ if size >= 1e6 && unit.starts_with('N') => (1e-6, "M"),
        _ if size >= 1e4 && unit.starts_with('N') => (1e-3, "k"),
        _ => (1.0, ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_whatever_the_size() {
        for (value, text) in [
            (0.0, "0"),
            (9.996, "10.0"),
            (0.12345, "0.123"),
            (-12.345, "-12.3"),
            (123_456.0, "123456"),
            (1.234e7, "1.23e7"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn prefixes_fit_the_size() {
        for (value, unit, text) in [
            (0.29, "N", "0.290 N"),
            (0.042, "m/s", "42.0 mm/s"),
            (0.2, "m", "200 mm"),
            (2.5, "s", "2.50 s"),
            (0.001, "s", "1.00 ms"),
            (3e-6, "m", "3.00 µm"),
            (15_000.0, "N", "15.0 kN"),
            (7.03e6, "N/m", "7.03 MN/m"),
            (0.0012, "m/s", "1.20 mm/s"),
            (95.1, "kg", "95.1 kg"),
            (-3.16, "N", "-3.16 N"),
            (0.0, "N", "0 N"),
            (3e-4, "s", "300 µs"),
            (1e-7, "m", "100 nm"),
            (0.05, "", "0.0500"),
        ] {
            assert_eq!(quantity(value, unit), text);
        }
    }

    #[test]
    fn shares_have_two_or_three_digits() {
        assert_eq!(percent(0.04083), "4.08 %");
        assert_eq!(percent(0.5), "50.0 %");
        assert_eq!(percent(0.0), "0.0 %");
    }
}
