//! The lower-triangular factor, stored in panels of rows that are made as it grows.

mod removal;

use faer::MatRef;

pub(super) use removal::{Rotations, remove};

/// Rows of a panel: large enough that products of blocks run at the speed of plain GEMM, small
/// enough that the unused upper half of the diagonal blocks does not matter.
pub(super) const ROWS: usize = 256;

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
