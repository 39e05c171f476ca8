//! The nodes on the slope of the law, with a factor of their matrix.

use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Mat, MatMut, MatRef, Par, Side};

use crate::updater::{Schur, for_each_tile};
use crate::{Error, parallel};

/// Columns that a thread solves for at a time, at most.
const WIDTH: usize = 144;
/// Columns of a matrix that are factored before the others follow.
const BLOCK: usize = 96;

/// Soft nodes, and the Cholesky factor L of M = 1/k − S_SS.
#[derive(Debug)]
pub(super) struct Soft {
    /// Where they are among the watched nodes, ascending.
    places: Vec<usize>,
    /// L, column by column.
    factor: Vec<f64>,
    /// The least pivot of M over 1/k, 1 at most.
    pub(super) least_pivot: f64,
}

/// What columns of soft nodes become in front of the factor, L⁻¹ b, and products of all of them with each other,
/// `b_iᵀ M⁻¹ b_j`.
#[derive(Debug, Default)]
pub(super) struct Half {
    /// Widths of blocks, each row by row.
    blocks: Vec<(usize, Vec<f64>)>,
    gram: Schur,
}

impl Soft {
    /// `None` if M is not positive definite: the state is not stable.
    pub(super) fn of(schur: &Schur, places: Vec<usize>, compliance: f64) -> Option<Self> {
        let size = places.len();
        let mut matrix = vec![0.0; size * size];
        for (j, (target, &column)) in matrix.chunks_exact_mut(size.max(1)).zip(&places).enumerate()
        {
            let values = schur.below(column);
            for (value, &row) in target[j..].iter_mut().zip(&places[j..]) {
                *value = -values[row - column];
            }
            target[j] += compliance;
        }
        factor(&mut matrix, size)?;
        let pivots = (0..size).map(|i| matrix[i + size * i].powi(2) / compliance);
        let least_pivot = pivots.fold(1.0, f64::min);
        Some(Self { places, factor: matrix, least_pivot })
    }

    /// The same nodes in the same order at other places.
    pub(super) fn at(self, places: Vec<usize>) -> Self {
        Self { places, ..self }
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Where they are among the watched nodes, ascending.
    pub(super) fn places(&self) -> &[usize] {
        &self.places
    }

    fn factor(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.factor, self.len(), self.len())
    }

    /// M⁻¹ times two columns.
    pub(super) fn solve(&self, right: [Vec<f64>; 2]) -> [Vec<f64>; 2] {
        let mut right = Mat::from_fn(self.len(), 2, |i, k| right[k][i]);
        solve_lower_triangular_in_place(self.factor(), right.as_mut(), Par::Seq);
        solve_upper_triangular_in_place(self.factor().transpose(), right.as_mut(), Par::Seq);
        [0, 1].map(|k| right.col(k).iter().copied().collect())
    }

    /// Appends L⁻¹ times some columns, given row by row, to those that are there.
    pub(super) fn extend(
        &self,
        half: &mut Half,
        mut values: Vec<f64>,
        width: usize,
    ) -> Result<(), Error> {
        let size = self.len();
        let all = MatMut::from_row_major_slice_mut(&mut values, size, width);
        parallel::for_each(size * size * width / 2, &mut parts(all), |part| {
            solve_lower_triangular_in_place(self.factor(), part.as_mut(), Par::Seq);
        });
        let mut own = Schur::default();
        own.resize(width)?;
        own.as_mut_slice().fill(0.0);
        own.add_gram(1.0, &values);
        half.append(values, own, size)
    }

    /// M⁻¹ times a combination of columns for each of some lists of factors, one after the other.
    pub(super) fn combine(&self, half: &Half, factors: &[f64]) -> Mat<f64> {
        let (size, columns) = (self.len(), half.width());
        let lists = factors.len() / columns.max(1);
        let mut combined = Mat::zeros(size, lists);
        if size == 0 {
            return combined;
        }
        let factors = MatRef::from_column_major_slice(factors, columns, lists);
        let work = size * lists * (columns + size / 2);
        let mut parts: Vec<_> = parts(combined.as_mut())
            .into_iter()
            .scan(0, |next, part| {
                let first = *next;
                *next += part.ncols();
                Some((first, part))
            })
            .collect();
        parallel::for_each(work, &mut parts, |(first, target)| {
            let factors = factors.subcols(*first, target.ncols());
            for (start, stored) in half.blocks(size) {
                let factors = factors.subrows(start, stored.ncols());
                matmul(target.as_mut(), Accum::Add, stored, factors, 1.0, Par::Seq);
            }
            let upper = self.factor().transpose();
            solve_upper_triangular_in_place(upper, target.as_mut(), Par::Seq);
        });
        combined
    }
}

impl Half {
    /// Number of columns.
    pub(super) fn width(&self) -> usize {
        self.gram.size()
    }

    /// The product of two columns.
    pub(super) fn product(&self, i: usize, j: usize) -> f64 {
        self.gram.entry(i, j)
    }

    /// Blocks of so many rows, with their first columns.
    fn blocks(&self, rows: usize) -> impl Iterator<Item = (usize, MatRef<'_, f64>)> {
        self.blocks.iter().scan(0, move |next, (width, values)| {
            let first = *next;
            *next += width;
            Some((first, MatRef::from_row_major_slice(values, rows, *width)))
        })
    }

    /// Appends a block of so many rows, with the products of its columns among themselves.
    fn append(&mut self, values: Vec<f64>, mut own: Schur, rows: usize) -> Result<(), Error> {
        let (before, width) = (self.width(), own.size());
        if before > 0 {
            let known: Vec<usize> = (0..before).collect();
            let mut gram = Schur::default();
            self.gram.copy_part(&known, before + width, &mut gram)?;
            let size = gram.size();
            let new = MatRef::from_row_major_slice(&values, rows, width).transpose();
            let matrix = gram.as_mut_slice();
            for (first, stored) in self.blocks(rows) {
                let target = &mut matrix[size * first + before..];
                let target = MatMut::from_column_major_slice_with_stride_mut(
                    target,
                    width,
                    stored.ncols(),
                    size,
                );
                matmul(target, Accum::Replace, new, stored, 1.0, Par::Seq);
            }
            let corner = matrix[size * before..].chunks_exact_mut(size);
            for (target, column) in corner.zip(own.as_mut_slice().chunks_exact(width.max(1))) {
                target[before..].copy_from_slice(column);
            }
            own = gram;
        }
        self.gram = own;
        self.blocks.push((width, values));
        Ok(())
    }
}

/// The Cholesky factor of a matrix in its place, lower triangles column by column; `None` if it is not positive
/// definite.
fn factor(matrix: &mut [f64], size: usize) -> Option<()> {
    for first in (0..size).step_by(BLOCK) {
        let width = BLOCK.min(size - first);
        let (here, rest) = matrix[size * first..].split_at_mut(size * width);
        let here = MatMut::from_column_major_slice_with_stride_mut(
            &mut here[first..],
            size - first,
            width,
            size,
        );
        let (mut own, mut below) = here.split_at_row_mut(width);
        let factor = own.as_ref().llt(Side::Lower).ok()?;
        own.copy_from(factor.L());
        let work = below.nrows() * width * width / 2;
        parallel::for_each(work, &mut parts(below.as_mut().transpose_mut()), |part| {
            solve_lower_triangular_in_place(factor.L(), part.as_mut(), Par::Seq);
        });
        let below = below.as_ref();
        for_each_tile(rest, size, |column, target| {
            let (rows, width) = (below.nrows() - column, target.len() / size);
            let target = MatMut::from_column_major_slice_with_stride_mut(
                &mut target[size - rows..],
                rows,
                width,
                size,
            );
            let left = below.subrows(column, rows);
            let right = left.subrows(0, width).transpose();
            matmul(target, Accum::Add, left, right, -1.0, Par::Seq);
        });
    }
    Some(())
}

/// Columns in parts of [`WIDTH`] at most and much the same width, so that threads end together.
fn parts(mut rest: MatMut<'_, f64>) -> Vec<MatMut<'_, f64>> {
    let count = 2 * rest.ncols().div_ceil(2 * WIDTH);
    let width = rest.ncols().div_ceil(count.max(1)).max(1);
    let mut parts = Vec::with_capacity(count);
    while rest.ncols() > width {
        let (part, later) = rest.split_at_col_mut(width);
        parts.push(part);
        rest = later;
    }
    parts.push(rest);
    parts
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    const COMPLIANCE: f64 = 400.0;

    /// Of a matrix whose rows are dominated by their diagonals, −M + 1/k.
    fn complement(i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j) as f64, i.max(j) as f64);
        if i == j { 7.0 } else { libm::sin(3.0 * i + 7.0 * j * j) }
    }

    fn schur(size: usize) -> Schur {
        let mut schur = Schur::default();
        schur.resize(size).unwrap();
        for j in 0..size {
            for i in 0..size {
                // Nothing above the diagonal may be read.
                let value = if i < j { f64::NAN } else { complement(i, j) };
                schur.matrix_mut()[(i, j)] = value;
            }
        }
        schur
    }

    /// A part of a block, several of them, and so many rows that threads share them: products and combinations of
    /// columns that come in one go or in several are those of a dense solution.
    #[test]
    fn columns_that_come_later_are_as_those_before() {
        for (watched, each) in [(12, 3), (350, 2), (520, 1)] {
            let places: Vec<usize> = (0..watched).step_by(each).collect();
            let size = places.len();
            let matrix = DMatrix::from_fn(size, size, |i, j| {
                let own = if i == j { COMPLIANCE } else { 0.0 };
                own - complement(places[i], places[j])
            });
            let inverse = matrix.cholesky().unwrap().inverse();
            let soft = Soft::of(&schur(watched), places, COMPLIANCE).unwrap();
            assert!(soft.least_pivot > 0.5 && soft.least_pivot < 1.0);
            let columns = DMatrix::from_fn(size, 9, |i, j| ((i * (j + 2) + j) % 7) as f64 - 3.0);
            let products = columns.transpose() * &inverse * &columns;
            let lists = DMatrix::from_fn(9, 4, |i, j| ((i + 3 * j) % 5) as f64 - 2.0);
            let combined = inverse * &columns * &lists;
            for widths in [&[9][..], &[4, 5], &[1, 6, 2]] {
                let (mut half, mut first) = (Half::default(), 0);
                for &width in widths {
                    let values = columns.columns(first, width).transpose();
                    soft.extend(&mut half, values.as_slice().to_vec(), width).unwrap();
                    first += width;
                }
                assert_eq!(half.width(), 9);
                let found = soft.combine(&half, lists.as_slice());
                // A few hundred rounding errors of numbers up to 10 over pivots of 400.
                for j in 0..9 {
                    for i in 0..9 {
                        let error = half.product(i, j) - products[(i, j)];
                        assert!(
                            error.abs() < 1e-13 * size as f64,
                            "{watched} {widths:?}: {error:e}"
                        );
                    }
                }
                for j in 0..4 {
                    for i in 0..size {
                        let error = found[(i, j)] - combined[(i, j)];
                        assert!(error.abs() < 1e-14, "{watched} {widths:?}: {error:e}");
                    }
                }
            }
            let right = [0, 1].map(|k| columns.column(k).iter().copied().collect());
            for (k, found) in soft.solve(right).iter().enumerate() {
                let unit = DMatrix::from_fn(9, 1, |i, _| f64::from(u8::from(i == k)));
                let expected = &columns * unit;
                let left = DMatrix::from_fn(size, 1, |i, _| {
                    let row = (0..size).map(|j| {
                        let own = if i == j { COMPLIANCE } else { 0.0 };
                        (own - complement(i * each, j * each)) * found[j]
                    });
                    row.sum()
                });
                assert!((left - expected).amax() < 1e-12, "{watched}");
            }
        }
    }

    /// The last pivot, or one in the middle, is not positive.
    #[test]
    fn what_is_not_stable_is_refused() {
        for (size, place) in [(5, 4), (300, 150), (300, 299)] {
            let mut schur = schur(size);
            schur.matrix_mut()[(place, place)] = COMPLIANCE + 1.0;
            assert!(Soft::of(&schur, (0..size).collect(), COMPLIANCE).is_none());
        }
    }
}
