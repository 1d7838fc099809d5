//! A quadratic model of the cost.

use std::array;

use serde::{Deserialize, Serialize};

use super::distribution::Distribution;
use super::triangular::{self, Lower, TOGETHER};

/// Entries per coefficient that a model needs.
const NEEDED: f64 = 1.1;
/// Entries per coefficient that a full quadratic is fitted to: the best ones.
const USED: usize = 2;
/// Weight of the best entry; the worst one has 1.
const BEST_WEIGHT: f64 = 20.0;
/// Distance, in deviations per root of a component, from which on an entry counts little.
const NEAR: f64 = 3.0;
/// What is added to the diagonal of the normal equations, as a share of its largest entry.
const RIDGE: f64 = 1e-13;

/// What a model is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Terms {
    Linear,
    Squares,
    All,
}

impl Terms {
    /// Number of coefficients in `n` components.
    fn count(self, n: usize) -> usize {
        match self {
            Self::Linear => n + 1,
            Self::Squares => 2 * n + 1,
            Self::All => coefficients(n),
        }
    }

    /// Appends 1, all `v_i`, all `v_i^2`, all `v_i v_j` with j < i.
    fn write(self, v: &[f64], row: &mut Vec<f64>) {
        row.push(1.0);
        row.extend_from_slice(v);
        if self != Self::Linear {
            row.extend(v.iter().map(|v| v * v));
        }
        if self == Self::All {
            for i in 1..v.len() {
                row.extend(v[..i].iter().map(|other| v[i] * other));
            }
        }
    }
}

/// Number of coefficients of a full quadratic in `n` components.
pub(super) fn coefficients(n: usize) -> usize {
    1 + n + n * (n + 1) / 2
}

/// Coefficients over v = z / sqrt(n), where z is what is standard normal in the distribution that the
/// lineage had when the model was fitted. Costs are told up to an increasing linear function.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Model {
    frame: Distribution,
    /// From a position less the mean of the frame to v.
    whitening: Lower,
    terms: Terms,
    coefficients: Vec<f64>,
}

impl Model {
    /// The richest model that the `entries` (position and cost) allow, by weighted least squares.
    pub fn fit<'a>(
        frame: &Distribution,
        entries: impl Iterator<Item = (&'a [f64], f64)>,
    ) -> Option<Self> {
        let n = frame.dimension();
        let mut entries: Vec<_> = entries.collect();
        entries.sort_by(|a, b| a.1.total_cmp(&b.1));
        entries.truncate(USED * coefficients(n));
        [Terms::All, Terms::Squares, Terms::Linear]
            .into_iter()
            .filter(|terms| entries.len() as f64 >= NEEDED * terms.count(n) as f64)
            .find_map(|terms| Self::fit_terms(frame, &entries, terms))
    }

    /// The normal equations of `entries`, the best first.
    fn fit_terms(frame: &Distribution, entries: &[(&[f64], f64)], terms: Terms) -> Option<Self> {
        let n = frame.dimension();
        let m = terms.count(n);
        let (low, high) = (entries[0].1, entries[entries.len() - 1].1);
        if high <= low {
            return None;
        }
        let whitening = frame.whitening(1.0 / (n as f64).sqrt());
        let (mut gram, mut moment) = (Lower::zeros(m), vec![0.0; m]);
        let (mut apart, mut v) = (vec![0.0; n], vec![0.0; n]);
        let (mut rows, mut weights) =
            (Vec::with_capacity(TOGETHER * m), Vec::with_capacity(TOGETHER));
        for (rank, (position, cost)) in entries.iter().enumerate() {
            frame.apart(position, &mut apart);
            whitening.multiply(&apart, &mut v);
            let worse = rank as f64 / (entries.len() - 1) as f64;
            let far = 1.0 + triangular::dot(&v, &v) / NEAR;
            let weight = (BEST_WEIGHT + (1.0 - BEST_WEIGHT) * worse) / (far * far);
            terms.write(&v, &mut rows);
            weights.push(weight);
            let row = &rows[rows.len() - m..];
            triangular::add_scaled(&mut moment, row, weight * (cost - low) / (high - low));
            if weights.len() == TOGETHER {
                let row = |k: usize| &rows[k * m..(k + 1) * m];
                gram.add_squares(array::from_fn(row), array::from_fn(|k| weights[k]));
                rows.clear();
                weights.clear();
            }
        }
        for (row, weight) in rows.chunks_exact(m).zip(&weights) {
            gram.add_square(row, *weight);
        }
        gram.raise_diagonal(RIDGE);
        let factor = gram.factored()?;
        factor.solve(&mut moment);
        factor.solve_transposed(&mut moment);
        Some(Self { frame: frame.clone(), whitening, terms, coefficients: moment })
    }

    /// How many coefficients it has.
    pub fn coefficients(&self) -> usize {
        self.coefficients.len()
    }

    /// What the cost at `position` is expected to be.
    pub fn value(&self, position: &[f64]) -> f64 {
        let (mut apart, mut v) = (vec![0.0; position.len()], vec![0.0; position.len()]);
        self.frame.apart(position, &mut apart);
        self.whitening.multiply(&apart, &mut v);
        let mut row = Vec::with_capacity(self.coefficients.len());
        self.terms.write(&v, &mut row);
        triangular::dot(&row, &self.coefficients)
    }

    /// The position where the model is smallest, if it has one.
    pub fn minimum(&self) -> Option<Vec<f64>> {
        if self.terms == Terms::Linear {
            return None;
        }
        let n = self.frame.dimension();
        let (squares, products) = self.coefficients[1 + n..].split_at(n);
        let mut curvature = Lower::zeros(n);
        for row in 0..n {
            curvature.set(row, row, 2.0 * squares[row]);
            if self.terms == Terms::All {
                for column in 0..row {
                    curvature.set(row, column, products[row * (row - 1) / 2 + column]);
                }
            }
        }
        let factor = curvature.factored()?;
        let root = (n as f64).sqrt();
        let mut z: Vec<f64> = self.coefficients[1..=n].iter().map(|slope| -slope * root).collect();
        factor.solve(&mut z);
        factor.solve_transposed(&mut z);
        let mut step = vec![0.0; n];
        self.frame.step(&z, &mut step);
        let position: Vec<f64> = self.frame.position(&step).collect();
        position.iter().all(|x| x.is_finite()).then_some(position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{self, Purpose, Streams};

    #[test]
    fn a_quadratic_is_recovered_and_its_minimum_told() {
        let best = [0.3, 0.6, 0.2];
        let cost = |x: &[f64]| {
            let d: Vec<f64> = x.iter().zip(best).map(|(x, best)| x - best).collect();
            7.0 + d[0] * d[0] + 100.0 * (d[1] + d[0]).powi(2) + (d[2] - d[1]).powi(2)
        };
        let frame = Distribution::new(vec![0.5; 3], 0.2);
        let mut rng = Streams::new(1, Purpose::Mutation, 1).stream(0);
        let positions: Vec<Vec<f64>> =
            (0..14).map(|_| (0..3).map(|_| random::uniform(&mut rng)).collect()).collect();
        let entries = |count| positions[..count].iter().map(|x| (x.as_slice(), cost(x)));
        let model = Model::fit(&frame, entries(14)).unwrap();
        let minimum = model.minimum().unwrap();
        for (found, best) in minimum.iter().zip(best) {
            assert!((found - best).abs() < 1e-6, "{minimum:?}");
        }
        // The values are those of the cost up to an increasing linear function.
        let value = |k: usize| model.value(&positions[k]);
        let slope = (value(1) - value(0)) / (cost(&positions[1]) - cost(&positions[0]));
        let expected = value(0) + slope * (cost(&positions[7]) - cost(&positions[0]));
        assert!(slope > 0.0 && (value(7) - expected).abs() < 1e-6);
        assert!(Model::fit(&frame, entries(4)).is_none());
        assert_eq!(Model::fit(&frame, entries(6)).unwrap().terms, Terms::Linear);
    }
}
