//! Lower triangles of symmetric matrices and of their factors, row by row.

use multiversion::multiversion;
use serde::{Deserialize, Serialize};

/// Largest ratio of the pivots of a matrix that counts as positive definite.
const MOST_CONDITION: f64 = 1e14;
/// Numbers that are multiplied side by side.
const LANES: usize = 8;
/// Squares of vectors that are added in one pass.
pub(super) const TOGETHER: usize = 8;

/// A lower triangle: row r has its entries 0..=r.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Lower {
    n: usize,
    entries: Vec<f64>,
}

/// Index of the first entry of a row.
#[inline]
fn start(row: usize) -> usize {
    row * (row + 1) / 2
}

/// The sum of products, in an order that is the same on every machine and has room for vector
/// registers.
#[inline]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut sums = [0.0; LANES];
    let (wide_a, wide_b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = wide_a.remainder().iter().zip(wide_b.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in wide_a.zip(wide_b) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (b + f)) + ((c + g) + (d + h)) + rest
}

/// `sum += factor row`.
#[inline]
pub(super) fn add_scaled(sum: &mut [f64], row: &[f64], factor: f64) {
    for (sum, value) in sum.iter_mut().zip(row) {
        *sum += factor * value;
    }
}

pub(super) fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

#[multiversion(targets("x86_64+avx2"))]
fn add_square(entries: &mut [f64], v: &[f64], factor: f64) {
    let mut rest = entries;
    for row in 0..v.len() {
        let (own, below) = rest.split_at_mut(row + 1);
        add_scaled(own, v, factor * v[row]);
        rest = below;
    }
}

#[multiversion(targets("x86_64+avx2"))]
fn add_squares(entries: &mut [f64], v: [&[f64]; TOGETHER], factors: [f64; TOGETHER]) {
    let mut rest = entries;
    let [a, b, c, d, e, f, g, h] = v;
    for row in 0..a.len() {
        let (own, below) = rest.split_at_mut(row + 1);
        let mut w = factors;
        for (w, v) in w.iter_mut().zip(&v) {
            *w *= v[row];
        }
        let width = own.len();
        let (a, b, c, d) = (&a[..width], &b[..width], &c[..width], &d[..width]);
        let (e, f, g, h) = (&e[..width], &f[..width], &g[..width], &h[..width]);
        for (k, own) in own.iter_mut().enumerate() {
            let first = (w[0] * a[k] + w[1] * b[k]) + (w[2] * c[k] + w[3] * d[k]);
            let second = (w[4] * e[k] + w[5] * f[k]) + (w[6] * g[k] + w[7] * h[k]);
            *own += first + second;
        }
        rest = below;
    }
}

/// Cholesky's factor in place; whether there is one.
#[multiversion(targets("x86_64+avx2"))]
fn factor(entries: &mut [f64], n: usize) -> bool {
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for row in 0..n {
        let (above, own) = entries.split_at_mut(start(row));
        for column in 0..row {
            let other = &above[start(column)..=start(column) + column];
            own[column] = (own[column] - dot(&own[..column], other)) / other[column];
        }
        let pivot = own[row] - dot(&own[..row], &own[..row]);
        least = least.min(pivot);
        most = most.max(pivot);
        if !(pivot > 0.0 && pivot.is_finite() && most <= MOST_CONDITION * least) {
            return false;
        }
        own[row] = pivot.sqrt();
    }
    true
}

impl Lower {
    pub fn zeros(n: usize) -> Self {
        Self { n, entries: vec![0.0; start(n)] }
    }

    pub fn identity(n: usize) -> Self {
        let mut identity = Self::zeros(n);
        for row in 0..n {
            identity.set(row, row, 1.0);
        }
        identity
    }

    pub fn set(&mut self, row: usize, column: usize, entry: f64) {
        self.entries[start(row) + column] = entry;
    }

    #[inline]
    fn row(&self, row: usize) -> &[f64] {
        &self.entries[start(row)..=start(row) + row]
    }

    pub fn largest_of_diagonal(&self) -> f64 {
        (0..self.n).map(|row| self.row(row)[row]).fold(0.0, f64::max)
    }

    /// Makes the diagonal larger by `share` of its largest entry.
    pub fn raise_diagonal(&mut self, share: f64) {
        let more = share * self.largest_of_diagonal();
        for row in 0..self.n {
            self.entries[start(row) + row] += more;
        }
    }

    pub fn scale(&mut self, factor: f64) {
        self.entries.iter_mut().for_each(|entry| *entry *= factor);
    }

    /// Adds `factor v v'`.
    pub fn add_square(&mut self, v: &[f64], factor: f64) {
        add_square(&mut self.entries, v, factor);
    }

    /// Adds `factor v v'` of several vectors, in one pass over the entries.
    pub fn add_squares(&mut self, v: [&[f64]; TOGETHER], factors: [f64; TOGETHER]) {
        add_squares(&mut self.entries, v, factors);
    }

    /// A with A A' = this, if there is one that can be computed with.
    pub fn factored(&self) -> Option<Self> {
        let mut entries = self.entries.clone();
        factor(&mut entries, self.n).then_some(Self { n: self.n, entries })
    }

    /// A^-1 of a factor.
    pub fn inverse(&self) -> Self {
        let mut inverse = Self::zeros(self.n);
        let mut column = vec![0.0; self.n];
        for j in 0..self.n {
            column.fill(0.0);
            column[j] = 1.0;
            self.solve(&mut column);
            for (row, entry) in column.iter().enumerate().skip(j) {
                inverse.set(row, j, *entry);
            }
        }
        inverse
    }

    /// `out = A v`.
    pub fn multiply(&self, v: &[f64], out: &mut [f64]) {
        for (row, out) in out.iter_mut().enumerate() {
            *out = dot(self.row(row), v);
        }
    }

    /// Solves A x = v in place.
    pub fn solve(&self, v: &mut [f64]) {
        for row in 0..self.n {
            let entries = self.row(row);
            v[row] = (v[row] - dot(&entries[..row], &v[..row])) / entries[row];
        }
    }

    /// Solves A' x = v in place.
    pub fn solve_transposed(&self, v: &mut [f64]) {
        for row in (0..self.n).rev() {
            let entries = self.row(row);
            v[row] /= entries[row];
            let own = v[row];
            add_scaled(&mut v[..row], entries, -own);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 I + sum of squares of a few vectors.
    fn matrix(n: usize) -> Lower {
        let mut matrix = Lower::identity(n);
        matrix.scale(4.0);
        for k in 0..3 {
            let v: Vec<f64> = (0..n).map(|j| ((j * (k + 2)) as f64).sin()).collect();
            matrix.add_square(&v, 0.5 + k as f64);
        }
        matrix
    }

    #[test]
    fn a_factor_times_its_transpose_is_the_matrix() {
        for n in [1, 2, 9, 21] {
            let matrix = matrix(n);
            let factor = matrix.factored().unwrap();
            for row in 0..n {
                for column in 0..=row {
                    let product = dot(factor.row(row), factor.row(column));
                    assert!((product - matrix.row(row)[column]).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn both_triangles_are_solved() {
        let factor = matrix(13).factored().unwrap();
        let v: Vec<f64> = (0..13).map(|j| f64::from(j).cos()).collect();
        let mut product = vec![0.0; 13];
        factor.multiply(&v, &mut product);
        let mut by_inverse = vec![0.0; 13];
        factor.inverse().multiply(&product, &mut by_inverse);
        factor.solve(&mut product);
        for j in 0..13 {
            assert!((product[j] - by_inverse[j]).abs() < 1e-12);
        }
        // A A' x = A v has the solution A' x = v.
        let mut x = v.clone();
        factor.solve_transposed(&mut x);
        for j in 0..13 {
            assert!((product[j] - v[j]).abs() < 1e-12);
            let transposed: f64 = (j..13).map(|row| factor.row(row)[j] * x[row]).sum();
            assert!((transposed - v[j]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_no_factor() {
        let mut matrix = matrix(4);
        matrix.add_square(&[0.0, 0.0, 1.0, 0.0], -20.0);
        assert!(matrix.factored().is_none());
        matrix.set(2, 2, f64::NAN);
        assert!(matrix.factored().is_none());
    }
}
