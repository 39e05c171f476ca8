//! Removal of a row and column from the matrix of a factor.

use super::Panels;
use crate::parallel::vectorized;
use crate::updater::tuning::ROTATED;

/// The plane rotations (c, s) that take a removed column of L into its place.
#[derive(Debug)]
pub(in crate::updater::cholesky) struct Rotations {
    first: usize,
    rotations: Vec<(f64, f64)>,
}

impl Rotations {
    /// Removes the entry of the removed row from `x = L⁻¹ b`.
    pub(in crate::updater::cholesky) fn remove<const N: usize>(&self, x: &mut Vec<[f64; N]>) {
        if self.first >= x.len() {
            return;
        }
        let mut removed = x.remove(self.first);
        for (rotation, values) in self.rotations.iter().zip(&mut x[self.first..]) {
            rotate(*rotation, values, &mut removed);
        }
    }
}

/// (l, x) ← (c l + s x, c x − s l), for several at a time.
#[inline(always)]
fn rotate<const N: usize>((c, s): (f64, f64), l: &mut [f64; N], x: &mut [f64; N]) {
    for (l, x) in l.iter_mut().zip(x) {
        let (before_l, before_x) = (*l, *x);
        *l = c * before_l + s * before_x;
        *x = c * before_x - s * before_l;
    }
}

/// Removes row and column `k` of `C = L Lᵀ`.
///
/// The rows above `k` stay. Those below lose their entry x in column `k`, which leaves
/// `L Lᵀ + x xᵀ` to be factored: one rotation for each remaining column makes x vanish
/// (Gill, Golub, Murray, Saunders 1974). Nothing is ever subtracted, so that the new factor is as
/// accurate as the old one. Some 3 (n − k)² flops.
pub(in crate::updater::cholesky) fn remove(panels: &mut Panels, k: usize) -> Rotations {
    let rows = panels.rows;
    let mut rotations = Vec::with_capacity(rows.saturating_sub(k + 1));
    // Some rows side by side, from their new column k on.
    let mut block = vec![[0.0; ROTATED]; rows.saturating_sub(k)];
    let mut left = Vec::with_capacity(ROTATED * k);
    for first in (k + 1..rows).step_by(ROTATED) {
        let count = ROTATED.min(rows - first);
        let known = rotations.len();
        let mut removed = [0.0; ROTATED];
        left.clear();
        for (b, row) in panels.rows_mut(first).take(count).enumerate() {
            left.extend_from_slice(&row[..k]);
            removed[b] = row[k];
            for (values, value) in block.iter_mut().zip(&row[k + 1..=first + b]) {
                values[b] = *value;
            }
        }
        vectorized(
            #[inline(always)]
            || {
                for (rotation, values) in rotations.iter().zip(&mut block) {
                    rotate(*rotation, values, &mut removed);
                }
            },
        );
        for b in 0..count {
            let (before, here) = block[known..].split_at_mut(b);
            let mut x = [removed[b]];
            for (rotation, values) in rotations[known..].iter().zip(before) {
                let mut l = [values[b]];
                rotate(*rotation, &mut l, &mut x);
                values[b] = l[0];
            }
            let (diagonal, x) = (here[0][b], x[0]);
            let root = libm::hypot(diagonal, x);
            here[0][b] = root;
            rotations.push((diagonal / root, x / root));
        }
        for (b, row) in panels.rows_mut(first - 1).take(count).enumerate() {
            row[..k].copy_from_slice(&left[b * k..(b + 1) * k]);
            for (value, values) in row[k..first + b].iter_mut().zip(&block) {
                *value = values[b];
            }
        }
    }
    panels.truncate(rows.saturating_sub(1));
    Rotations { first: k, rotations }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::updater::dominant;

    /// The textbook factor and L⁻¹b, of the given rows and columns.
    fn factor(kept: &[usize]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut l: Vec<Vec<f64>> = Vec::new();
        let mut x: Vec<f64> = Vec::new();
        for (r, &i) in kept.iter().enumerate() {
            let mut row: Vec<f64> = Vec::with_capacity(r + 1);
            for (c, &j) in kept[..r].iter().enumerate() {
                let products: f64 = row.iter().zip(&l[c]).map(|(a, b)| a * b).sum();
                row.push((dominant(i, j) - products) / l[c][c]);
            }
            let squares: f64 = row.iter().map(|a| a * a).sum();
            row.push((dominant(i, i) - squares).sqrt());
            let known: f64 = row.iter().zip(&x).map(|(a, b)| a * b).sum();
            x.push(((i as f64).cos() - known) / row[r]);
            l.push(row);
        }
        (l, x)
    }

    #[test]
    fn the_factor_that_is_left_is_that_of_the_matrix_that_is_left() {
        // Panels have 256 rows: across a border, at it, and at both ends.
        for (size, removals) in [
            (300, &[0, 298, 17, 254, 255, 255, 256][..]),
            (257, &[3, 0, 100]),
            (40, &[39, 37, 0, 15, 16]),
            (1, &[0]),
        ] {
            let mut kept: Vec<usize> = (0..size).collect();
            let (l, x) = factor(&kept);
            let mut panels = Panels::default();
            panels.push_rows(size);
            for (row, values) in panels.rows_mut(0).zip(&l) {
                row[..values.len()].copy_from_slice(values);
            }
            let mut x: Vec<[f64; 1]> = x.into_iter().map(|value| [value]).collect();
            for &k in removals {
                kept.remove(k);
                remove(&mut panels, k).remove(&mut x);
                let (l, expected) = factor(&kept);
                assert_eq!(panels.rows(), kept.len());
                // The condition number is 1; a few hundred rounding errors of entries up to 20.
                let rows: Vec<Vec<f64>> = panels.rows_mut(0).map(|row| row.to_vec()).collect();
                for (row, values) in rows.iter().zip(&l) {
                    for (a, b) in row.iter().zip(values) {
                        assert!((a - b).abs() < 1e-13, "{size}, {k}: {a} {b}");
                    }
                }
                assert_eq!(x.len(), expected.len());
                for ([a], b) in x.iter().zip(&expected) {
                    assert!((a - b).abs() < 1e-14, "{size}, {k}: {a} {b}");
                }
            }
        }
    }
}
