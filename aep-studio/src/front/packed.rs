//! Numbers as text that a page can unpack at once.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// Code of a value that is not known.
const UNKNOWN: u16 = u16::MAX;

/// A series in 65,535 steps between its extremes, finer than any screen: `{low, step, codes}` with 16-bit numbers,
/// least significant byte first, in base 64. What is no number is the highest code.
pub(super) fn steps(values: impl Iterator<Item = f64> + Clone) -> Value {
    let finite = values.clone().filter(|value| value.is_finite());
    let (low, high) =
        finite.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
    let step = if high > low { (high - low) / f64::from(UNKNOWN - 1) } else { 0.0 };
    let low = if low == f64::MAX { 0.0 } else { low };
    let code = |value: f64| match () {
        () if !value.is_finite() => UNKNOWN,
        () if step == 0.0 => 0,
        () => (((value - low) / step).round() as u16).min(UNKNOWN - 1),
    };
    let bytes: Vec<u8> = values.flat_map(|value| code(value).to_le_bytes()).collect();
    json!({"low": low, "step": step, "codes": STANDARD.encode(bytes)})
}

/// Numbers of 32 bits, least significant byte first, in base 64.
pub(crate) fn floats(values: &[f64]) -> String {
    STANDARD
        .encode(values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect::<Vec<u8>>())
}

/// Numbers of 64 bits, least significant byte first, in base 64.
pub(super) fn doubles(values: impl Iterator<Item = f64>) -> String {
    STANDARD.encode(values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

/// Equal neighbours as pairs of value and number.
pub(super) fn runs(values: impl Iterator<Item = i64>) -> Vec<(i64, usize)> {
    let mut runs: Vec<(i64, usize)> = Vec::new();
    for value in values {
        match runs.last_mut() {
            Some((same, count)) if *same == value => *count += 1,
            _ => runs.push((value, 1)),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_comes_back_within_half_a_step() {
        let values = [-2.0, f64::NAN, 0.31, 5.0];
        let packed = steps(values.iter().copied());
        let (low, step) = (packed["low"].as_f64().unwrap(), packed["step"].as_f64().unwrap());
        let bytes = STANDARD.decode(packed["codes"].as_str().unwrap()).unwrap();
        let codes: Vec<u16> = bytes.chunks(2).map(|b| u16::from_le_bytes([b[0], b[1]])).collect();
        assert_eq!(codes[1], UNKNOWN);
        for k in [0, 2, 3] {
            assert!((low + step * f64::from(codes[k]) - values[k]).abs() <= 0.5 * step);
        }
        let constant = steps([3.0, 3.0].into_iter());
        assert_eq!((constant["low"].as_f64(), constant["step"].as_f64()), (Some(3.0), Some(0.0)));
        let nothing = steps([f64::NAN].into_iter());
        assert_eq!(nothing["low"].as_f64(), Some(0.0));
    }

    #[test]
    fn equal_neighbours_are_counted() {
        assert_eq!(runs([1, 1, -1, 1].into_iter()), [(1, 2), (-1, 1), (1, 1)]);
    }
}
