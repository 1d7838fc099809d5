//! How a residual resembles itself some steps later, over a grid that has gaps.

use std::ops::Range;

use crate::statistics::basis::dot;

/// A step of time beyond this multiple of the usual one is a gap.
const GAP: f64 = 1.5;

/// The contiguous pieces of a grid of increasing times; between pieces the grid leaves something out.
pub fn pieces(time: &[f64]) -> Vec<Range<usize>> {
    if time.is_empty() {
        return Vec::new();
    }
    let usual = interval(time);
    let mut pieces = Vec::new();
    let mut start = 0;
    for k in 1..time.len() {
        let step = time[k] - time[k - 1];
        // False for NaN and for times that run back to a new segment.
        if !(step > 0.0 && step <= GAP * usual) {
            pieces.push(start..k);
            start = k;
        }
    }
    pieces.push(start..time.len());
    pieces
}

/// The median step of a grid; 0 where there is none.
pub fn interval(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Sum of `a[t] b[t + lag]` over the points of each piece that have a partner in it, and their number.
/// A negative lag takes `b` from the past.
pub fn lagged(a: &[f64], b: &[f64], pieces: &[Range<usize>], lag: isize) -> (f64, usize) {
    let shift = lag.unsigned_abs();
    let (mut sum, mut count) = (0.0, 0);
    for piece in pieces.iter().filter(|piece| piece.len() > shift) {
        let (early, late) = (piece.start..piece.end - shift, piece.start + shift..piece.end);
        let (of_a, of_b) = if lag >= 0 { (early, late) } else { (late, early) };
        count += of_a.len();
        sum += dot(&a[of_a], &b[of_b]);
    }
    (sum, count)
}

/// `values` less their mean.
pub fn centred(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter().map(|value| value - mean).collect()
}

/// Autocorrelation at the lags 0 (where it is 1) to `most`; all 0 where the values are constant.
pub fn autocorrelation(values: &[f64], pieces: &[Range<usize>], most: usize) -> Vec<f64> {
    let centred = centred(values);
    let square = dot(&centred, &centred);
    let at = |lag: usize| {
        if square <= 0.0 {
            return 0.0;
        }
        // The biased estimate: its sequence stays positive definite.
        lagged(&centred, &centred, pieces, lag as isize).0 / square
    };
    (0..=most).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_and_new_segments_end_a_piece() {
        let mut time: Vec<f64> = (0..10).map(f64::from).collect();
        time.extend((20..25).map(f64::from));
        time.extend((0..4).map(f64::from));
        assert_eq!(pieces(&time), vec![0..10, 10..15, 15..19]);
        assert!(pieces(&[]).is_empty());
    }

    #[test]
    fn a_square_wave_is_its_own_opposite_half_a_period_later() {
        let wave: Vec<f64> = (0..400).map(|k| if k % 20 < 10 { 1.0 } else { -1.0 }).collect();
        let rho = autocorrelation(&wave, std::slice::from_ref(&(0..400)), 20);
        assert!((rho[0] - 1.0).abs() < 1e-12 && rho[10] < -0.95 && rho[20] > 0.9);
        assert!(
            autocorrelation(&[2.0; 50], std::slice::from_ref(&(0..50)), 3)
                .iter()
                .all(|r| *r == 0.0)
        );
    }

    #[test]
    fn a_lag_looks_forward_and_backward() {
        let (a, b) = ([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]);
        let whole = std::slice::from_ref(&(0..4));
        assert_eq!(lagged(&a, &b, whole, 2), (1.0, 2));
        assert_eq!(lagged(&b, &a, whole, -2), (1.0, 2));
        assert_eq!(lagged(&a, &b, whole, -2), (0.0, 2));
    }
}
