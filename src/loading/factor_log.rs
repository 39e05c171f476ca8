//! How a factor grew, for making it again.

use crate::contact::ContactSequence;
use crate::updater::{JOINED, Left, LinearUpdater, Schur, WindowFactor};
use crate::{Error, Problem, UpdaterError};

/// The windows in which a factor grew, and the nodes that left it. Made again by the same steps it has the same
/// numbers, bit for bit; in other blocks it would round otherwise.
///
/// It takes a few whole numbers for each node in contact.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct FactorLog {
    /// The nodes that were watched, one window after the other.
    pub(crate) watched: Vec<usize>,
    /// Which of them joined, in the order of joining.
    pub(crate) joined: Vec<usize>,
    /// For each window how many were watched, how many of them joined, and how many of these stayed.
    pub(crate) windows: Vec<[usize; 3]>,
    /// For each node that left how many windows came before, and its place in the order of contact.
    pub(crate) left: Vec<[usize; 2]>,
    /// For each window in which nodes yielded how many windows came before, and how many they were: those of them that
    /// had touched before left at once, and others of the window joined.
    pub(crate) yielded: Vec<[usize; 2]>,
}

/// One window of a log.
struct LoggedWindow<'a> {
    watched: &'a [usize],
    joined: &'a [usize],
    stayed: usize,
}

impl FactorLog {
    /// A factor that was made of a contact in blocks, as [`join_all`](crate::updater::join_all) does.
    pub(super) fn of_blocks(order: &[usize]) -> Self {
        let mut log = Self::default();
        for block in order.chunks(JOINED) {
            log.push(block, 0..block.len(), block.len());
        }
        log
    }

    /// Notes a window: its nodes, which of them joined, and how many of these stayed.
    pub(super) fn push(
        &mut self,
        watched: &[usize],
        joined: impl ExactSizeIterator<Item = usize>,
        stayed: usize,
    ) {
        self.windows.push([watched.len(), joined.len(), stayed]);
        self.watched.extend_from_slice(watched);
        self.joined.extend(joined);
    }

    /// Notes a node that left from a place in the order of contact.
    pub(super) fn push_left(&mut self, position: usize) {
        self.left.push([self.windows.len(), position]);
    }

    /// Notes that `count` nodes have yielded, those at some places of the contact among them, and that others joined.
    pub(super) fn push_yielded(
        &mut self,
        count: usize,
        left: impl Iterator<Item = usize>,
        joined: &[usize],
    ) {
        // An empty window, so that nodes that left before do not count as part of this one.
        self.windows.push([0; 3]);
        self.yielded.push([self.windows.len(), count]);
        left.for_each(|position| self.push_left(position));
        for block in joined.chunks(JOINED) {
            self.push(block, 0..block.len(), block.len());
        }
    }

    /// Whether nodes yielded behind so many windows.
    fn yields_behind(&self, windows: usize) -> bool {
        self.yielded.binary_search_by_key(&windows, |[behind, _]| *behind).is_ok()
    }

    /// The places from which nodes left behind so many windows.
    fn left_behind(&self, windows: usize) -> impl Iterator<Item = usize> {
        let first = self.left.partition_point(|[behind, _]| *behind < windows);
        let left = self.left[first..].iter().take_while(move |[behind, _]| *behind == windows);
        left.map(|[_, position]| *position)
    }

    fn windows(&self) -> impl Iterator<Item = LoggedWindow<'_>> {
        let (mut watched, mut joined) = (&self.watched[..], &self.joined[..]);
        self.windows.iter().map(move |&[width, count, stayed]| {
            let (own, others) = watched.split_at(width.min(watched.len()));
            let (events, later) = joined.split_at(count.min(joined.len()));
            (watched, joined) = (others, later);
            LoggedWindow { watched: own, joined: events, stayed: stayed.min(events.len()) }
        })
    }

    /// The nodes of the last window that did not join, in its order.
    pub(super) fn untouched(&self) -> Vec<usize> {
        let Some(LoggedWindow { watched, joined, .. }) = self.windows().last() else {
            return Vec::new();
        };
        let untouched = watched.iter().enumerate().filter(|(place, _)| !joined.contains(place));
        untouched.map(|(_, &node)| node).collect()
    }

    /// How many of the nodes of the last window stayed in contact.
    pub(super) fn last_stayed(&self) -> usize {
        self.windows.last().map_or(0, |[_, _, stayed]| *stayed)
    }

    /// Makes the factor of a contact with an updater that has no node. Returns false, and nothing has happened, if
    /// `budget` bytes are not enough for that.
    ///
    /// # Errors
    ///
    /// [`Error::NodeOutOfGrid`], [`Error::AlreadyInContact`] and [`UpdaterError::UpdaterMismatch`] for a log of another
    /// contact, and those of the updater.
    pub(super) fn replay(
        &self,
        updater: &mut dyn LinearUpdater,
        problem: &Problem,
        contact: &ContactSequence,
        budget: usize,
    ) -> Result<bool, Error> {
        let mut count = 0_usize;
        for (behind, LoggedWindow { watched, stayed, .. }) in (1..).zip(self.windows()) {
            let width = watched.len();
            let needed = updater.bytes(count.saturating_add(width), width);
            if needed.saturating_add(WindowFactor::bytes(width)) > budget {
                return Ok(false);
            }
            let left = self.left_behind(behind).count();
            count = count.saturating_add(stayed).saturating_sub(left);
        }
        let length = UpdaterError::check_length;
        length("nodes of the windows of a factor", count, contact.len())?;
        problem.check_nodes(&self.watched)?;
        let mut grown = ContactSequence::new(problem.grid());
        for (behind, LoggedWindow { watched, joined, stayed }) in (1..).zip(self.windows()) {
            let count = grown.len();
            // Nodes in contact were watched where they might yield.
            let out = watched.iter().take_while(|&&node| !grown.contains(node)).count();
            let (outside, inside) = watched.split_at(out);
            let known = joined.iter().filter(|&&place| place < out).count();
            length("watched nodes that joined a factor", known, joined.len())?;
            let mut schur = Schur::default();
            if !inside.is_empty() {
                let positions = places(grown.order(), inside);
                length("watched nodes in contact", positions.len(), inside.len())?;
                updater.watch_both(problem, &grown, outside, &positions, &mut schur)?;
            } else if !outside.is_empty() {
                updater.watch(problem, &grown, outside, &mut schur)?;
            }
            if !joined.is_empty() {
                let factor = WindowFactor::of(schur, joined)?;
                joined.iter().try_for_each(|&place| grown.push(outside[place]))?;
                updater.join(problem, &grown, &factor)?;
            }
            if stayed < joined.len() {
                grown.truncate(count + stayed);
                updater.truncate(problem, &grown)?;
            }
            let left: Vec<usize> = self.left_behind(behind).collect();
            if self.yields_behind(behind) {
                leave(updater, problem, &mut grown, &left)?;
            } else {
                left.chunks(1).try_for_each(|one| leave(updater, problem, &mut grown, one))?;
            }
        }
        let pairs = grown.order().iter().zip(contact.order());
        let same = pairs.filter(|(a, b)| a == b).count();
        length("nodes that joined a factor in the order of contact", same, contact.len())?;
        Ok(true)
    }
}

/// Lets the nodes at some places leave a contact and its factor at once.
fn leave(
    updater: &mut dyn LinearUpdater,
    problem: &Problem,
    contact: &mut ContactSequence,
    places: &[usize],
) -> Result<(), Error> {
    let left = places.iter().map(|&position| {
        let node = contact.order().get(position).copied().unwrap_or(usize::MAX);
        Left { node, position }
    });
    let left: Vec<Left> = left.collect();
    left.iter().try_for_each(|left| contact.remove(left.node).map(drop))?;
    updater.release(problem, contact, &left)
}

/// The places of some nodes in an order, up to the first node that does not come in that order.
fn places(order: &[usize], nodes: &[usize]) -> Vec<usize> {
    let mut nodes = nodes.iter().peekable();
    let found = order.iter().enumerate().filter(|(_, node)| nodes.next_if_eq(node).is_some());
    found.map(|(place, _)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_chain;
    use crate::updater::{RecursiveCholesky, Solution};

    /// Two windows on a row of nine nodes, of the second of which an event was taken back: nodes 0, 4, 2 and 6 stay.
    fn log() -> FactorLog {
        let mut log = FactorLog::default();
        log.push(&[0, 2, 4], [0, 2].into_iter(), 2);
        log.push(&[2, 8, 6], [0, 2, 1].into_iter(), 2);
        log
    }

    fn replayed(
        log: &FactorLog,
        order: &[usize],
        budget: usize,
    ) -> Result<Option<Vec<f64>>, Error> {
        let problem = test_chain::problem(&[0.0; 9])?;
        let contact = ContactSequence::with_order(problem.grid(), order.iter().copied())?;
        let mut updater = RecursiveCholesky::new();
        if !log.replay(&mut updater, &problem, &contact, budget)? {
            return Ok(None);
        }
        let mut solution = Solution::default();
        updater.solve(&problem, &contact, contact.len(), 1.0, &mut solution)?;
        Ok(Some(solution.rate))
    }

    #[test]
    fn a_factor_is_made_again() -> Result<(), Error> {
        let order = [0, 4, 2, 6];
        let found = replayed(&log(), &order, usize::MAX)?.unwrap_or_default();
        let blocks = replayed(&FactorLog::of_blocks(&order), &order, usize::MAX)?;
        let expected = blocks.unwrap_or_default();
        assert_eq!((found.len(), expected.len()), (4, 4));
        for (found, expected) in found.iter().zip(&expected) {
            // Rounding of numbers below 1.
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        assert_eq!(log().untouched(), [] as [usize; 0]);
        let mut log = log();
        log.push(&[7, 1, 3], [1].into_iter(), 1);
        assert_eq!(log.untouched(), [7, 3]);
        Ok(())
    }

    /// Node 4, the second of the two windows' nodes, left behind the second window, and node 8 came after that.
    #[test]
    fn nodes_leave_where_they_left() -> Result<(), Error> {
        let mut log = log();
        log.push_left(1);
        log.push(&[8], std::iter::once(0), 1);
        let order = [0, 2, 6, 8];
        let found = replayed(&log, &order, usize::MAX)?.unwrap_or_default();
        let blocks = replayed(&FactorLog::of_blocks(&order), &order, usize::MAX)?;
        let expected = blocks.unwrap_or_default();
        assert_eq!((found.len(), expected.len()), (4, 4));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        for changed in [[2, 0], [2, 4], [1, 0], [9, 1]] {
            let mut other = log.clone();
            other.left[0] = changed;
            assert!(replayed(&other, &order, usize::MAX).is_err(), "{changed:?}");
        }
        Ok(())
    }

    /// To the byte: the window that needs most is the second one, with two nodes in contact and three watched.
    #[test]
    fn a_factor_is_made_again_where_it_fits() -> Result<(), Error> {
        let needed = RecursiveCholesky::new().bytes(5, 3) + WindowFactor::bytes(3);
        assert!(replayed(&log(), &[0, 4, 2, 6], needed)?.is_some());
        assert!(replayed(&log(), &[0, 4, 2, 6], needed - 1)?.is_none());
        Ok(())
    }

    #[test]
    fn logs_of_other_contacts_are_refused() {
        let refused = |change: &dyn Fn(&mut FactorLog), order: &[usize]| {
            let mut log = log();
            change(&mut log);
            replayed(&log, order, usize::MAX).is_err()
        };
        assert!(!refused(&|_| {}, &[0, 4, 2, 6]));
        // Another order, fewer nodes, one outside the grid, one twice, a place that is none, an event twice, fewer
        // nodes than windows say.
        assert!(refused(&|_| {}, &[0, 4, 6, 2]));
        assert!(refused(&|_| {}, &[0, 4, 2]));
        assert!(refused(&|log| log.watched[0] = 9, &[0, 4, 2, 6]));
        assert!(refused(&|log| log.watched[4] = 0, &[0, 4, 2, 6]));
        assert!(refused(&|log| log.joined[1] = 3, &[0, 4, 2, 6]));
        assert!(refused(&|log| log.joined[1] = 0, &[0, 4, 2, 6]));
        assert!(refused(&|log| log.watched.truncate(5), &[0, 4, 2, 6]));
    }
}
