//! The lower-triangular factor, stored in panels of rows that are made as it grows.

mod removal;

use std::array;

use faer::MatRef;

use super::precision::Precision;
use crate::parallel::{self, vectorized};
pub(super) use removal::Rotations;

/// Rows of a panel: large enough that products of blocks run at the speed of plain GEMM, small
/// enough that the unused upper half of the diagonal blocks does not matter.
pub(super) const ROWS: usize = 256;
/// Unknowns that one thread updates at a time in a backward substitution.
const CHUNK: usize = 1024;
/// Rows that one thread multiplies at a time in a forward substitution.
const ROWS_AT_ONCE: usize = 16;

/// A lower-triangular matrix L that grows by rows.
///
/// Panel p holds rows `p ROWS ..` up to and including their diagonal block, row by row, so that a
/// new row is one contiguous copy and n rows take n²/2 numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels<T> {
    panels: Vec<Vec<T>>,
    rows: usize,
}

impl<T: Precision> Panels<T> {
    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Number of panels.
    pub(super) fn len(&self) -> usize {
        self.panels.len()
    }

    /// Bytes that `rows` rows take.
    pub(super) fn bytes(rows: usize) -> usize {
        let panels = rows.div_ceil(ROWS);
        let blocks = panels.saturating_mul(panels + 1) / 2;
        blocks.saturating_mul(ROWS * ROWS * size_of::<T>())
    }

    /// Appends rows, to be filled.
    pub(super) fn push_rows(&mut self, count: usize) {
        self.rows += count;
        for panel in self.panels.len()..self.rows.div_ceil(ROWS) {
            self.panels
                .push(vec![T::default(); ROWS * (panel + 1) * ROWS]);
        }
    }

    /// The rows from `first` on, each up to the end of the diagonal block.
    pub(super) fn rows_mut(&mut self, first: usize) -> impl Iterator<Item = &mut [T]> {
        let panels = self.panels.iter_mut().enumerate().skip(first / ROWS);
        let rows = panels.flat_map(|(p, panel)| panel.chunks_mut((p + 1) * ROWS));
        rows.skip(first % ROWS).take(self.rows - first)
    }

    /// Number of rows of panel p that are filled.
    pub(super) fn rows_in(&self, panel: usize) -> usize {
        (self.rows - panel * ROWS).min(ROWS)
    }

    /// The diagonal block of panel p.
    pub(super) fn diagonal(&self, p: usize) -> MatRef<'_, T> {
        let rows = self.rows_in(p);
        let start = &self.panels[p][p * ROWS..];
        MatRef::from_row_major_slice_with_stride(start, rows, rows, (p + 1) * ROWS)
    }

    /// The rows of panel p left of its diagonal block.
    pub(super) fn left(&self, p: usize) -> MatRef<'_, T> {
        let panel = &self.panels[p];
        MatRef::from_row_major_slice_with_stride(panel, self.rows_in(p), p * ROWS, (p + 1) * ROWS)
    }

    /// Solves $L^T x = b$ in place for right-hand sides of the same length, with the leading part
    /// of L that has as many rows. Each panel is read once, for all.
    pub(super) fn solve_transposed<const N: usize>(&self, mut x: [&mut [T]; N]) {
        let count = x.iter().map(|x| x.len()).min().unwrap_or_default();
        let panels = self.panels.iter().enumerate();
        for (p, panel) in panels.take(count.div_ceil(ROWS)).rev() {
            let width = (p + 1) * ROWS;
            let mut above = Vec::with_capacity(N);
            let here = x.each_mut().map(|x| {
                let (x_above, here) = x.split_at_mut(p * ROWS);
                above.push(x_above.chunks_mut(CHUNK));
                let rows = here.len().min(ROWS);
                let here = &mut here[..rows];
                for r in (0..rows).rev() {
                    let row = &panel[r * width + p * ROWS..][..=r];
                    here[r] /= row[r];
                    let (earlier, last) = here.split_at_mut(r);
                    for (x, l) in earlier.iter_mut().zip(row) {
                        *x -= *l * last[0];
                    }
                }
                &*here
            });
            // One task for a range of columns and all right-hand sides: the panel is read once.
            let mut tasks: Vec<[&mut [T]; N]> = Vec::new();
            while let Some(first) = above.first_mut().and_then(Iterator::next) {
                let mut first = Some(first);
                let mut rest = above[1..].iter_mut();
                tasks.push(array::from_fn(|_| {
                    first
                        .take()
                        .or_else(|| rest.next()?.next())
                        .unwrap_or_default()
                }));
            }
            parallel::for_each_chunk(&mut tasks, 1, |task, x| {
                let panel = &panel[task * CHUNK..];
                for (x, y) in x.iter_mut().flatten().zip(here) {
                    vectorized(|| subtract_rows(panel, width, y, x));
                }
            });
        }
    }

    /// Solves $L x = b$ in place, with the leading part of L that has as many rows as x; b is zero
    /// before the row `from`.
    pub(super) fn solve<const N: usize>(&self, x: [&mut [T]; N], from: usize) {
        let count = x.iter().map(|x| x.len()).min().unwrap_or_default();
        let first = from / ROWS;
        let panels = self.panels.iter().enumerate().skip(first);
        for (p, panel) in panels.take(count.div_ceil(ROWS).saturating_sub(first)) {
            let width = (p + 1) * ROWS;
            let rows = (count - p * ROWS).min(ROWS);
            let mut products = [[T::default(); N]; ROWS];
            let columns = first * ROWS..p * ROWS;
            let known = array::from_fn::<_, N, _>(|i| &x[i][columns.clone()]);
            parallel::for_each_chunk(&mut products[..rows], ROWS_AT_ONCE, |chunk, products| {
                vectorized(|| {
                    for (r, products) in products.iter_mut().enumerate() {
                        let row = &panel[(chunk * ROWS_AT_ONCE + r) * width..][columns.clone()];
                        *products = known.map(|x| dot(row, x));
                    }
                });
            });
            for r in 0..rows {
                let row = &panel[r * width + p * ROWS..][..=r];
                for (i, product) in products[r].into_iter().enumerate() {
                    let x = &mut x[i][p * ROWS..];
                    x[r] -= product + dot(&row[..r], &x[..r]);
                    x[r] /= row[r];
                }
            }
        }
    }
}

/// x −= Lᵀ y, with the rows of L `width` apart: four rows at a time, so that x passes the cache a
/// quarter as often.
#[inline(always)]
fn subtract_rows<T: Precision>(panel: &[T], width: usize, y: &[T], x: &mut [T]) {
    let columns = x.len();
    let row = |r: usize| &panel[r * width..][..columns];
    let whole = y.len() / 4 * 4;
    for r in (0..whole).step_by(4) {
        let y = &y[r..r + 4];
        let rows = row(r)
            .iter()
            .zip(row(r + 1))
            .zip(row(r + 2))
            .zip(row(r + 3));
        for ((((l0, l1), l2), l3), x) in rows.zip(x.iter_mut()) {
            *x -= (y[0] * *l0 + y[1] * *l1) + (y[2] * *l2 + y[3] * *l3);
        }
    }
    for (r, y) in y.iter().enumerate().skip(whole) {
        for (l, x) in row(r).iter().zip(x.iter_mut()) {
            *x -= *y * *l;
        }
    }
}

/// A dot product in sixteen partial sums, in an order that does not depend on the processor.
#[inline(always)]
fn dot<T: Precision>(a: &[T], b: &[T]) -> T {
    const LANES: usize = 16;
    let mut sums = [T::default(); LANES];
    let (a_lanes, b_lanes) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = a_lanes.remainder().iter().zip(b_lanes.remainder());
    for (a, b) in a_lanes.zip(b_lanes) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += *a * *b;
        }
    }
    let rest = rest.fold(T::default(), |sum, (a, b)| sum + *a * *b);
    sums.into_iter().fold(rest, |sum, lane| sum + lane)
}
