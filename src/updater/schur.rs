//! The Schur complement of the watched nodes.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::{DMatrixView, DMatrixViewMut};

use super::tuning::{PARALLEL, TILE};
use crate::{Error, UpdaterError, parallel};

/// What remains of the system for k watched nodes once the contact is eliminated: the Schur complement S
/// (k × k, lower triangle) and the reduced row sums σ.
#[derive(Debug, Clone, Default)]
pub struct Schur {
    size: usize,
    matrix: Vec<f64>,
    row_sums: Vec<f64>,
}

impl Schur {
    /// Number of watched nodes k.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Prepares for k watched nodes. What was there before is lost; what is there is unspecified.
    ///
    /// # Errors
    ///
    /// [`UpdaterError::TooManyWatched`] if no memory is to be had for k² numbers; then nothing has changed.
    pub fn resize(&mut self, size: usize) -> Result<(), Error> {
        let too_many = || Error::Updater(UpdaterError::TooManyWatched { nodes: size });
        let numbers = size.checked_mul(size).ok_or_else(too_many)?;
        for (values, count) in [(&mut self.matrix, numbers), (&mut self.row_sums, size)] {
            let more = count.saturating_sub(values.len());
            values.try_reserve(more).map_err(|_| too_many())?;
        }
        self.size = size;
        self.matrix.resize(numbers, 0.0);
        self.row_sums.resize(size, 0.0);
        Ok(())
    }

    /// The Schur complement S, of which only the lower triangle means anything.
    #[must_use]
    pub fn matrix(&self) -> DMatrixView<'_, f64> {
        DMatrixView::from_slice(&self.matrix, self.size, self.size)
    }

    /// The Schur complement S to write to.
    pub fn matrix_mut(&mut self) -> DMatrixViewMut<'_, f64> {
        DMatrixViewMut::from_slice(&mut self.matrix, self.size, self.size)
    }

    /// The reduced row sums σ, by watched node.
    #[must_use]
    pub fn row_sums(&self) -> &[f64] {
        &self.row_sums
    }

    /// The reduced row sums σ to write to.
    pub fn row_sums_mut(&mut self) -> &mut [f64] {
        &mut self.row_sums
    }

    /// `S_ij`, from the lower triangle.
    pub(crate) fn entry(&self, i: usize, j: usize) -> f64 {
        self.matrix[i.max(j) + self.size * i.min(j)]
    }

    /// The same with more rows and columns, each of which has one entry: 1 in the column of a watched node.
    pub(crate) fn bordered(&self, borders: impl ExactSizeIterator<Item = usize>) -> Self {
        let (inner, size) = (self.size, self.size + borders.len());
        let mut matrix = vec![0.0; size * size];
        for (column, target) in
            self.matrix.chunks_exact(inner.max(1)).zip(matrix.chunks_exact_mut(size))
        {
            target[..inner].copy_from_slice(column);
        }
        for (row, column) in (inner..).zip(borders) {
            matrix[row + size * column] = 1.0;
        }
        Self { size, matrix, row_sums: vec![0.0; size] }
    }

    /// Column `j` of S from its diagonal on.
    pub(crate) fn below(&self, j: usize) -> &[f64] {
        &self.matrix[j + self.size * j..self.size * (j + 1)]
    }

    /// The part of some of the watched nodes, ascending, with room behind it for more, up to `size`.
    ///
    /// # Errors
    ///
    /// As for [`Self::resize`].
    pub(crate) fn part(&self, places: &[usize], size: usize) -> Result<Self, Error> {
        let mut part = Self::default();
        part.resize(size.max(places.len()))?;
        for (j, (&column, target)) in
            places.iter().zip(part.matrix.chunks_exact_mut(part.size.max(1))).enumerate()
        {
            let values = self.below(column);
            for (value, &row) in target[j..].iter_mut().zip(&places[j..]) {
                *value = values[row - column];
            }
        }
        Ok(part)
    }

    /// The columns of S as stored.
    pub(crate) fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.matrix
    }

    /// S += factor R Rᵀ for some columns R, one after the other, of as many rows.
    pub(crate) fn add_gram(&mut self, factor: f64, columns: &[f64]) {
        let k = self.size;
        if k == 0 {
            return;
        }
        let all = MatRef::from_column_major_slice(columns, k, columns.len() / k);
        let add = |tile: usize, target: &mut [f64]| {
            // What lies above the diagonal in the tile is written and never read.
            let (first, width) = (tile * TILE, target.len() / k);
            let rows = k - first;
            let target = &mut target[first..];
            let target = MatMut::from_column_major_slice_with_stride_mut(target, rows, width, k);
            let below = all.subrows(first, rows);
            let here = below.subrows(0, width).transpose();
            matmul(target, Accum::Add, below, here, factor, Par::Seq);
        };
        let matrix = &mut self.matrix[..k * k];
        if k < PARALLEL {
            let tiles = matrix.chunks_mut(TILE * k).enumerate();
            tiles.for_each(|(tile, target)| add(tile, target));
        } else {
            parallel::for_each_chunk(matrix, TILE * k, add);
        }
    }

    /// Column `j` of S, made whole from the lower triangle.
    pub(crate) fn copy_column(&self, j: usize, column: &mut [f64]) {
        let k = self.size;
        for (i, value) in column.iter_mut().enumerate().take(j) {
            *value = self.matrix[j + k * i];
        }
        column[j..k].copy_from_slice(&self.matrix[j + k * j..k * (j + 1)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_no_memory_holds_is_refused() -> Result<(), Error> {
        let mut schur = Schur::default();
        schur.resize(3)?;
        // Squares that overflow, and one of 2⁶² numbers.
        for size in [1 << 31, 1 << 32, (1 << 32) + 1, usize::MAX] {
            let refused = schur.resize(size);
            assert!(
                matches!(
                    refused,
                    Err(Error::Updater(UpdaterError::TooManyWatched { nodes })) if nodes == size
                ),
                "{refused:?}"
            );
            assert_eq!((schur.size(), schur.matrix().shape()), (3, (3, 3)));
        }
        Ok(())
    }

    /// Sums of products of small integers are exact. Sizes are those of a part of a tile, of several, and of so many
    /// that threads share them.
    #[test]
    fn products_of_columns_are_added() -> Result<(), Error> {
        for size in [0, 1, 5, TILE, 2 * TILE + 12, PARALLEL + 1] {
            let mut schur = Schur::default();
            schur.resize(size)?;
            let own = |i: usize, j: usize| (3 * i + 5 * j) as f64;
            for j in 0..size {
                for i in j..size {
                    schur.matrix_mut()[(i, j)] = own(i, j);
                }
            }
            let entry = |i: usize, t: usize| ((i * (t + 2) + t) % 7) as f64 - 3.0;
            let columns: Vec<f64> =
                (0..3).flat_map(|t| (0..size).map(move |i| entry(i, t))).collect();
            schur.add_gram(-2.0, &columns);
            for j in 0..size {
                for i in j..size {
                    let products: f64 = (0..3).map(|t| entry(i, t) * entry(j, t)).sum();
                    assert_eq!(
                        schur.matrix()[(i, j)],
                        own(i, j) - 2.0 * products,
                        "{size}: {i} {j}"
                    );
                }
            }
        }
        Ok(())
    }

    /// Left of the diagonal a column is a row, and nothing above it is read.
    #[test]
    fn columns_are_made_whole() -> Result<(), Error> {
        let mut schur = Schur::default();
        schur.resize(3)?;
        let above = f64::NAN;
        schur.as_mut_slice().copy_from_slice(&[1.0, 2.0, 3.0, above, 4.0, 5.0, above, above, 6.0]);
        for (j, expected) in
            [[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]].into_iter().enumerate()
        {
            let mut column = [0.0; 3];
            schur.copy_column(j, &mut column);
            assert_eq!(column, expected);
            assert_eq!([0, 1, 2].map(|i| schur.entry(i, j)), expected);
        }
        Ok(())
    }
}
