//! Clipping: a spike of the histogram at an extreme value.

use serde::{Deserialize, Serialize};

/// A limit that a channel is held at.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saturation {
    /// The limit, in the channel's unit.
    pub level: f64,
    /// Share of the samples that are held there, 0..1.
    pub share: f64,
}

/// Share of the samples at the extreme below which it is no spike.
const SHARE: f64 = 0.005;
/// How many times more samples than in a neighbouring slice of the histogram make a spike.
const SPIKE: f64 = 5.0;
/// Width of a slice, as a share of the channel's span.
const SLICE: f64 = 0.01;

impl Saturation {
    pub(super) fn of(values: &[f64], quantum: Option<f64>) -> Vec<Self> {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let span = high - low;
        // Finite and not constant.
        if !(span > 0.0 && span < f64::INFINITY) {
            return Vec::new();
        }
        let width = (SLICE * span).max(quantum.unwrap_or(0.0) * 1.5);
        let distances = |level: f64| values.iter().map(move |value| (value - level).abs());
        [low, high].into_iter().filter_map(|level| spike(level, distances(level), width)).collect()
    }
}

/// The spike at `level`, where nearly all of the first slice lies exactly on it and the next slices
/// hold far less.
fn spike(level: f64, distances: impl Iterator<Item = f64>, width: f64) -> Option<Saturation> {
    let (mut on, mut first, mut beyond, mut samples) = (0_u32, 0_u32, 0_u32, 0_u32);
    for distance in distances {
        samples += 1;
        on += u32::from(distance < width * 1e-3);
        first += u32::from(distance < width);
        beyond += u32::from((width..6.0 * width).contains(&distance));
    }
    let share = f64::from(on) / f64::from(samples);
    let mean_beyond = f64::from(beyond) / 5.0;
    let mostly_on = f64::from(on) > 0.5 * f64::from(first);
    let is_spike = share > SHARE && mostly_on && f64::from(on) > SPIKE * mean_beyond;
    is_spike.then_some(Saturation { level, share })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(samples: usize) -> Vec<f64> {
        (0..samples).map(|k| 10.0 * (k as f64 * 0.01).sin()).collect()
    }

    #[test]
    fn a_clipped_sine_is_noticed_on_the_clipped_side() {
        let values: Vec<f64> = sine(5000).into_iter().map(|value| value.min(8.0)).collect();
        let found = Saturation::of(&values, None);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].level, 8.0);
        assert!((found[0].share - 0.205).abs() < 0.02, "{}", found[0].share);
    }

    #[test]
    fn a_whole_sine_dwells_at_its_peaks_but_is_not_clipped() {
        assert!(Saturation::of(&sine(5000), None).is_empty());
        let counted: Vec<f64> =
            sine(5000).iter().map(|value| (value / 0.3).round() * 0.3).collect();
        assert!(Saturation::of(&counted, Some(0.3)).is_empty());
    }
}
