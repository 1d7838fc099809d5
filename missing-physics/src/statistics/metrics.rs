//! How large an error is: absolute, relative, and as the two percentages that identification tools
//! print, on fitted and on held-out data.

use super::split::Split;
use crate::report::{Metrics, SplitMetrics};

/// Sums from which [`Metrics`] follow, so that blocks can be added up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    points: usize,
    error: f64,
    error_square: f64,
    measured: f64,
    measured_square: f64,
}

impl Sums {
    /// Adds points: the error and the measurement at each.
    pub fn add(&mut self, error: &[f64], measured: &[f64]) {
        for (e, y) in error.iter().zip(measured) {
            self.points += 1;
            self.error += e;
            self.error_square += e * e;
            self.measured += y;
            self.measured_square += y * y;
        }
    }

    /// Root mean square of the measurement.
    pub fn size(&self) -> f64 {
        (self.measured_square / self.points.max(1) as f64).sqrt()
    }

    /// The measures of all points added.
    pub fn metrics(&self) -> Metrics {
        let count = self.points.max(1) as f64;
        let about_mean = |sum: f64, square: f64| (square - sum * sum / count).max(0.0);
        let spread = about_mean(self.measured, self.measured_square);
        // What rounding leaves of a constant is no spread.
        let varies = spread > 1e-12 * self.measured_square;
        Metrics {
            rms: (self.error_square / count).sqrt(),
            relative: (self.measured_square > 0.0)
                .then(|| (self.error_square / self.measured_square).sqrt()),
            fit_percent: varies.then(|| 100.0 * (1.0 - (self.error_square / spread).sqrt())),
            variance_accounted_for_percent: varies
                .then(|| 100.0 * (1.0 - about_mean(self.error, self.error_square) / spread)),
            points: self.points,
        }
    }
}

impl Metrics {
    /// The measures of `error` against `measured`, point by point.
    pub fn of(error: &[f64], measured: &[f64]) -> Self {
        let mut sums = Sums::default();
        sums.add(error, measured);
        sums.metrics()
    }
}

impl SplitMetrics {
    /// The measures of `error` against `measured` on a grid that `split` divides.
    pub fn of(error: &[f64], measured: &[f64], split: &Split) -> Self {
        let part = |held_out: bool| {
            let mut sums = Sums::default();
            for (range, _) in split.blocks().filter(|(_, out)| *out == held_out) {
                sums.add(&error[range.clone()], &measured[range.clone()]);
            }
            sums.metrics()
        };
        Self { fit: part(false), validation: part(true) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(points: usize) -> Vec<f64> {
        (0..points).map(|k| 5.0 + (0.1 * k as f64).sin()).collect()
    }

    #[test]
    fn a_constant_error_spoils_the_fit_but_not_the_variance_accounted_for() {
        let measured = wave(2000);
        let metrics = Metrics::of(&vec![0.5; 2000], &measured);
        assert!((metrics.rms - 0.5).abs() < 1e-12);
        assert!(metrics.fit_percent.unwrap() < 40.0);
        assert!((metrics.variance_accounted_for_percent.unwrap() - 100.0).abs() < 1e-6);
    }

    #[test]
    fn the_mean_of_the_measurement_has_a_fit_of_zero() {
        let measured = wave(2000);
        let mean = measured.iter().sum::<f64>() / 2000.0;
        let error: Vec<f64> = measured.iter().map(|y| y - mean).collect();
        assert!(Metrics::of(&error, &measured).fit_percent.unwrap().abs() < 1e-6);
    }

    #[test]
    fn a_constant_measurement_has_no_percentages() {
        let metrics = Metrics::of(&[0.1; 50], &[3.0; 50]);
        assert_eq!((metrics.fit_percent, metrics.variance_accounted_for_percent), (None, None));
        assert!((metrics.relative.unwrap() - 0.1 / 3.0).abs() < 1e-12);
        assert_eq!(Metrics::of(&[], &[]).relative, None);
    }

    #[test]
    fn fitted_and_held_out_points_do_not_mix() {
        let split = Split::new(1500, Vec::new());
        let error: Vec<f64> =
            split.validation(1500).iter().map(|out| if *out { 2.0 } else { 1.0 }).collect();
        let metrics = SplitMetrics::of(&error, &wave(1500), &split);
        assert!((metrics.fit.rms - 1.0).abs() < 1e-12);
        assert!((metrics.validation.rms - 2.0).abs() < 1e-12);
        assert_eq!(metrics.fit.points + metrics.validation.points, 1500);
    }
}
