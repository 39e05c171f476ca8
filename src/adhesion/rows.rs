//! What is known of the rows of a window beside their matrix.

use super::soft::Half;

/// What the rows of a window do to soft nodes.
#[derive(Default)]
pub(super) struct Rows {
    /// The columns of the soft nodes: of sums of pressures and of gaps, and behind them of some nodes.
    pub(super) half: Half,
    nodes: Vec<usize>,
    /// By row: its column in `half`.
    pub(super) columns: Vec<usize>,
    /// By row: 1, or −1 where what is given of it lowers the pressures of soft nodes as its column raises them.
    pub(super) signs: Vec<f64>,
}

impl Rows {
    /// Makes nodes of a grid of so many the rows; returns those that have no column yet, with their places, in the
    /// order in which their columns have to follow.
    pub(super) fn append(
        &mut self,
        nodes: &[usize],
        places: &[usize],
        grid: usize,
    ) -> Vec<(usize, usize)> {
        let mut columns = vec![None; grid];
        self.nodes.iter().zip(2..).for_each(|(&node, column)| columns[node] = Some(column));
        let mut new = Vec::new();
        self.columns.clear();
        for (&node, &place) in nodes.iter().zip(places) {
            self.columns.push(columns[node].unwrap_or_else(|| {
                new.push((node, place));
                self.nodes.push(node);
                self.nodes.len() + 1
            }));
        }
        new
    }

    /// Appends the factors of all columns for what is given of the rows.
    pub(super) fn factors(&self, given: &[f64], factors: &mut Vec<f64>) {
        let first = factors.len();
        factors.resize(first + self.half.width(), 0.0);
        for ((column, sign), given) in self.columns.iter().zip(&self.signs).zip(given) {
            factors[first + column] = sign * given;
        }
    }
}
