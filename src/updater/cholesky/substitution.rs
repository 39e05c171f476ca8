//! Backward substitution of a few right-hand sides, at the speed of memory.
//!
//! The factor is read once for all right-hand sides, in groups of panels. While one thread solves the
//! triangle of a group, the others multiply the rest of the group before, so that nobody waits.

use std::ops::{Deref, Range};

use super::operations;
use super::panels::Panels;
use super::products::subtract_transposed;
use crate::parallel::{self, vectorized};
use crate::updater::tuning::{COLUMNS_AT_ONCE, GROUP, ROWS, SMALL};

/// Rows of a group of panels.
const GROUP_ROWS: usize = GROUP * ROWS;

impl Panels {
    /// Solves `Lᵀ x = b` in place for right-hand sides of the same length, with the leading part
    /// of L that has as many rows.
    pub(super) fn solve_transposed<const N: usize>(&self, x: [&mut [f64]; N]) {
        if length(&x) > 2 * GROUP_ROWS {
            parallel::inside(|| self.solve_groups_transposed(x));
        } else {
            // No panel lies beyond the neighbouring group: there is nothing to share.
            self.solve_groups_transposed(x);
        }
    }

    fn solve_groups_transposed<const N: usize>(&self, mut x: [&mut [f64]; N]) {
        let count = length(&x);
        let Some(last) = count.div_ceil(GROUP_ROWS).checked_sub(1) else {
            return;
        };
        let triangle = x.each_mut().map(|x| &mut x[last * GROUP_ROWS..count]);
        self.solve_group_transposed(last, triangle);
        for group in (1..=last).rev() {
            let start = group * GROUP_ROWS;
            let end = count.min(start + GROUP_ROWS);
            let known = rows(&x, start..end);
            let subtract = |first: usize, x: &mut [&mut [f64]; N]| {
                for (p, known) in (group * GROUP..).zip(known.chunks(ROWS)) {
                    self.subtract_panel(p, first, known, x);
                }
            };
            let near = start - GROUP_ROWS;
            let mut rest = x.each_mut().map(|x| &mut x[..start]);
            let mut far = Vec::new();
            for first in (0..near).step_by(COLUMNS_AT_ONCE) {
                let part = rest.each_mut().map(|x| x.split_off_mut(..COLUMNS_AT_ONCE));
                far.push((first, part.map(Option::unwrap_or_default)));
            }
            let next = || {
                subtract(near, &mut rest);
                self.solve_group_transposed(group - 1, rest);
            };
            if far.is_empty() {
                next();
                continue;
            }
            let work = operations::reading(known.len(), near);
            parallel::join(next, || {
                parallel::for_each(work, &mut far, |(first, x)| subtract(*first, x));
            });
        }
    }

    /// The same with the triangle of a group alone, for the unknowns from its beginning on.
    fn solve_group_transposed<const N: usize>(&self, group: usize, mut x: [&mut [f64]; N]) {
        let count = length(&x);
        for panel in (0..count.div_ceil(ROWS)).rev() {
            let (p, start) = (group * GROUP + panel, panel * ROWS);
            let end = count.min(start + ROWS);
            self.solve_triangle_transposed(p, x.each_mut().map(|x| &mut x[start..end]));
            let known = rows(&x, start..end);
            let mut before = x.each_mut().map(|x| &mut x[..start]);
            self.subtract_panel(p, group * GROUP_ROWS, &known, &mut before);
        }
    }

    /// x −= Lᵀ y with the rows of panel p, from column `first` on.
    fn subtract_panel<const N: usize>(
        &self,
        p: usize,
        first: usize,
        y: &[[f64; N]],
        x: &mut [&mut [f64]; N],
    ) {
        let x = x.each_mut().map(|x| &mut **x);
        subtract_transposed(&self.panel(p)[first..], (p + 1) * ROWS, y, x);
    }

    /// Solves `Lᵀ x = b` in place with the triangle of panel p alone: small triangles one after the other,
    /// so that most of it is products of several rows at a time.
    fn solve_triangle_transposed<const N: usize>(&self, p: usize, mut x: [&mut [f64]; N]) {
        let (panel, width) = (&self.panel(p)[p * ROWS..], (p + 1) * ROWS);
        let mut end = length(&x);
        while let Some(last) = end.checked_sub(1) {
            let start = last / SMALL * SMALL;
            let block = &panel[start * width..];
            let small = x.each_mut().map(|x| &mut x[start..end]);
            solve_small_transposed(&block[start..], width, small);
            let known = rows(&x, start..end);
            let before = x.each_mut().map(|x| &mut x[..start]);
            subtract_transposed(block, width, &known, before);
            end = start;
        }
    }
}

/// Solves `Lᵀ x = b` in place with a small triangle L, whose rows are `width` apart.
fn solve_small_transposed<const N: usize>(l: &[f64], width: usize, mut x: [&mut [f64]; N]) {
    let count = length(&x);
    vectorized(
        #[inline(always)]
        || {
            for r in (0..count).rev() {
                let row = &l[r * width..][..=r];
                // All right-hand sides together: each waits for its quotient.
                for x in &mut x {
                    let (earlier, here) = x.split_at_mut(r);
                    here[0] /= row[r];
                    for (x, l) in earlier.iter_mut().zip(row) {
                        *x -= *l * here[0];
                    }
                }
            }
        },
    );
}

/// Some of the unknowns, row by row.
fn rows<const N: usize>(x: &[&mut [f64]; N], range: Range<usize>) -> Vec<[f64; N]> {
    range.map(|k| x.each_ref().map(|x| x[k])).collect()
}

/// The length of the shortest.
fn length<X: Deref<Target = [f64]>>(x: &[X]) -> usize {
    x.iter().map(|x| x.len()).min().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small triangles, panels and groups of them, at their borders; with three groups threads share the work. The
    /// factor is that of many more rows. Its diagonal is 4, and beside it are powers of 1/2: each solution, of small
    /// integers, comes back but for a few rounding errors.
    #[test]
    fn factors_are_solved_backwards() {
        let entry = |r: usize, c: usize| match r - c {
            0 => 4.0,
            d if (r + 3 * c).is_multiple_of(5) => (-(d.min(40) as f64)).exp2(),
            d => -0.5 * (-(d.min(40) as f64)).exp2(),
        };
        let rows = 2 * GROUP_ROWS + ROWS + 40;
        let mut panels = Panels::default();
        panels.push_rows(rows);
        for (r, row) in panels.rows_mut(0).enumerate() {
            for (c, value) in row[..=r].iter_mut().enumerate() {
                *value = entry(r, c);
            }
        }
        for count in [
            0,
            1,
            31,
            32,
            33,
            65,
            ROWS,
            ROWS + 1,
            GROUP_ROWS,
            GROUP_ROWS + 1,
            2 * GROUP_ROWS,
            2 * GROUP_ROWS + 1,
            rows,
        ] {
            let x = |k: usize, c: usize| ((c * (k + 3) + k) % 9) as f64 - 4.0;
            let mut solved: [Vec<f64>; 2] = [0, 1].map(|k| {
                let product = |c: usize| (c..count).map(|r| entry(r, c) * x(k, r)).sum();
                (0..count).map(product).collect()
            });
            let [first, second] = &mut solved;
            panels.solve_transposed([first, second]);
            for (k, values) in solved.iter().enumerate() {
                for (c, value) in values.iter().enumerate() {
                    // Rows below a diagonal of 4 sum up to 1: errors of 10⁻¹⁵ do not grow.
                    assert!((value - x(k, c)).abs() < 1e-13, "{count}: {c} {value}");
                }
            }
        }
    }
}
