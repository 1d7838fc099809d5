//! Many positions in one block of memory, one row each.

use serde::{Deserialize, Serialize};

use crate::Scalar;

/// Positions stored row by row: row `i` is the position of individual `i`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Points<T: Scalar = f64> {
    dimension: usize,
    data: Vec<T>,
}

impl<T: Scalar> Points<T> {
    /// `count` positions of `dimension` components, all zero.
    pub fn zeros(count: usize, dimension: usize) -> Self {
        Self { dimension, data: vec![T::zero(); count * dimension] }
    }

    /// Number of positions.
    pub fn len(&self) -> usize {
        self.data.len().checked_div(self.dimension).unwrap_or(0)
    }

    /// Whether there is no position.
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Number of components of a position.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Position `i`.
    #[inline]
    pub fn row(&self, i: usize) -> &[T] {
        &self.data[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Position `i`, to be written.
    #[inline]
    pub fn row_mut(&mut self, i: usize) -> &mut [T] {
        &mut self.data[i * self.dimension..(i + 1) * self.dimension]
    }

    /// A view of all positions.
    pub fn batch(&self) -> Batch<'_, T> {
        Batch { dimension: self.dimension, data: &self.data }
    }
}

/// A borrowed view of positions, row-major: what an evaluator receives.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'a, T: Scalar = f64> {
    dimension: usize,
    data: &'a [T],
}

impl<'a, T: Scalar> Batch<'a, T> {
    /// A view of `data`, `dimension` numbers per position. An incomplete last row is left out.
    pub fn new(dimension: usize, data: &'a [T]) -> Self {
        let rows = data.len().checked_div(dimension).unwrap_or(0);
        Self { dimension, data: &data[..rows * dimension] }
    }

    /// Number of positions.
    pub fn len(&self) -> usize {
        self.data.len().checked_div(self.dimension).unwrap_or(0)
    }

    /// Whether there is no position.
    pub fn is_empty(&self) -> bool {
        self.data.is_empty()
    }

    /// Number of components of a position.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Position `i`.
    #[inline]
    pub fn row(&self, i: usize) -> &'a [T] {
        &self.data[i * self.dimension..(i + 1) * self.dimension]
    }

    /// Positions one after the other.
    pub fn rows(&self) -> std::slice::ChunksExact<'a, T> {
        self.data.chunks_exact(self.dimension.max(1))
    }

    /// All numbers, row after row.
    pub fn as_slice(&self) -> &'a [T] {
        self.data
    }

    /// The positions `from..to`, as far as there are any.
    #[must_use]
    pub fn slice(&self, from: usize, to: usize) -> Self {
        let to = to.min(self.len());
        let data = &self.data[from.min(to) * self.dimension..to * self.dimension];
        Self { dimension: self.dimension, data }
    }
}
