//! The lower-triangular factor, stored in panels of rows that are made as it grows.

use std::array;

use faer::MatRef;

use super::precision::Precision;
use crate::parallel::{self, vectorized};

/// Rows of a panel: large enough that products of blocks run at the speed of plain GEMM, small
/// enough that the unused upper half of the diagonal blocks does not matter.
pub(super) const ROWS: usize = 256;
/// Unknowns that one thread updates at a time in a backward substitution: enough for rows of L to
/// stream from memory, few enough to stay in cache.
const COLUMNS_AT_ONCE: usize = 1024;
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

    /// The same with every number changed; a panel is dropped as soon as it is replaced.
    pub(super) fn map<R>(self, change: impl Fn(T) -> R) -> Panels<R> {
        let panel = |panel: Vec<T>| panel.into_iter().map(&change).collect();
        Panels {
            panels: self.panels.into_iter().map(panel).collect(),
            rows: self.rows,
        }
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
    ///
    /// While one thread subtracts a panel, another already solves the triangle of the panel before.
    pub(super) fn solve_transposed<const N: usize>(&self, mut x: [&mut [T]; N]) {
        let count = x.iter().map(|x| x.len()).min().unwrap_or_default();
        let Some(last) = count.div_ceil(ROWS).checked_sub(1) else {
            return;
        };
        let triangle = x.each_mut().map(|x| &mut x[last * ROWS..count]);
        self.solve_triangle_transposed(last, triangle);
        for p in (1..=last).rev() {
            let (panel, width) = (&self.panels[p], (p + 1) * ROWS);
            let mut known = [[T::default(); N]; ROWS];
            for (i, x) in x.iter().enumerate() {
                for (known, x) in known.iter_mut().zip(&x[p * ROWS..count]) {
                    known[i] = *x;
                }
            }
            let known = &known[..(count - p * ROWS).min(ROWS)];
            let subtract = |first: usize, x: [&mut [T]; N]| {
                let x = x.map(|x| x.as_chunks_mut().0);
                vectorized(
                    #[inline(always)]
                    || subtract_rows(&panel[first..], width, known, x),
                );
            };
            let triangle = (p - 1) * ROWS;
            // A little more costs less than another thread.
            let near = if triangle < COLUMNS_AT_ONCE {
                0
            } else {
                triangle
            };
            let mut rest = x.each_mut().map(|x| &mut x[..p * ROWS]);
            let mut far = Vec::new();
            for first in (0..near).step_by(COLUMNS_AT_ONCE) {
                let length = COLUMNS_AT_ONCE.min(near - first);
                let part = rest.each_mut().map(|x| x.split_off_mut(..length));
                far.push((first, part.map(Option::unwrap_or_default)));
            }
            parallel::join(
                || {
                    subtract(near, rest.each_mut().map(|x| &mut **x));
                    let triangle = rest.map(|x| &mut x[triangle - near..]);
                    self.solve_triangle_transposed(p - 1, triangle);
                },
                || {
                    parallel::for_each(&mut far, |(first, x)| {
                        subtract(*first, x.each_mut().map(|x| &mut **x));
                    });
                },
            );
        }
    }

    /// Solves $L^T x = b$ in place with the triangle of panel p alone.
    fn solve_triangle_transposed<const N: usize>(&self, p: usize, x: [&mut [T]; N]) {
        let (panel, width) = (&self.panels[p], (p + 1) * ROWS);
        vectorized(
            #[inline(always)]
            || {
                for x in x {
                    for r in (0..x.len()).rev() {
                        let row = &panel[r * width + p * ROWS..][..=r];
                        x[r] /= row[r];
                        let (earlier, last) = x.split_at_mut(r);
                        for (x, l) in earlier.iter_mut().zip(row) {
                            *x -= *l * last[0];
                        }
                    }
                }
            },
        );
    }

    /// Solves $L x = b$ in place, with the leading part of L that has as many rows as x; b is zero
    /// before the row `from`.
    ///
    /// While one thread solves the triangle of a panel, another already multiplies the next panel
    /// with what is known.
    pub(super) fn solve<const N: usize>(&self, mut x: [&mut [T]; N], from: usize) {
        let count = x.iter().map(|x| x.len()).min().unwrap_or_default();
        let (first, panels) = (from / ROWS, count.div_ceil(ROWS));
        let mut products = [[T::default(); N]; ROWS];
        for p in first..panels {
            let start = p * ROWS;
            let split = x.each_mut().map(|x| {
                let (known, unknown) = x[..count].split_at_mut(start);
                let end = unknown.len().min(ROWS);
                (&known[first * ROWS..], &mut unknown[..end])
            });
            let known = split.each_ref().map(|(known, _)| *known);
            let unknown = split.map(|(_, unknown)| unknown);
            let mut next = [[T::default(); N]; ROWS];
            parallel::join(
                || self.solve_triangle(p, &products, known, unknown),
                || {
                    let rows = count.saturating_sub(start + ROWS).min(ROWS);
                    self.multiply(p + 1, first * ROWS, known, &mut next[..rows]);
                },
            );
            products = next;
        }
    }

    /// Products of the first rows of panel p, from column `first` on, with known unknowns.
    fn multiply<const N: usize>(
        &self,
        p: usize,
        first: usize,
        known: [&[T]; N],
        products: &mut [[T; N]],
    ) {
        let Some(panel) = self.panels.get(p) else {
            return;
        };
        let length = known.iter().map(|x| x.len()).min().unwrap_or_default();
        let row = |r: usize| &panel[r * (p + 1) * ROWS + first..][..length];
        parallel::for_each_chunk(products, ROWS_AT_ONCE, |chunk, products| {
            vectorized(
                #[inline(always)]
                || {
                    for (r, product) in products.iter_mut().enumerate() {
                        *product = dots(row(chunk * ROWS_AT_ONCE + r), known);
                    }
                },
            );
        });
    }

    /// Solves $L x = b$ in place with the rows of panel p, of which `products` has those with all
    /// unknowns that are known but the last [`ROWS`].
    fn solve_triangle<const N: usize>(
        &self,
        p: usize,
        products: &[[T; N]; ROWS],
        known: [&[T]; N],
        mut x: [&mut [T]; N],
    ) {
        let (panel, start) = (&self.panels[p], p * ROWS);
        let near = known.map(|known| &known[known.len().saturating_sub(ROWS)..]);
        let length = near.iter().map(|x| x.len()).min().unwrap_or_default();
        let rows = x.iter().map(|x| x.len()).min().unwrap_or_default();
        vectorized(
            #[inline(always)]
            || {
                for (r, product) in products.iter().take(rows).enumerate() {
                    let row = &panel[r * (p + 1) * ROWS..][..=start + r];
                    let solved = x.each_ref().map(|x| &x[..r]);
                    let outside = dots(&row[start - length..start], near);
                    let inside = dots(&row[start..start + r], solved);
                    for (i, x) in x.iter_mut().enumerate() {
                        x[r] -= (product[i] + outside[i]) + inside[i];
                        x[r] /= row[start + r];
                    }
                }
            },
        );
    }
}

/// Numbers that are multiplied at a time: two to four of the widest vectors.
const LANES: usize = 32;
/// Numbers of a row that stay in the fastest cache while they meet several vectors.
const PIECE: usize = 1024;

/// x −= Lᵀ y for N right-hand sides, with the rows of L `width` apart: four rows at a time, so that
/// x passes the cache a quarter as often.
#[inline(always)]
fn subtract_rows<T: Precision, const N: usize>(
    panel: &[T],
    width: usize,
    y: &[[T; N]],
    mut x: [&mut [[T; LANES]]; N],
) {
    let chunks = x.iter().map(|x| x.len()).min().unwrap_or_default();
    let row = |r: usize| &panel[r * width..].as_chunks::<LANES>().0[..chunks];
    let (blocks, rest) = y.as_chunks::<4>();
    for (block, [y0, y1, y2, y3]) in blocks.iter().enumerate() {
        let rows = array::from_fn::<_, 4, _>(|r| row(4 * block + r));
        for chunk in 0..chunks {
            let [l0, l1, l2, l3] = rows.map(|row| &row[chunk]);
            for (i, x) in x.iter_mut().enumerate() {
                let x = &mut x[chunk];
                for k in 0..LANES {
                    x[k] -= (y0[i] * l0[k] + y1[i] * l1[k]) + (y2[i] * l2[k] + y3[i] * l3[k]);
                }
            }
        }
    }
    for (r, y) in rest.iter().enumerate() {
        for (chunk, l) in row(4 * blocks.len() + r).iter().enumerate() {
            for (x, y) in x.iter_mut().zip(y) {
                for (x, l) in x[chunk].iter_mut().zip(l) {
                    *x -= *y * *l;
                }
            }
        }
    }
}

/// Dot products of a row with each of some vectors of the same length, in 32 partial sums, in
/// an order that does not depend on the processor.
#[inline(always)]
fn dots<T: Precision, const N: usize>(row: &[T], x: [&[T]; N]) -> [T; N] {
    let mut sums = [[T::default(); LANES]; N];
    let whole = row.len() / LANES * LANES;
    // Piece by piece, so that the row is read from memory once for all vectors.
    for start in (0..whole).step_by(PIECE) {
        let piece = start..whole.min(start + PIECE);
        for (sums, x) in sums.iter_mut().zip(x) {
            add_products(sums, &row[piece.clone()], &x[piece.clone()]);
        }
    }
    array::from_fn(|i| {
        let ends = row[whole..].iter().zip(&x[i][whole..]);
        let end = ends.fold(T::default(), |sum, (a, b)| sum + *a * *b);
        sums[i].into_iter().fold(end, |sum, lane| sum + lane)
    })
}

/// Adds the products of a and b to the sums, lane by lane.
#[inline(always)]
fn add_products<T: Precision>(sums: &mut [T; LANES], a: &[T], b: &[T]) {
    let mut lanes = *sums;
    for (a, b) in a
        .as_chunks::<LANES>()
        .0
        .iter()
        .zip(b.as_chunks::<LANES>().0)
    {
        for ((lane, a), b) in lanes.iter_mut().zip(a).zip(b) {
            *lane += *a * *b;
        }
    }
    *sums = lanes;
}
