//! The nodes on the slope of the law, with a factor of their matrix.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_upper_triangular_in_place,
};
use faer::{Accum, Mat, MatMut, MatRef, Par};

use crate::parallel;
use crate::updater::Schur;

/// Columns that a thread solves for at a time.
const WIDTH: usize = 144;

/// Soft nodes, and the Cholesky factor of M = 1/k − S_SS.
#[derive(Debug)]
pub(super) struct Soft {
    /// Where they are among the watched nodes, ascending.
    places: Vec<usize>,
    /// Below the diagonal and on it.
    factor: Mat<f64>,
    /// The least pivot of M over 1/k, 1 at most.
    pub(super) least_pivot: f64,
}

/// `L⁻¹ B` for some columns B of the soft nodes, with M = L Lᵀ.
#[derive(Debug)]
pub(super) struct Half {
    /// Row by row.
    values: Vec<f64>,
    width: usize,
}

impl Soft {
    /// `None` if M is not positive definite: the state is not stable.
    pub(super) fn of(schur: &Schur, places: Vec<usize>, compliance: f64) -> Option<Self> {
        let size = places.len();
        let mut matrix = Mat::zeros(size, size);
        for (j, &column) in places.iter().enumerate() {
            let values = schur.below(column);
            for (i, &row) in places.iter().enumerate().skip(j) {
                matrix[(i, j)] = -values[row - column];
            }
            matrix[(j, j)] += compliance;
        }
        // Sequential, whatever a program has set for all of its threads.
        let scratch = cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut memory);
        let (none, params) = (Default::default(), Default::default());
        cholesky_in_place(matrix.as_mut(), none, Par::Seq, stack, params).ok()?;
        let pivots = (0..size).map(|i| matrix[(i, i)].powi(2) / compliance);
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

    /// M⁻¹ times two columns.
    pub(super) fn solve(&self, right: [Vec<f64>; 2]) -> [Vec<f64>; 2] {
        let mut right = Mat::from_fn(self.len(), 2, |i, k| right[k][i]);
        let lower = self.factor.as_ref();
        solve_lower_triangular_in_place(lower, right.as_mut(), Par::Seq);
        solve_upper_triangular_in_place(lower.transpose(), right.as_mut(), Par::Seq);
        [0, 1].map(|k| right.col(k).iter().copied().collect())
    }

    /// L⁻¹ times some columns, given row by row.
    pub(super) fn half(&self, mut values: Vec<f64>, width: usize) -> Half {
        let size = self.len();
        if size > 0 && width > 0 {
            let all = MatMut::from_row_major_slice_mut(&mut values, size, width);
            let mut parts = parts(all);
            parallel::for_each(size * size * width / 2, &mut parts, |part| {
                solve_lower_triangular_in_place(self.factor.as_ref(), part.as_mut(), Par::Seq);
            });
        }
        Half { values, width }
    }

    /// `M⁻¹ B x` for the first `columns` columns of B and each of some lists x of factors, one after the other.
    pub(super) fn combine(&self, half: &Half, columns: usize, factors: &[f64]) -> Mat<f64> {
        let (size, lists) = (self.len(), factors.len() / columns.max(1));
        let mut combined = Mat::zeros(size, lists);
        if columns == 0 || size == 0 {
            return combined;
        }
        let stored = MatRef::from_row_major_slice(&half.values, size, half.width);
        let stored = stored.subcols(0, columns);
        let factors = MatRef::from_column_major_slice(factors, columns, lists);
        let upper = self.factor.transpose();
        let work = size * lists * (columns + size / 2);
        let mut parts: Vec<_> = parts(combined.as_mut()).into_iter().enumerate().collect();
        parallel::for_each(work, &mut parts, |(part, target)| {
            let factors = factors.subcols(*part * WIDTH, target.ncols());
            matmul(target.as_mut(), Accum::Replace, stored, factors, 1.0, Par::Seq);
            solve_upper_triangular_in_place(upper, target.as_mut(), Par::Seq);
        });
        combined
    }
}

impl Half {
    /// Columns of these, `Ok`, and of `others`, `Err`, in the order given.
    pub(super) fn joined(&self, others: &Self, columns: &[Result<usize, usize>]) -> Self {
        let rows = self.values.len() / self.width.max(1);
        let mut values = Vec::with_capacity(rows * columns.len());
        for row in 0..rows {
            values.extend(columns.iter().map(|&place| match place {
                Ok(place) => self.values[place + self.width * row],
                Err(place) => others.values[place + others.width * row],
            }));
        }
        Self { values, width: columns.len() }
    }

    /// `Bᵀ M⁻¹ B`, the products of all columns with each other.
    pub(super) fn gram(&self) -> Option<Schur> {
        let mut gram = Schur::default();
        gram.resize(self.width).ok()?;
        gram.as_mut_slice().fill(0.0);
        gram.add_gram(1.0, &self.values);
        Some(gram)
    }
}

/// Columns in parts of [`WIDTH`].
fn parts(mut rest: MatMut<'_, f64>) -> Vec<MatMut<'_, f64>> {
    let mut parts = Vec::new();
    while rest.ncols() > WIDTH {
        let (part, later) = rest.split_at_col_mut(WIDTH);
        parts.push(part);
        rest = later;
    }
    parts.push(rest);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;

    /// The columns of 7 soft nodes, of which two are known and two are solved for later, in another order.
    #[test]
    fn columns_that_are_known_are_not_solved_for_again() -> Result<(), Error> {
        let size = 7;
        let mut schur = Schur::default();
        schur.resize(size)?;
        for (place, value) in schur.as_mut_slice().iter_mut().enumerate() {
            let distance = (place % size).abs_diff(place / size) as f64;
            *value = 0.3 / (1.0 + distance);
        }
        let soft = Soft::of(&schur, (0..size).collect(), 2.0);
        let soft = soft.ok_or(Error::FactorizationFailed { nodes: size })?;
        let entry = |row: usize, column: usize| libm::cos((3 * row + 5 * column) as f64);
        let half = |columns: &[usize]| {
            let row = |row| columns.iter().map(move |&column| entry(row, column));
            soft.half((0..size).flat_map(row).collect(), columns.len())
        };
        let joined = half(&[0, 3]).joined(&half(&[2, 1]), &[Ok(0), Err(1), Err(0), Ok(1)]);
        let expected = half(&[0, 1, 2, 3]);
        assert_eq!(joined.width, expected.width);
        for (found, expected) in joined.values.iter().zip(&expected.values) {
            // Some rounding errors of numbers of the order of 1.
            assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        }
        Ok(())
    }
}
