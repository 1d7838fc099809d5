//! An orthonormal basis that grows column by column, and least squares under sign constraints.

use multiversion::multiversion;

/// Columns shorter than this share of their length before projection add nothing new.
const RANK_TOLERANCE: f64 = 1e-7;

/// Partial sums of a scalar product: two of the widest vectors.
const SUMS: usize = 16;
/// Shorter columns are not worth the choice of an instruction set.
const LONG: usize = 64;

/// Scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() < LONG { products::<4>(a, b) } else { long_dot(a, b) }
}

/// The order of the sums is that of no instruction set, and nothing is fused: the same bits everywhere.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn long_dot(a: &[f64], b: &[f64]) -> f64 {
    products::<SUMS>(a, b)
}

#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn products<const N: usize>(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; N];
    let (wide_a, wide_b) = (a.chunks_exact(N), b.chunks_exact(N));
    let rest = wide_a.remainder().iter().zip(wide_b.remainder());
    let rest: f64 = rest.map(|(x, y)| x * y).sum();
    for (x, y) in wide_a.zip(wide_b) {
        for lane in 0..N {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let mut width = N / 2;
    while width > 0 {
        for lane in 0..width {
            sums[lane] += sums[lane + width];
        }
        width /= 2;
    }
    sums[0] + rest
}

/// `y += factor * x`.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
}

/// A column with every entry times its weight.
pub fn weighed(column: &[f64], weights: &[f64]) -> Vec<f64> {
    column.iter().zip(weights).map(|(value, weight)| value * weight).collect()
}

/// Orthonormal columns that span what has been added.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    columns: Vec<Vec<f64>>,
}

impl Basis {
    /// The basis of the space that `columns` span.
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let mut basis = Self::default();
        for column in columns {
            basis.add(column.clone());
        }
        basis
    }

    /// The orthonormal columns.
    pub fn columns(&self) -> &[Vec<f64>] {
        &self.columns
    }

    /// Removes from `vector` all that lies in the space; twice, for orthogonality to rounding.
    pub fn project_out(&self, vector: &mut [f64]) {
        for _ in 0..2 {
            for column in &self.columns {
                add_scaled(vector, -dot(column, vector), column);
            }
        }
    }

    /// Adds the direction of `column`; false where it lies in the space already.
    pub fn add(&mut self, mut column: Vec<f64>) -> bool {
        let before = dot(&column, &column).sqrt();
        self.project_out(&mut column);
        let after = dot(&column, &column).sqrt();
        // False for NaN as well.
        let independent = after > RANK_TOLERANCE * before;
        if independent {
            for value in &mut column {
                *value /= after;
            }
            self.columns.push(column);
        }
        independent
    }
}

/// Least squares `min |b - A x|²` from the normal equations (`gram = AᵀA`, `moment = Aᵀb`), where
/// `x[k] >= 0` for `positive[k]`. Returns `x`; columns that the others already span get 0.
///
/// Coefficients that come out with the wrong sign are taken out one after the other, the worst
/// first: exact for one constraint, and for few nearly orthogonal ones, which is what a term has.
pub fn constrained(gram: &[Vec<f64>], moment: &[f64], positive: &[bool]) -> Vec<f64> {
    let mut active: Vec<usize> = (0..moment.len()).collect();
    loop {
        let solution = solve(gram, moment, &active);
        let wrong = active.iter().copied().filter(|&k| positive[k] && solution[k] < 0.0).min_by(
            |&a, &b| {
                let weight = |k: usize| solution[k] * gram[k][k].sqrt();
                weight(a).total_cmp(&weight(b))
            },
        );
        match wrong {
            None => return solution,
            Some(k) => active.retain(|&index| index != k),
        }
    }
}

/// Solves the normal equations for the columns in `active` by a Cholesky decomposition that skips
/// dependent columns.
pub fn solve(gram: &[Vec<f64>], moment: &[f64], active: &[usize]) -> Vec<f64> {
    let n = active.len();
    let mut lower = vec![vec![0.0; n]; n];
    let mut used = vec![false; n];
    for i in 0..n {
        for j in 0..=i {
            let products: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let rest = gram[active[i]][active[j]] - products;
            if i == j {
                used[i] = rest > 1e-12 * gram[active[i]][active[i]];
                lower[i][i] = if used[i] { rest.sqrt() } else { 0.0 };
            } else {
                lower[i][j] = if used[j] { rest / lower[j][j] } else { 0.0 };
            }
        }
    }
    let mut y = vec![0.0; n];
    for i in (0..n).filter(|&i| used[i]) {
        let sum: f64 = (0..i).map(|k| lower[i][k] * y[k]).sum();
        y[i] = (moment[active[i]] - sum) / lower[i][i];
    }
    let mut x = vec![0.0; moment.len()];
    for i in (0..n).rev().filter(|&i| used[i]) {
        let sum: f64 = (i + 1..n).map(|k| lower[k][i] * x[active[k]]).sum();
        x[active[i]] = (y[i] - sum) / lower[i][i];
    }
    x
}

/// `AᵀA` of columns.
pub fn gram(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dependent_column_adds_nothing() {
        let mut basis = Basis::of(&[vec![1.0, 1.0, 0.0], vec![0.0, 1.0, 1.0]]);
        assert!(!basis.add(vec![1.0, 2.0, 1.0]));
        assert!(basis.add(vec![0.0, 0.0, 1.0]));
    }

    #[test]
    fn a_coefficient_of_the_wrong_sign_is_left_out_and_the_rest_solved_again() {
        let columns = [vec![1.0, 0.0, 1.0], vec![0.0, 1.0, 1.0]];
        let target = [2.0, -3.0, 0.0];
        let moment: Vec<f64> = columns.iter().map(|c| dot(c, &target)).collect();
        let free = constrained(&gram(&columns), &moment, &[false, false]);
        assert!(free[1] < 0.0);
        let signed = constrained(&gram(&columns), &moment, &[true, true]);
        assert_eq!(signed[1], 0.0);
        assert!((signed[0] - 1.0).abs() < 1e-12);
    }
}
