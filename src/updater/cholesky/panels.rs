//! The lower-triangular factor, stored in panels of rows that are made as it grows.

mod removal;

use faer::MatRef;

use crate::updater::tuning::ROWS;

pub(super) use removal::{Rotation, remove, remove_and, rotate};

/// A lower-triangular matrix L that grows by rows.
///
/// Panel p holds rows `p ROWS ..` up to and including their diagonal block, row by row, so that a
/// new row is one contiguous copy and n rows take n²/2 numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct Panels {
    panels: Vec<Vec<f64>>,
    rows: usize,
}

impl Panels {
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
        blocks.saturating_mul(ROWS * ROWS * size_of::<f64>())
    }

    /// Appends rows, to be filled.
    pub(super) fn push_rows(&mut self, count: usize) {
        self.rows += count;
        for panel in self.panels.len()..self.rows.div_ceil(ROWS) {
            self.panels.push(vec![0.0; ROWS * (panel + 1) * ROWS]);
        }
    }

    /// Keeps the first `rows` rows.
    pub(super) fn truncate(&mut self, rows: usize) {
        self.rows = self.rows.min(rows);
        self.panels.truncate(self.rows.div_ceil(ROWS));
    }

    /// The rows from `first` on, each up to the end of the diagonal block.
    pub(super) fn rows_mut(&mut self, first: usize) -> impl Iterator<Item = &mut [f64]> {
        let panels = self.panels.iter_mut().enumerate().skip(first / ROWS);
        let rows = panels.flat_map(|(p, panel)| panel.chunks_mut((p + 1) * ROWS));
        rows.skip(first % ROWS).take(self.rows - first)
    }

    /// Row r, up to its diagonal.
    pub(super) fn row(&self, r: usize) -> &[f64] {
        let (p, width) = (r / ROWS, (r / ROWS + 1) * ROWS);
        &self.panels[p][r % ROWS * width..][..=r]
    }

    /// Row r, up to the end of the diagonal block.
    fn row_mut(&mut self, r: usize) -> &mut [f64] {
        let (p, width) = (r / ROWS, (r / ROWS + 1) * ROWS);
        &mut self.panels[p][r % ROWS * width..][..width]
    }

    /// Panel p, row by row.
    pub(super) fn panel(&self, p: usize) -> &[f64] {
        &self.panels[p]
    }

    /// Number of rows of panel p that are filled.
    pub(super) fn rows_in(&self, panel: usize) -> usize {
        (self.rows - panel * ROWS).min(ROWS)
    }

    /// The diagonal block of panel p.
    pub(super) fn diagonal(&self, p: usize) -> MatRef<'_, f64> {
        let rows = self.rows_in(p);
        let start = &self.panels[p][p * ROWS..];
        MatRef::from_row_major_slice_with_stride(start, rows, rows, (p + 1) * ROWS)
    }

    /// The rows of panel p left of its diagonal block.
    pub(super) fn left(&self, p: usize) -> MatRef<'_, f64> {
        let panel = &self.panels[p];
        MatRef::from_row_major_slice_with_stride(panel, self.rows_in(p), p * ROWS, (p + 1) * ROWS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of 256 × 256 numbers: one of the first panel, two of the second.
    #[test]
    fn bytes_are_those_of_whole_blocks() {
        let block = 256 * 256 * 8;
        for (rows, blocks) in [(0, 0), (1, 1), (256, 1), (257, 3), (512, 3), (513, 6)] {
            assert_eq!(Panels::bytes(rows), blocks * block, "{rows}");
        }
        // More than any machine has.
        assert!(Panels::bytes(usize::MAX) > usize::MAX / 2);
    }

    /// Row r of 600, filled with r up to its diagonal.
    fn filled() -> Panels {
        let mut panels = Panels::default();
        for (count, rows) in [(200, 200), (100, 300), (300, 600)] {
            panels.push_rows(count);
            assert_eq!(panels.rows(), rows);
        }
        for (r, row) in panels.rows_mut(0).enumerate() {
            row[..=r].fill(r as f64);
        }
        panels
    }

    #[test]
    fn rows_lie_in_panels() {
        let mut panels = filled();
        assert_eq!(panels.len(), 3);
        assert_eq!([0, 1, 2].map(|p| panels.rows_in(p)), [256, 256, 88]);
        assert_eq!([0, 1, 2].map(|p| panels.panel(p).len()), [256 * 256, 512 * 256, 768 * 256]);
        for first in [0, 1, 255, 256, 257, 511, 512, 599, 600] {
            let rows: Vec<(f64, usize)> =
                panels.rows_mut(first).map(|row| (row[0], row.len())).collect();
            let expected: Vec<(f64, usize)> =
                (first..600).map(|r| (r as f64, (r / 256 + 1) * 256)).collect();
            assert_eq!(rows, expected);
        }
        for p in 0..3 {
            let (diagonal, left) = (panels.diagonal(p), panels.left(p));
            let rows = panels.rows_in(p);
            assert_eq!((diagonal.nrows(), diagonal.ncols()), (rows, rows));
            assert_eq!((left.nrows(), left.ncols()), (rows, 256 * p));
            for r in 0..rows {
                let value = (256 * p + r) as f64;
                assert_eq!((diagonal[(r, 0)], diagonal[(r, r)]), (value, value));
                if p > 0 {
                    assert_eq!((left[(r, 0)], left[(r, 256 * p - 1)]), (value, value));
                }
                // Above the diagonal there is nothing.
                if r + 1 < rows {
                    assert_eq!(diagonal[(r, r + 1)], 0.0);
                }
            }
        }
    }

    #[test]
    fn what_is_cut_is_given_back() {
        for (rows, panels_left) in
            [(700, 3), (513, 3), (512, 2), (257, 2), (256, 1), (1, 1), (0, 0)]
        {
            let mut panels = filled();
            panels.truncate(rows);
            assert_eq!((panels.rows(), panels.len()), (rows.min(600), panels_left));
            assert_eq!(panels.rows_mut(0).count(), rows.min(600));
        }
    }
}
