//! Pressures or gaps of nodes as functions of what is given of each, with a change of rank one where that changes.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use crate::parallel::{self, vectorized};

/// Products that are subtracted from the whole matrix at a time.
const BLOCK: usize = 32;
/// Columns that a thread changes at a time.
const TILE: usize = 144;
/// Nodes from which waking threads pays.
const PARALLEL: usize = 400;

/// The matrix T of how each of some nodes answers to what is given of the others, with two more rows, of sums.
///
/// Of every node one of two quantities is given and the other answers. [Exchanging](Self::pivot) the two of a node s is
/// a pivot: `T_ij`, `i, j ≠ s`, loses `T_is T_sj / T_ss`, a column times a row. [Letting](Self::feed_back) the pressure
/// of a node follow its gap adds a multiple of `T_is T_sj` to all. Columns and rows are kept, and subtracted from the
/// matrix a block at a time. A row follows from its column: T is symmetric but for the sign between a node that answers
/// with its pressure and one that does not.
#[derive(Debug, Clone)]
pub(super) struct Answers {
    size: usize,
    /// Column by column, of `size + 2` numbers each.
    matrix: Vec<f64>,
    /// Whether the pressure answers.
    with_pressure: Vec<bool>,
    /// Columns and rows whose products are still to be subtracted.
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Answers {
    /// From the columns of `size + 2` numbers, and whether the pressures answer.
    pub(super) fn new(matrix: Vec<f64>, with_pressure: Vec<bool>) -> Self {
        let size = with_pressure.len();
        Self { size, matrix, with_pressure, columns: Vec::new(), rows: Vec::new() }
    }

    fn height(&self) -> usize {
        self.size + 2
    }

    /// Column and row of each product that is still to be subtracted.
    fn products(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        let columns = self.columns.chunks_exact(self.height());
        columns.zip(self.rows.chunks_exact(self.size.max(1)))
    }

    /// `T_ij`: how the node of a row answers to what is given of that of a column.
    pub(super) fn entry(&self, row: usize, column: usize) -> f64 {
        let products: f64 = self.products().map(|(c, r)| c[row] * r[column]).sum();
        self.matrix[row + self.height() * column] - products
    }

    /// How all answer to one of them.
    pub(super) fn column(&self, column: usize) -> Vec<f64> {
        let height = self.height();
        let mut values = self.matrix[height * column..height * (column + 1)].to_vec();
        vectorized(
            #[inline(always)]
            || {
                for (c, r) in self.products() {
                    let factor = r[column];
                    if factor != 0.0 {
                        values.iter_mut().zip(c).for_each(|(value, c)| *value -= factor * c);
                    }
                }
            },
        );
        values
    }

    /// The row of a node whose column this is.
    fn row(&self, place: usize, column: &[f64]) -> Vec<f64> {
        let own = self.with_pressure[place];
        let values = column.iter().zip(&self.with_pressure);
        values.map(|(value, answers)| if *answers == own { *value } else { -value }).collect()
    }

    /// Lets the pressure of a node whose gap answers grow by `stiffness` times that gap besides what is given of it, in
    /// the matrix and in some more columns: `T_ij` gains `f T_is T_sj`, with `f = stiffness / (1 − stiffness T_ss)`.
    /// The negative stiffness takes that back.
    pub(super) fn feed_back<'a>(
        &mut self,
        place: usize,
        stiffness: f64,
        others: impl IntoIterator<Item = &'a mut Vec<f64>>,
    ) {
        let mut column = self.column(place);
        let row = self.row(place, &column);
        let factor = -stiffness / (1.0 - stiffness * column[place]);
        column.iter_mut().for_each(|value| *value *= factor);
        self.push(column, row, others.into_iter().map(|other| (other[place], other)));
    }

    /// Exchanges what is given of a node and what answers, in the matrix and in some more columns.
    pub(super) fn pivot<'a>(
        &mut self,
        place: usize,
        others: impl IntoIterator<Item = &'a mut Vec<f64>>,
    ) {
        let (size, height) = (self.size, self.height());
        let mut column = self.column(place);
        let mut row = self.row(place, &column);
        let inverse = column[place].recip();
        column.iter_mut().for_each(|value| *value *= inverse);
        (column[place], row[place]) = (inverse, -1.0);
        // The new row and column replace the old ones, in the matrix and in products that are still to be subtracted.
        self.matrix[height * place..height * (place + 1)].fill(0.0);
        self.matrix[place..].iter_mut().step_by(height).take(size).for_each(|value| *value = 0.0);
        for (values, count) in [(&mut self.columns, height), (&mut self.rows, size)] {
            values.chunks_exact_mut(count).for_each(|values| values[place] = 0.0);
        }
        self.with_pressure[place] = !self.with_pressure[place];
        let others = others.into_iter().map(|other| (std::mem::take(&mut other[place]), other));
        self.push(column, row, others);
    }

    /// Subtracts a column times a row, and from some more columns the column times what they have there.
    fn push<'a>(
        &mut self,
        mut column: Vec<f64>,
        mut row: Vec<f64>,
        others: impl Iterator<Item = (f64, &'a mut Vec<f64>)>,
    ) {
        for (factor, other) in others {
            other.iter_mut().zip(&column).for_each(|(value, c)| *value -= factor * c);
        }
        self.columns.append(&mut column);
        self.rows.append(&mut row);
        if self.rows.len() == BLOCK * self.size {
            self.subtract();
        }
    }

    /// Subtracts all products from the matrix.
    fn subtract(&mut self) {
        let (size, height) = (self.size, self.height());
        let count = self.rows.len() / size.max(1);
        let columns = MatRef::from_column_major_slice(&self.columns, height, count);
        let rows = MatRef::from_row_major_slice(&self.rows, count, size);
        let subtract = |tile: usize, target: &mut [f64]| {
            let width = target.len() / height;
            let rows = rows.subcols(tile * TILE, width);
            let target = MatMut::from_column_major_slice_mut(target, height, width);
            matmul(target, Accum::Add, columns, rows, -1.0, Par::Seq);
        };
        let matrix = &mut self.matrix[..height * size];
        if size < PARALLEL {
            let tiles = matrix.chunks_mut(TILE * height).enumerate();
            tiles.for_each(|(tile, target)| subtract(tile, target));
        } else {
            parallel::for_each_chunk(matrix, TILE * height, subtract);
        }
        self.columns.clear();
        self.rows.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows and columns of `matrix`, one node after the other exchanged as a textbook does it.
    fn exchange(matrix: &mut [Vec<f64>], place: usize) {
        let before = matrix.to_vec();
        let pivot = before[place][place];
        for (i, row) in matrix.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = match (i == place, j == place) {
                    (true, true) => 1.0 / pivot,
                    (true, false) => -before[i][j] / pivot,
                    (false, true) => before[i][j] / pivot,
                    (false, false) => before[i][j] - before[i][place] * before[place][j] / pivot,
                };
            }
        }
    }

    /// More than two blocks of pivots, back and forth, with pressures that follow their gaps in between, and one more
    /// column: entries, columns and sums stay those of the textbook's.
    #[test]
    fn exchanges_are_those_of_the_whole_matrix() {
        for size in [1_usize, 7, 40] {
            let entry = |i: usize, j: usize| {
                let (i, j) = (i.min(j) as f64, i.max(j) as f64);
                if i == j { 60.0 } else { libm::sin(3.0 * i + 7.0 * j * j) }
            };
            let mut rows: Vec<Vec<f64>> =
                (0..size + 2).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect();
            let flat = (0..size).flat_map(|j| (0..size + 2).map(move |i| entry(i, j))).collect();
            let mut answers = Answers::new(flat, vec![false; size]);
            let mut other: Vec<f64> = (0..size + 2).map(|i| i as f64 - 2.0).collect();
            let mut with_other = other.clone();
            for step in 0..80 {
                let place = (step * 29 + 5) % size;
                let mut exchange_both = |rows: &mut [Vec<f64>]| {
                    let factor = with_other[place] / rows[place][place];
                    for (i, value) in with_other.iter_mut().enumerate() {
                        *value =
                            if i == place { -factor } else { *value - factor * rows[i][place] };
                    }
                    exchange(rows, place);
                };
                exchange_both(&mut rows);
                answers.pivot(place, [&mut other]);
                if step % 7 == 3 {
                    // As a pressure the node obeys its law with the stiffness off its diagonal.
                    let stiffness = if step % 2 == 0 { 0.005 } else { -0.005 };
                    exchange_both(&mut rows);
                    rows[place][place] -= stiffness;
                    exchange_both(&mut rows);
                    answers.feed_back(place, stiffness, [&mut other]);
                }
                for j in 0..size {
                    let column = answers.column(j);
                    for (i, row) in rows.iter().enumerate() {
                        // Some dozens of rounding errors of numbers up to 60.
                        assert!((column[i] - row[j]).abs() < 1e-11, "{size} {step}: {i} {j}");
                        assert!((answers.entry(i, j) - row[j]).abs() < 1e-11);
                    }
                }
                for (found, expected) in other.iter().zip(&with_other) {
                    assert!((found - expected).abs() < 1e-11, "{size} {step}");
                }
            }
        }
    }
}
