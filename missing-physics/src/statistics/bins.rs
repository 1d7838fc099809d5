//! Points grouped by the rank or by the value of a coordinate.

/// Bins along a coordinate, each with the same number of points.
const BINS: usize = 20;
/// Bins of the same width, for what happens at one place: a dent in the way.
const FINE: usize = 100;
/// A bin of fewer points takes in the next one.
const FEW: usize = 5;

/// Points grouped by the rank of a coordinate.
pub(crate) struct Bins {
    pub(crate) of: Vec<usize>,
    pub(crate) count: Vec<f64>,
}

impl Bins {
    pub(crate) fn new(values: &[f64]) -> Self {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let (mut of, mut count) = (vec![0; values.len()], vec![0.0; BINS]);
        let mut bin = 0;
        for (rank, &index) in order.iter().enumerate() {
            let wanted = rank * BINS / values.len();
            // Equal values stay together.
            let same = rank > 0 && values[order[rank - 1]] == values[index];
            if wanted > bin && !same {
                bin = wanted;
            }
            of[index] = bin;
            count[bin] += 1.0;
        }
        Self { of, count }
    }

    /// Bins of the same width; those with few points are joined with the one before.
    pub(crate) fn fine(values: &[f64]) -> Self {
        let (low, high) =
            values.iter().fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(*v), high.max(*v)));
        let scale = FINE as f64 / (high - low).max(f64::MIN_POSITIVE);
        let raw = |value: &f64| (((value - low) * scale) as usize).min(FINE - 1);
        let mut points = [0usize; FINE];
        for value in values {
            points[raw(value)] += 1;
        }
        let (mut joined, mut bin, mut inside) = ([0; FINE], 0, 0);
        for (k, points) in points.iter().enumerate() {
            if inside >= FEW {
                bin += 1;
                inside = 0;
            }
            joined[k] = bin;
            inside += points;
        }
        let of: Vec<usize> = values.iter().map(|value| joined[raw(value)]).collect();
        let mut count = vec![0.0; bin + 1];
        for bin in &of {
            count[*bin] += 1.0;
        }
        Self { of, count }
    }

    pub(crate) fn means(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![0.0; self.count.len()];
        values.iter().zip(&self.of).for_each(|(value, bin)| sums[*bin] += value);
        sums.iter().zip(&self.count).map(|(sum, count)| sum / count.max(1.0)).collect()
    }

    /// Adjusted share of the sum of squares that lies between bins, the overall mean included: a
    /// residual that is off everywhere by the same amount depends on nothing.
    pub(crate) fn explained(&self, values: &[f64]) -> f64 {
        let points = values.len() as f64;
        let mean = values.iter().sum::<f64>() / points;
        let total: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let used = self.count.iter().filter(|count| **count > 0.0).count() as f64;
        if total <= 0.0 || points <= used {
            return 0.0;
        }
        let between: f64 = self
            .means(values)
            .iter()
            .zip(&self.count)
            .map(|(bin, count)| count * (bin - mean).powi(2))
            .sum();
        let adjusted = 1.0 - (1.0 - between / total) * (points - 1.0) / (points - used);
        adjusted.max(0.0)
    }

    /// Mean coordinate and mean value of the bin with the largest mean value, by size.
    pub(crate) fn peak(&self, coordinate: &[f64], values: &[f64]) -> Option<(f64, f64)> {
        let (at, means) = (self.means(coordinate), self.means(values));
        (0..self.count.len())
            .filter(|&bin| self.count[bin] > 0.0)
            .max_by(|&a, &b| means[a].abs().total_cmp(&means[b].abs()))
            .map(|bin| (at[bin], means[bin]))
    }
}
