//! Removal of rows and columns from the matrix of a factor.

use super::Panels;
use crate::parallel::{self, vectorized};
use crate::updater::cholesky::operations;
use crate::updater::tuning::{ROTATED, ROTATED_COLUMNS};

/// (c, s) of a plane rotation.
pub(in crate::updater::cholesky) type Rotation = (f64, f64);

/// (l, x) ← (c l + s x, c x − s l), for several at a time.
#[inline(always)]
pub(in crate::updater::cholesky) fn rotate<const N: usize>(
    (c, s): Rotation,
    l: &mut [f64; N],
    x: &mut [f64; N],
) {
    for (l, x) in l.iter_mut().zip(x) {
        let (before_l, before_x) = (*l, *x);
        *l = c * before_l + s * before_x;
        *x = c * before_x - s * before_l;
    }
}

/// Removes the rows and columns at `positions` (ascending) of `C = L Lᵀ`.
///
/// The rows above the first of them stay. A row below loses its entries x in the removed columns, which leaves `L Lᵀ +
/// Σ x xᵀ` to be factored: for each remaining column one rotation with each removed one before it makes x vanish (Gill,
/// Golub, Murray, Saunders 1974). Nothing is ever subtracted, so that the new factor is as accurate as the old one.
/// Some 3 m (n − k)² flops for m rows from the one at k on; the factor passes the cache once.
pub(in crate::updater::cholesky) fn remove(panels: &mut Panels, positions: &[usize]) {
    remove_and(panels, positions, |_| {});
}

/// The same, with what else is to be done with the rotations of each remaining column behind the first that goes, one
/// with each removed column before it.
pub(in crate::updater::cholesky) fn remove_and(
    panels: &mut Panels,
    positions: &[usize],
    mut each: impl FnMut(Vec<Rotation>),
) {
    let Some(&first) = positions.first() else {
        return;
    };
    let rows = panels.rows;
    let is_kept = |row: &usize| positions.binary_search(row).is_err();
    let kept: Vec<usize> = (first..rows).filter(is_kept).collect();
    let mut blocks = blocks(panels, first, positions);
    for (chunk, columns) in kept.chunks(ROTATED_COLUMNS).enumerate() {
        let start = chunk * ROTATED_COLUMNS / ROTATED;
        let (triangle, below) = blocks[start..].split_at_mut(columns.len().div_ceil(ROTATED));
        let mut rotations = Vec::with_capacity(columns.len());
        for (block, own) in triangle.iter_mut().zip((0..).step_by(ROTATED)) {
            block.rotate(&rotations, &columns[..own]);
            block.triangle(&mut rotations, &columns[own..], positions);
        }
        let work = operations::rotations(below.len() * ROTATED, columns.len(), positions.len());
        parallel::for_each(work, below, |block| block.rotate(&rotations, columns));
        rotations.into_iter().for_each(&mut each);
    }
    let mut values = Vec::with_capacity(rows);
    for (to, &from) in (first..).zip(&kept) {
        values.clear();
        let row = panels.row_mut(from);
        values.extend_from_slice(&row[..first]);
        values.extend(kept[..=to - first].iter().map(|&column| row[column]));
        panels.row_mut(to)[..values.len()].copy_from_slice(&values);
    }
    panels.truncate(rows - positions.len());
}

/// The rows from `first` on that are kept, in blocks.
fn blocks<'a>(panels: &'a mut Panels, first: usize, positions: &[usize]) -> Vec<Block<'a>> {
    let rows = (first..).zip(panels.rows_mut(first));
    let mut kept = rows.filter(|(row, _)| positions.binary_search(row).is_err()).peekable();
    let mut blocks = Vec::new();
    while kept.peek().is_some() {
        let rows: Vec<_> = kept.by_ref().take(ROTATED).map(|(_, row)| row).collect();
        let removed = positions.iter().map(|&column| {
            let mut x = [0.0; ROTATED];
            for (x, row) in x.iter_mut().zip(&rows) {
                // The row may end before that column, or be zero there.
                *x = row.get(column).copied().unwrap_or_default();
            }
            x
        });
        blocks.push(Block { removed: removed.collect(), rows });
    }
    blocks
}

/// Some rows that are rotated side by side.
struct Block<'a> {
    rows: Vec<&'a mut [f64]>,
    /// What is left of their entries in the removed columns.
    removed: Vec<[f64; ROTATED]>,
}

impl Block<'_> {
    /// Applies the rotations of some columns.
    fn rotate(&mut self, rotations: &[Vec<Rotation>], columns: &[usize]) {
        let Self { rows, removed } = self;
        let mut values: Vec<[f64; ROTATED]> = vec![[0.0; ROTATED]; columns.len()];
        for (lane, row) in rows.iter().enumerate() {
            for (values, &column) in values.iter_mut().zip(columns) {
                values[lane] = row[column];
            }
        }
        vectorized(
            #[inline(always)]
            || {
                for (values, rotations) in values.iter_mut().zip(rotations) {
                    let mut l = *values;
                    for (rotation, x) in rotations.iter().zip(&mut *removed) {
                        rotate(*rotation, &mut l, x);
                    }
                    *values = l;
                }
            },
        );
        for (lane, row) in rows.iter_mut().enumerate() {
            for (values, &column) in values.iter().zip(columns) {
                row[column] = values[lane];
            }
        }
    }

    /// The same with the rows' own columns, the rotations of which they give: the block's rows begin at the first of
    /// `columns`.
    fn triangle(
        &mut self,
        rotations: &mut Vec<Vec<Rotation>>,
        columns: &[usize],
        positions: &[usize],
    ) {
        let before = rotations.len();
        for (lane, row) in self.rows.iter_mut().enumerate() {
            for (rotations, &column) in rotations[before..].iter().zip(columns) {
                for (rotation, x) in rotations.iter().zip(&mut self.removed) {
                    let (mut l, mut own) = ([row[column]], [x[lane]]);
                    rotate(*rotation, &mut l, &mut own);
                    (row[column], x[lane]) = (l[0], own[0]);
                }
            }
            let column = columns[lane];
            let active = positions.partition_point(|&position| position < column);
            let vanish = self.removed[..active].iter_mut().map(|x| {
                let (diagonal, x) = (row[column], &mut x[lane]);
                let root = libm::hypot(diagonal, *x);
                let rotation = (diagonal / root, *x / root);
                (row[column], *x) = (root, 0.0);
                rotation
            });
            let own = vanish.collect();
            rotations.push(own);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::updater::dominant;

    /// The textbook factor of the given rows and columns.
    fn factor(kept: &[usize]) -> Vec<Vec<f64>> {
        let mut l: Vec<Vec<f64>> = Vec::new();
        for (r, &i) in kept.iter().enumerate() {
            let mut row: Vec<f64> = Vec::with_capacity(r + 1);
            for (c, &j) in kept[..r].iter().enumerate() {
                let products: f64 = row.iter().zip(&l[c]).map(|(a, b)| a * b).sum();
                row.push((dominant(i, j) - products) / l[c][c]);
            }
            let squares: f64 = row.iter().map(|a| a * a).sum();
            row.push((dominant(i, i) - squares).sqrt());
            l.push(row);
        }
        l
    }

    #[test]
    fn the_factor_that_is_left_is_that_of_the_matrix_that_is_left() {
        // Panels have 256 rows: across a border, at it, and at both ends; one at a time, and many.
        let many: Vec<usize> = (0..300).filter(|row| row % 7 < 3).collect();
        let last: Vec<usize> = (20..300).collect();
        for (size, removals) in [
            (300, &[&[0][..], &[298], &[17], &[254, 255], &[255], &[256]][..]),
            (257, &[&[3], &[0], &[100]]),
            (40, &[&[39], &[0, 15, 16, 37], &[3], &[]]),
            (1, &[&[0]]),
            (300, &[&many, &[5, 100]]),
            (300, &[&last, &[0]]),
        ] {
            let mut kept: Vec<usize> = (0..size).collect();
            let l = factor(&kept);
            let mut panels = Panels::default();
            panels.push_rows(size);
            for (row, values) in panels.rows_mut(0).zip(&l) {
                row[..values.len()].copy_from_slice(values);
            }
            for positions in removals {
                for &k in positions.iter().rev() {
                    kept.remove(k);
                }
                remove(&mut panels, positions);
                let l = factor(&kept);
                assert_eq!(panels.rows(), kept.len());
                // The condition number is 1; a few hundred rounding errors of entries up to 20.
                let rows: Vec<Vec<f64>> = panels.rows_mut(0).map(|row| row.to_vec()).collect();
                for (row, values) in rows.iter().zip(&l) {
                    for (a, b) in row.iter().zip(values) {
                        assert!((a - b).abs() < 1e-13, "{size}, {positions:?}: {a} {b}");
                    }
                }
            }
        }
    }
}
