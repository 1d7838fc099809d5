//! Gains measured and gains on placebos, made comparable between candidates of different freedom.

use crate::statistics::placebo;

/// The gains of all candidates, each standardised by the mean and the spread that it has on placebos;
/// a p-value counts the placebos on which *any* candidate stands out as much.
pub struct Evidence {
    centre: Vec<f64>,
    spread: Vec<f64>,
    measured: Vec<f64>,
    largest: Vec<f64>,
}

impl Evidence {
    /// `measured[k]` is the gain of candidate `k`, `null[b][k]` the same on placebo `b`.
    pub fn new(measured: &[f64], null: &[Vec<f64>]) -> Self {
        let count = null.len() as f64;
        let mean = |k: usize| null.iter().map(|row| row[k]).sum::<f64>() / count;
        let centre: Vec<f64> = (0..measured.len()).map(mean).collect();
        let deviation = |k: usize| {
            let square: f64 = null.iter().map(|row| (row[k] - centre[k]).powi(2)).sum();
            (square / count).sqrt().max(1e-12)
        };
        let spread: Vec<f64> = (0..measured.len()).map(deviation).collect();
        let standard = |row: &[f64]| -> Vec<f64> {
            row.iter().zip(&centre).zip(&spread).map(|((gain, c), s)| (gain - c) / s).collect()
        };
        let largest =
            null.iter().map(|row| standard(row).into_iter().fold(f64::MIN, f64::max)).collect();
        let measured = standard(measured);
        Self { centre, spread, measured, largest }
    }

    /// Chance that any candidate stands out as much on a placebo as candidate `k` does.
    pub fn p_value(&self, k: usize) -> f64 {
        placebo::p_value(self.measured[k], &self.largest)
    }

    /// The gain that candidate `k` needs to be among the largest 5 % of all placebos.
    pub fn needed(&self, k: usize) -> f64 {
        let mut sorted = self.largest.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let critical = sorted[(sorted.len() * 95 / 100).min(sorted.len() - 1)];
        self.centre[k] + critical * self.spread[k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flexible_candidate_must_gain_more_for_the_same_p_value() {
        let part = |k: i32, size: f64| size * f64::from(k % 20) / 20.0;
        // Candidate 0 gains 0..0.1 by chance, candidate 1 gains 0.4..0.5.
        let null: Vec<Vec<f64>> =
            (0..200).map(|k| vec![part(k, 0.1), 0.4 + part(7 * k, 0.1)]).collect();
        let evidence = Evidence::new(&[0.3, 0.45], &null);
        assert!(evidence.p_value(0) < 0.01);
        assert!(evidence.p_value(1) > 0.3);
        assert!(evidence.needed(1) > evidence.needed(0) + 0.3);
    }
}
