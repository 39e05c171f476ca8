//! The nodes of the window that touched, and the Cholesky factor of their Schur complement.

use super::{Schur, System};
use crate::Error;
use crate::parallel::vectorized;

/// The nodes of the present window that touched, in that order, with the partial Cholesky factor
/// of the Schur complement S of the watched nodes, pivots in the same order.
///
/// With the watched nodes i and the events t, $S = R R^T$ on the nodes that touched;
/// [`factor`](Self::factor)`(i, t)` is $R_{it}$. Appended to the forward-substituted columns
/// $F = L^{-1} C_{IP}$, row i of R completes the row of node i in the factor of the grown contact
/// set if the node touched, and its forward-substituted column if it did not. This is eqs. (15)-(16)
/// of the paper, for a block of nodes.
#[derive(Debug, Clone, Default)]
pub struct Touched {
    watched: usize,
    nodes: Vec<usize>,
    positions: Vec<usize>,
    /// R, `watched` rows, one column for each event.
    factor: Vec<f64>,
    /// The reduced right-hand sides at the moment of each event, divided by its pivot's root.
    rhs: Vec<[f64; System::RHS]>,
    /// Events that are subtracted from the Schur complement already.
    subtracted: usize,
}

/// Events that are subtracted from the whole Schur complement at a time. Those since then are
/// subtracted from one column after the other: together they are least work where a column of so
/// many events stays in the fastest cache.
const BLOCK: usize = 32;

impl Touched {
    /// Number of nodes that touched.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether no watched node has touched yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Node indices, in the order in which they touched.
    #[must_use]
    pub fn nodes(&self) -> &[usize] {
        &self.nodes
    }

    /// Their places among the watched nodes.
    #[must_use]
    pub fn positions(&self) -> &[usize] {
        &self.positions
    }

    /// The first `count` of the committed nodes and, after them, those that touched.
    ///
    /// # Errors
    ///
    /// [`Error::LengthMismatch`] if there are fewer.
    pub(crate) fn sequence(&self, committed: &[usize], count: usize) -> Result<Vec<usize>, Error> {
        let expected = committed.len() + self.len();
        if count > expected {
            return Err(Error::LengthMismatch {
                expected,
                found: count,
            });
        }
        let nodes = committed.iter().chain(&self.nodes);
        Ok(nodes.copied().take(count).collect())
    }

    /// Whether the watched node at `position` touched.
    pub(crate) fn has_touched(&self, position: usize) -> bool {
        self.positions.contains(&position)
    }

    /// Number of watched nodes.
    #[must_use]
    pub fn watched(&self) -> usize {
        self.watched
    }

    /// $R_{it}$ for the watched node i and event t, 0 where there is none. For a node that touched
    /// at event τ only t ≤ τ means anything.
    #[must_use]
    pub fn factor(&self, position: usize, event: usize) -> f64 {
        if position >= self.watched {
            return 0.0;
        }
        let index = event
            .checked_mul(self.watched)
            .and_then(|k| k.checked_add(position));
        index
            .and_then(|k| self.factor.get(k))
            .copied()
            .unwrap_or(0.0)
    }

    /// The entries that event t adds to $L^{-1} B$, for each right-hand side.
    #[must_use]
    pub fn rhs(&self, event: usize) -> Option<[f64; System::RHS]> {
        self.rhs.get(event).copied()
    }

    /// Forgets all events and prepares for a window of `watched` nodes.
    pub(crate) fn reset(&mut self, watched: usize) {
        self.watched = watched;
        self.nodes.clear();
        self.positions.clear();
        self.factor.clear();
        self.rhs.clear();
        self.subtracted = 0;
        // So that no event ever allocates.
        self.nodes.reserve(watched);
        self.positions.reserve(watched);
        self.rhs.reserve(watched);
        self.factor.reserve(watched * watched);
    }

    /// Eliminates the node at `position`: appends its column of R.
    ///
    /// `reduced` are the right-hand sides of the watched nodes, from which the node is eliminated too.
    /// Returns the entries that the event adds to $L^{-1} B$.
    ///
    /// # Errors
    ///
    /// The pivot, if it is not positive; then nothing has changed.
    pub(crate) fn push(
        &mut self,
        schur: &mut Schur,
        node: usize,
        position: usize,
        reduced: &mut [[f64; System::RHS]],
    ) -> Result<[f64; System::RHS], f64> {
        let k = self.watched;
        let start = self.factor.len();
        self.factor.resize(start + k, 0.0);
        let (earlier, column) = self.factor.split_at_mut(start);
        schur.copy_column(position, column);
        vectorized(
            #[inline(always)]
            || subtract_products(&earlier[self.subtracted * k..], column, position),
        );
        let pivot = column[position];
        if pivot.is_nan() || pivot <= 0.0 {
            self.factor.truncate(start);
            return Err(pivot);
        }
        let root = pivot.sqrt();
        for value in &mut *column {
            *value /= root;
        }
        column[position] = root;
        self.nodes.push(node);
        self.positions.push(position);
        let entries = reduced[position].map(|value| value / root);
        self.rhs.push(entries);
        for (reduced, factor) in reduced.iter_mut().zip(&*column) {
            for (value, entry) in reduced.iter_mut().zip(entries) {
                *value -= factor * entry;
            }
        }
        if self.len() - self.subtracted == BLOCK {
            schur.add_gram(-1.0, &self.factor[self.subtracted * k..]);
            self.subtracted = self.len();
        }
        Ok(entries)
    }

    /// Forgets all but the first events, which `schur` does as well.
    pub(crate) fn truncate(&mut self, schur: &mut Schur, events: usize) {
        if events < self.subtracted {
            let forgotten = events * self.watched..self.subtracted * self.watched;
            schur.add_gram(1.0, &self.factor[forgotten]);
            self.subtracted = events;
        }
        self.nodes.truncate(events);
        self.positions.truncate(events);
        self.rhs.truncate(events);
        self.factor.truncate(events * self.watched);
    }

    /// $x \leftarrow R_{tt}^{-1} x$ on the first events.
    pub(crate) fn solve<const N: usize>(&self, x: &mut [[f64; N]]) {
        for t in 0..x.len() {
            let column = self.column(t);
            let (earlier, later) = x.split_at_mut(t + 1);
            let here = &mut earlier[t];
            *here = here.map(|value| value / column[self.positions[t]]);
            for (&position, later) in self.positions[t + 1..].iter().zip(later) {
                for (value, here) in later.iter_mut().zip(&*here) {
                    *value -= column[position] * here;
                }
            }
        }
    }

    /// $x \leftarrow R_{tt}^{-T} x$ on the first events.
    pub(crate) fn solve_transposed<const N: usize>(&self, x: &mut [[f64; N]]) {
        for t in (0..x.len()).rev() {
            let column = self.column(t);
            let (earlier, later) = x.split_at_mut(t + 1);
            let here = &mut earlier[t];
            for (&position, later) in self.positions[t + 1..].iter().zip(later) {
                for (value, later) in here.iter_mut().zip(later) {
                    *value -= column[position] * *later;
                }
            }
            *here = here.map(|value| value / column[self.positions[t]]);
        }
    }

    /// Column of event t of R.
    pub(crate) fn column(&self, event: usize) -> &[f64] {
        &self.factor[event * self.watched..(event + 1) * self.watched]
    }
}

/// column −= Σ_t R_t R[row, t], four events at a time: `column` then passes the cache a quarter as
/// often, and the sum keeps a fixed order.
#[inline(always)]
fn subtract_products(events: &[f64], column: &mut [f64], row: usize) {
    let k = column.len();
    let mut blocks = events.chunks_exact(4 * k);
    for block in &mut blocks {
        let (c0, rest) = block.split_at(k);
        let (c1, rest) = rest.split_at(k);
        let (c2, c3) = rest.split_at(k);
        let (a0, a1, a2, a3) = (c0[row], c1[row], c2[row], c3[row]);
        for ((((value, x0), x1), x2), x3) in column.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
            *value -= (a0 * x0 + a1 * x1) + (a2 * x2 + a3 * x3);
        }
    }
    for event in blocks.remainder().chunks_exact(k) {
        let a = event[row];
        for (value, x) in column.iter_mut().zip(event) {
            *value -= a * x;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::updater::dominant;

    /// Watched nodes: more than a block of events, and a part of one.
    const WATCHED: usize = 2 * BLOCK + 6;

    fn schur() -> Schur {
        let mut schur = Schur::default();
        schur.resize(WATCHED);
        let mut matrix = schur.matrix_mut();
        for j in 0..WATCHED {
            for i in 0..WATCHED {
                // Nothing above the diagonal may be read.
                matrix[(i, j)] = if i < j { f64::NAN } else { dominant(i, j) };
            }
        }
        schur
    }

    fn push(touched: &mut Touched, schur: &mut Schur, positions: &[usize]) {
        let mut reduced = [[1.0; System::RHS]; WATCHED];
        for &position in positions {
            touched
                .push(schur, position, position, &mut reduced)
                .unwrap();
        }
    }

    #[test]
    fn the_factor_is_that_of_the_schur_complement_also_after_events_are_forgotten() {
        // All positions, in an order without order.
        let order: Vec<usize> = (0..WATCHED).map(|t| (t * 29 + 5) % WATCHED).collect();
        let other: Vec<usize> = order[..10]
            .iter()
            .chain(order[10..].iter().rev())
            .copied()
            .collect();
        let (mut touched, mut schur) = (Touched::default(), schur());
        touched.reset(WATCHED);
        push(&mut touched, &mut schur, &order);
        for (events, order) in [(WATCHED, &order), (10, &other)] {
            touched.truncate(&mut schur, events);
            push(&mut touched, &mut schur, &order[events..]);
            for (last, &i) in order.iter().enumerate() {
                for (events, &j) in order.iter().enumerate() {
                    let both = 0..=last.min(events);
                    let products = both.map(|t| touched.factor(i, t) * touched.factor(j, t));
                    // A few dozen roundings of numbers up to 400.
                    let error = products.sum::<f64>() - dominant(i, j);
                    assert!(error.abs() < 1e-12, "{i} {j} {error}");
                }
            }
        }
    }
}
