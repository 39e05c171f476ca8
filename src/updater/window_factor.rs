//! The nodes of the window that touched, and the Cholesky factor of their Schur complement.

use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::{Mat, Par};

use super::Schur;
use super::tuning::BLOCK;
use crate::Error;
use crate::parallel::vectorized;

/// The watched nodes that touched, in that order, with the partial Cholesky factor of the Schur complement
/// S, pivots in the same order.
///
/// With the watched nodes i and the events t, `S = R Rᵀ` on the nodes that touched;
/// [`factor`](Self::factor)`(i, t)` is `R_it`. Appended to the forward-substituted columns
/// `F = L⁻¹ C_IP`, row i of R completes the row of node i in the factor of the grown contact if the node
/// touched, and its forward-substituted column if it did not: eqs. (15)-(16) of the paper, for a block of
/// nodes.
#[derive(Debug, Clone, Default)]
pub struct WindowFactor {
    watched: usize,
    positions: Vec<usize>,
    /// The signs D of the pivots: `S = R D Rᵀ`. All are positive where nodes only touch.
    signs: Vec<f64>,
    /// R, `watched` rows, one column for each event.
    factor: Vec<f64>,
    /// Events that are subtracted from the Schur complement already.
    subtracted: usize,
}

impl WindowFactor {
    /// Lets the watched nodes at `positions` touch in that order, one after the other.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if a pivot is not positive, and [`Error::LengthMismatch`] for a
    /// position that is not there or comes twice.
    pub fn of(schur: Schur, positions: &[usize]) -> Result<Self, Error> {
        Self::with_signs(schur, positions, |_| 1.0)
    }

    /// The same of a matrix whose pivots have signs, 1 or −1.
    pub(crate) fn with_signs(
        mut schur: Schur,
        positions: &[usize],
        sign: impl Fn(usize) -> f64,
    ) -> Result<Self, Error> {
        let mut touched = Self::default();
        touched.reset(schur.size(), positions.len().min(schur.size()));
        for &position in positions {
            if position >= schur.size() || touched.has_touched(position) {
                return Err(Error::LengthMismatch { expected: schur.size(), found: position });
            }
            let pushed = touched.push(&mut schur, position, sign(position));
            pushed.map_err(|_| Error::FactorizationFailed { nodes: positions.len() })?;
        }
        Ok(touched)
    }

    /// Number of nodes that touched.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether no watched node has touched.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The places of the nodes that touched among the watched ones, in the order of touching.
    #[must_use]
    pub fn positions(&self) -> &[usize] {
        &self.positions
    }

    /// Whether the watched node at `position` touched.
    pub(crate) fn has_touched(&self, position: usize) -> bool {
        self.positions.contains(&position)
    }

    /// Bytes of a Schur complement of `watched` nodes and of its factor.
    pub(crate) fn bytes(watched: usize) -> usize {
        let matrix = watched.saturating_mul(watched);
        matrix.saturating_mul(2 * size_of::<f64>())
    }

    /// Number of watched nodes.
    #[must_use]
    pub fn watched(&self) -> usize {
        self.watched
    }

    /// `R_it` for the watched node i and event t, 0 where there is none. For a node that touched
    /// at event τ only t ≤ τ means anything.
    #[must_use]
    pub fn factor(&self, position: usize, event: usize) -> f64 {
        if position >= self.watched {
            return 0.0;
        }
        let index = event.checked_mul(self.watched).and_then(|k| k.checked_add(position));
        index.and_then(|k| self.factor.get(k)).copied().unwrap_or(0.0)
    }

    /// Forgets all events and prepares for up to `events` in a window of `watched` nodes.
    pub(crate) fn reset(&mut self, watched: usize, events: usize) {
        self.watched = watched;
        self.positions.clear();
        self.signs.clear();
        self.factor.clear();
        self.subtracted = 0;
        // So that events do not allocate columns.
        self.positions.reserve(events);
        self.signs.reserve(events);
        self.factor.reserve(events * watched);
    }

    /// Eliminates the node at `position`, whose pivot has a sign, 1 or −1, and returns its column of R.
    ///
    /// # Errors
    ///
    /// The pivot times that sign, if it is not positive; then nothing has changed.
    pub(crate) fn push(
        &mut self,
        schur: &mut Schur,
        position: usize,
        sign: f64,
    ) -> Result<&[f64], f64> {
        let k = self.watched;
        let start = self.factor.len();
        self.factor.resize(start + k, 0.0);
        let (earlier, column) = self.factor.split_at_mut(start);
        schur.copy_column(position, column);
        vectorized(
            #[inline(always)]
            || {
                subtract_products(
                    &earlier[self.subtracted * k..],
                    &self.signs[self.subtracted..],
                    column,
                    position,
                )
            },
        );
        let pivot = sign * column[position];
        if pivot.is_nan() || pivot <= 0.0 {
            self.factor.truncate(start);
            return Err(pivot);
        }
        let root = pivot.sqrt();
        for value in &mut *column {
            *value /= root;
        }
        column[position] = sign * root;
        self.positions.push(position);
        self.signs.push(sign);
        if self.len() - self.subtracted == BLOCK {
            self.finish(schur);
        }
        Ok(&self.factor[start..])
    }

    /// Forgets all but the first events. No event can follow if more have been subtracted from the Schur complement.
    pub(crate) fn truncate(&mut self, events: usize) {
        self.positions.truncate(events);
        self.signs.truncate(events);
        self.factor.truncate(events * self.watched);
    }

    /// `x ← R_tt⁻¹ x` on the first events.
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

    /// `x ← (R D Rᵀ)⁻¹ x` on all events.
    pub(crate) fn solve_both<const N: usize>(&self, x: &mut [[f64; N]]) {
        self.solve(x);
        self.solve_back(x);
    }

    /// `x ← (D Rᵀ)⁻¹ x` on all events.
    pub(crate) fn solve_back<const N: usize>(&self, x: &mut [[f64; N]]) {
        for (values, sign) in x.iter_mut().zip(&self.signs) {
            *values = values.map(|value| value * sign);
        }
        for t in (0..x.len()).rev() {
            let column = self.column(t);
            let (earlier, later) = x.split_at_mut(t + 1);
            let here = &mut earlier[t];
            for (&position, later) in self.positions[t + 1..].iter().zip(later) {
                for (value, later) in here.iter_mut().zip(&*later) {
                    *value -= column[position] * later;
                }
            }
            *here = here.map(|value| value / column[self.positions[t]]);
        }
    }

    /// The matrix of the nodes at `stay` (ascending) and, behind them, of those of the events, all of which left a
    /// contact: from the Schur complement S once all events have been subtracted. With R of those that stay and R₁ of
    /// those that left, their pressures given and no longer their gaps,
    ///
    /// ```text
    /// S    R R₁⁻¹
    ///      R₁⁻ᵀ R₁⁻¹
    /// ```
    ///
    /// # Errors
    ///
    /// As for [`Schur::resize`].
    pub(crate) fn opened(&self, schur: &Schur, stay: &[usize]) -> Result<Schur, Error> {
        let (count, events, size) = (stay.len(), self.len(), stay.len() + self.len());
        let mut opened = schur.part(stay, size)?;
        let own = Mat::from_fn(events, events, |i, t| {
            if t <= i { self.column(t)[self.positions[i]] } else { 0.0 }
        });
        // Row by row (R R₁⁻¹)ᵀ, and R₁⁻ᵀ behind it.
        let mut solved = Mat::from_fn(events, size, |t, i| match stay.get(i) {
            Some(&place) => self.column(t)[place],
            None => f64::from(u8::from(i - count == t)),
        });
        solve_upper_triangular_in_place(own.transpose(), solved.as_mut(), Par::Seq);
        let inverse = solved.subcols(count, events);
        // Column i is row i of R₁⁻¹.
        let corner = inverse * inverse.transpose();
        let mut matrix = opened.matrix_mut();
        for t in 0..events {
            for i in 0..count {
                matrix[(count + t, i)] = solved[(t, i)];
            }
            for i in t..events {
                matrix[(count + i, count + t)] = corner[(i, t)];
            }
        }
        Ok(opened)
    }

    /// Subtracts the events from the whole Schur complement, from which they have been subtracted in part. No event can
    /// follow.
    pub(crate) fn finish(&mut self, schur: &mut Schur) {
        let mut rest = &self.factor[self.subtracted * self.watched..];
        for equal in self.signs[self.subtracted..].chunk_by(|a, b| a == b) {
            let (columns, later) = rest.split_at(equal.len() * self.watched);
            schur.add_gram(-equal[0], columns);
            rest = later;
        }
        self.subtracted = self.len();
    }

    /// Column of event t of R.
    pub(crate) fn column(&self, event: usize) -> &[f64] {
        &self.factor[event * self.watched..(event + 1) * self.watched]
    }
}

/// column −= Σ_t D_t R_t R[row, t], four events at a time: `column` then passes the cache a quarter as
/// often, and the sum keeps a fixed order.
#[inline(always)]
fn subtract_products(events: &[f64], signs: &[f64], column: &mut [f64], row: usize) {
    let k = column.len();
    let blocks = events.chunks_exact(4 * k);
    let single = blocks.remainder();
    let (signs, single_signs) = signs.split_at(signs.len() / 4 * 4);
    for (block, signs) in blocks.zip(signs.chunks_exact(4)) {
        let (c0, rest) = block.split_at(k);
        let (c1, rest) = rest.split_at(k);
        let (c2, c3) = rest.split_at(k);
        let factor = |t: usize, column: &[f64]| signs[t] * column[row];
        let (a0, a1, a2, a3) = (factor(0, c0), factor(1, c1), factor(2, c2), factor(3, c3));
        for ((((value, x0), x1), x2), x3) in column.iter_mut().zip(c0).zip(c1).zip(c2).zip(c3) {
            *value -= (a0 * x0 + a1 * x1) + (a2 * x2 + a3 * x3);
        }
    }
    for (event, sign) in single.chunks_exact(k).zip(single_signs) {
        let a = sign * event[row];
        for (value, x) in column.iter_mut().zip(event) {
            *value -= a * x;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::updater::dominant;

    /// Watched nodes: more than a block of events, and a part of one.
    const WATCHED: usize = 2 * BLOCK + 6;

    fn schur() -> Schur {
        let mut schur = Schur::default();
        schur.resize(WATCHED).unwrap();
        let mut matrix = schur.matrix_mut();
        for j in 0..WATCHED {
            for i in 0..WATCHED {
                // Nothing above the diagonal may be read.
                matrix[(i, j)] = if i < j { f64::NAN } else { dominant(i, j) };
            }
        }
        schur
    }

    #[test]
    fn the_factor_is_that_of_the_schur_complement() {
        // All positions, in an order without order.
        let order: Vec<usize> = (0..WATCHED).map(|t| (t * 29 + 5) % WATCHED).collect();
        let touched = WindowFactor::of(schur(), &order).unwrap();
        for (last, &i) in order.iter().enumerate() {
            for (events, &j) in order.iter().enumerate() {
                let both = 0..=last.min(events);
                let products = both.map(|t| touched.factor(i, t) * touched.factor(j, t));
                // A few dozen rounding errors of numbers up to 400.
                let error = products.sum::<f64>() - dominant(i, j);
                assert!(error.abs() < 1e-12, "{i} {j} {error}");
            }
        }
    }

    #[test]
    fn positions_that_cannot_be_are_refused() {
        for positions in [vec![WATCHED], vec![3, 3]] {
            assert!(WindowFactor::of(schur(), &positions).is_err());
        }
    }

    /// `(4, 2; 2, 5)`, of which (2, 1) and (·, 2) are the columns of the factor.
    fn two_by_two() -> Schur {
        let mut schur = Schur::default();
        schur.resize(2).unwrap();
        schur.as_mut_slice().copy_from_slice(&[4.0, 2.0, f64::NAN, 5.0]);
        schur
    }

    #[test]
    fn factors_solve() {
        let touched = WindowFactor::of(two_by_two(), &[0, 1]).unwrap();
        assert_eq!(
            [touched.factor(0, 0), touched.factor(1, 0), touched.factor(1, 1)],
            [2.0, 1.0, 2.0]
        );
        let mut x = [[2.0, 4.0], [5.0, 6.0]];
        touched.solve(&mut x);
        // 2/2 and (5 − 1)/2; 4/2 and (6 − 2)/2.
        assert_eq!(x, [[1.0, 2.0], [2.0, 2.0]]);
        let mut first = [[8.0]];
        touched.solve(&mut first);
        assert_eq!(first, [[4.0]]);
        // No such node, no such event.
        assert_eq!(
            [touched.factor(2, 0), touched.factor(0, 2), touched.factor(1, usize::MAX)],
            [0.0; 3]
        );
        assert_eq!((touched.len(), touched.watched(), touched.is_empty()), (2, 2, false));
    }

    /// `(4, 2; 2, 5)` times (1, 2) and (3, −1), in either order of the nodes.
    #[test]
    fn factors_solve_for_the_whole_matrix() {
        let (x, b) = ([[1.0, 3.0], [2.0, -1.0]], [[8.0, 10.0], [12.0, 1.0]]);
        for order in [[0, 1], [1, 0]] {
            let factor = WindowFactor::of(two_by_two(), &order).unwrap();
            let mut found = order.map(|node| b[node]);
            factor.solve_both(&mut found);
            for (found, expected) in found.concat().iter().zip(order.map(|node| x[node]).concat()) {
                // Rounding errors of numbers up to 12.
                assert!((found - expected).abs() < 1e-14, "{found} {expected}");
            }
        }
        let mut first = [[8.0]];
        let factor = WindowFactor::of(two_by_two(), &[0]).unwrap();
        factor.solve_both(&mut first);
        assert_eq!(first, [[2.0]]);
    }

    /// After any number of events, in blocks and beside them, the Schur complement is that of the nodes that have not
    /// touched; once.
    #[test]
    fn all_events_are_subtracted_in_the_end() {
        let order: Vec<usize> = (0..WATCHED).map(|t| (t * 29 + 5) % WATCHED).collect();
        let part = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| dominant(rows[i], columns[j]))
        };
        for events in [0, 1, BLOCK - 1, BLOCK, BLOCK + 3, 2 * BLOCK] {
            let (done, open) = order.split_at(events);
            let (mut schur, mut factor) = (schur(), WindowFactor::default());
            factor.reset(WATCHED, WATCHED);
            for &position in done {
                factor.push(&mut schur, position, 1.0).unwrap();
            }
            let coupling = part(done, open);
            let solved = part(done, done).cholesky().unwrap().solve(&coupling);
            let expected = part(open, open) - coupling.transpose() * solved;
            for _ in 0..2 {
                factor.finish(&mut schur);
                let found =
                    DMatrix::from_fn(open.len(), open.len(), |i, j| schur.entry(open[i], open[j]));
                // A few dozen rounding errors of numbers up to 400.
                let error = (found - &expected).amax();
                assert!(error < 1e-12, "{events}: {error:e}");
            }
        }
    }

    #[test]
    fn events_that_are_forgotten_can_be_others() {
        let mut schur = two_by_two();
        let mut touched = WindowFactor::default();
        touched.reset(2, 2);
        assert!(touched.is_empty() && !touched.has_touched(1));
        touched.push(&mut schur, 1, 1.0).unwrap();
        touched.push(&mut schur, 0, 1.0).unwrap();
        assert!(touched.has_touched(0) && touched.has_touched(1));
        touched.truncate(1);
        assert_eq!(touched.positions(), [1]);
        assert!(!touched.has_touched(0));
        assert_eq!([touched.factor(1, 0), touched.factor(0, 1)], [5.0_f64.sqrt(), 0.0]);
        touched.push(&mut schur, 0, 1.0).unwrap();
        // 4 − 2²/5.
        assert!((touched.factor(0, 1) - 3.2_f64.sqrt()).abs() < 1e-15);
        touched.reset(3, 3);
        assert_eq!((touched.watched(), touched.len()), (3, 0));
    }

    /// What is left of a pivot is 1 − 1, 1/2 − 1, or no number at all. Then the node has not touched.
    #[test]
    fn pivots_are_positive() {
        for (own, pivot) in [(1.0, 0.0), (0.5, -0.5), (f64::NAN, f64::NAN)] {
            let mut schur = two_by_two();
            schur.as_mut_slice()[3] = own;
            let mut touched = WindowFactor::default();
            touched.reset(2, 2);
            touched.push(&mut schur, 0, 1.0).unwrap();
            let refused = touched.push(&mut schur, 1, 1.0).unwrap_err();
            assert!(refused == pivot || refused.is_nan() && pivot.is_nan(), "{refused}");
            assert_eq!((touched.len(), touched.factor(1, 1)), (1, 0.0));
        }
    }

    /// Two matrices of 7 × 7 numbers.
    #[test]
    fn bytes_are_those_of_matrix_and_factor() {
        assert_eq!(
            [WindowFactor::bytes(0), WindowFactor::bytes(7), WindowFactor::bytes(usize::MAX)],
            [0, 784, usize::MAX]
        );
    }

    /// Nodes that leave a contact, more than a block of them among others: the matrix behind that is the one which a
    /// dense inverse of the rest of the contact gives, of nodes out of contact, of those that stay in it, and of those
    /// that left.
    #[test]
    fn nodes_that_leave_are_opened() {
        let (inside, outside) = (BLOCK + 12, 7);
        let part = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| dominant(rows[i], columns[j]))
        };
        // What pressures of nodes out of a contact and gaps of nodes in it make of gaps and pressures.
        let answers = |contact: &[usize], watched: &[usize]| {
            let is_in = |node: usize| contact.contains(&node);
            let coupling = DMatrix::from_fn(contact.len(), watched.len(), |i, j| {
                let (node, other) = (contact[i], watched[j]);
                if is_in(other) {
                    f64::from(u8::from(node == other))
                } else {
                    dominant(node, other)
                }
            });
            let own = DMatrix::from_fn(watched.len(), watched.len(), |i, j| {
                let is_outside = !is_in(watched[i]) && !is_in(watched[j]);
                if is_outside { dominant(watched[i], watched[j]) } else { 0.0 }
            });
            let solved = part(contact, contact).cholesky().unwrap().solve(&coupling);
            own - coupling.transpose() * solved
        };
        let contact: Vec<usize> = (0..inside).collect();
        // In no order; three in contact are not watched.
        let watched: Vec<usize> = (0..inside + outside)
            .map(|k| (k * 29 + 5) % (inside + outside))
            .filter(|k| k % 17 != 4)
            .collect();
        let watched_inside: Vec<usize> =
            (0..watched.len()).rev().filter(|&place| watched[place] < inside).collect();
        for events in [0, 1, 3, BLOCK, BLOCK + 5, watched_inside.len()] {
            let before = answers(&contact, &watched);
            let mut schur = Schur::default();
            schur.resize(watched.len()).unwrap();
            schur.matrix_mut().copy_from(&before);
            let leaves = &watched_inside[..events];
            let mut left = WindowFactor::default();
            left.reset(watched.len(), events);
            for &place in leaves {
                left.push(&mut schur, place, -1.0).unwrap();
            }
            left.finish(&mut schur);
            let stay: Vec<usize> =
                (0..watched.len()).filter(|place| !leaves.contains(place)).collect();
            let found = left.opened(&schur, &stay).unwrap();
            let order: Vec<usize> =
                stay.iter().chain(leaves).map(|&place| watched[place]).collect();
            let gone: Vec<usize> = leaves.iter().map(|&place| watched[place]).collect();
            let rest: Vec<usize> =
                contact.iter().copied().filter(|node| !gone.contains(node)).collect();
            let expected = answers(&rest, &order);
            assert_eq!(found.size(), order.len());
            for j in 0..order.len() {
                for i in j..order.len() {
                    // Some dozens of rounding errors of numbers up to 400; pivots of a condition of 1.3.
                    let error = found.entry(i, j) - expected[(i, j)];
                    assert!(error.abs() < 1e-11, "{events}: {i} {j} {error:e}");
                }
            }
        }
    }
}
