//! The watched nodes and the events among them.

use super::gap_field::Line;
use super::scales::ties_from;
use crate::updater::{Schur, Touched};

/// A watched node that touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WindowEvent {
    pub(super) node: usize,
    /// The approach at which it touches, from where the window began.
    pub(super) time: f64,
    /// What it adds to `eᵀ C_II⁻¹ e`.
    pub(super) unit_stiffness: f64,
    /// What it takes off the sum of closing rates.
    pub(super) closing: f64,
}

/// A node that cannot touch: its pivot is not positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BadPivot {
    pub(super) node: usize,
    pub(super) time: f64,
    pub(super) pivot: f64,
}

/// The nodes that may touch before any other, and all that decides among them: the lines `a − t b` of their
/// gaps, and the Schur complement S, by which a node that touches changes the lines of the others.
///
/// Everything here is small and dense; it knows nothing of the grid, the updater, or the path.
#[derive(Debug, Clone, Default)]
pub(super) struct Window {
    nodes: Vec<usize>,
    schur: Schur,
    /// (a, b, σ) of each node, from which the events so far are eliminated.
    lines: Vec<[f64; 3]>,
    /// (a, b) before the first event.
    opened: Vec<[f64; 2]>,
    open: Vec<bool>,
    touched: Touched,
    events: Vec<WindowEvent>,
    horizon: f64,
    /// Where the window began.
    approach: f64,
}

impl Window {
    /// Opens a window at an approach on nodes; no other node touches before the time `horizon`. The caller fills the Schur
    /// complement and then plays.
    pub(super) fn open(
        &mut self,
        lines: impl Iterator<Item = Line>,
        (horizon, approach): (f64, f64),
    ) -> (&[usize], &mut Schur) {
        self.nodes.clear();
        self.opened.clear();
        for line in lines {
            self.nodes.push(line.node);
            self.opened.push([line.gap, line.closing]);
        }
        self.lines.clear();
        self.open.clear();
        self.open.resize(self.nodes.len(), true);
        self.touched.reset(self.nodes.len(), self.nodes.len());
        self.events.clear();
        // So that no event ever allocates.
        self.events.reserve(self.nodes.len());
        self.horizon = horizon;
        self.approach = approach;
        (&self.nodes, &mut self.schur)
    }

    /// Watched nodes that have not touched, in the order of the window.
    pub(super) fn untouched(&self) -> impl Iterator<Item = usize> {
        let nodes = self.nodes.iter().zip(&self.open);
        nodes.filter(|(_, open)| **open).map(|(&node, _)| node)
    }

    /// The events, in their order.
    pub(super) fn events(&self) -> &[WindowEvent] {
        &self.events
    }

    /// The factor of the Schur complement.
    pub(super) fn touched(&self) -> &Touched {
        &self.touched
    }

    /// Plays up to `most` events: the gap that closes first, again and again, until the horizon. Ties go to
    /// the node of the lowest index. Returns what ended it if that is a pivot.
    ///
    /// The first event always counts: the horizon is the bound of a node that was later, so that anything
    /// else is rounding; and so is a time before that of the last event.
    pub(super) fn play(&mut self, most: usize) -> Option<BadPivot> {
        while self.events.len() < most {
            let (position, time) = self.first_contact()?;
            if time == f64::INFINITY || (time > self.horizon && !self.events.is_empty()) {
                return None;
            }
            let last = self.events.last().map_or(0.0, |event| event.time);
            if let Err(bad) = self.touch(position, time.max(last)) {
                return Some(bad);
            }
        }
        None
    }

    /// When the first gap of the open nodes closes, and of the nodes that touch with it the one of the lowest index.
    fn first_contact(&mut self) -> Option<(usize, f64)> {
        self.start();
        let open = (0..self.nodes.len()).filter(|&position| self.open[position]);
        let lines = open.map(|position| {
            let [gap, closing, _] = self.lines[position];
            let node = self.nodes[position];
            (position, Line { node, gap, closing })
        });
        let times = lines.clone().map(|(_, line)| line.touches());
        let earliest = times.fold(f64::INFINITY, f64::min);
        let touches = |line: &Line| {
            ties_from(self.approach, line.gap, line.closing) <= earliest
                || line.touches() <= earliest
        };
        lines
            .filter(|(_, line)| touches(line))
            .min_by_key(|(_, line)| line.node)
            .map(|(position, _)| (position, earliest))
    }

    /// Puts the lines together, unless that is done.
    fn start(&mut self) {
        if self.lines.is_empty() {
            let lines = self.opened.iter().zip(self.schur.row_sums());
            self.lines
                .extend(lines.map(|([gap, rate], sum)| [*gap, *rate, *sum]));
        }
    }

    /// Lets the node at `position` touch at `time`.
    ///
    /// # Errors
    ///
    /// Its pivot, if that is not positive; then nothing has changed.
    pub(super) fn touch(&mut self, position: usize, time: f64) -> Result<(), BadPivot> {
        self.start();
        let node = self.nodes[position];
        let column = match self.touched.push(&mut self.schur, position) {
            Ok(column) => column,
            Err(pivot) => return Err(BadPivot { node, time, pivot }),
        };
        let entries = self.lines[position].map(|value| value / column[position]);
        for (line, factor) in self.lines.iter_mut().zip(column) {
            for (value, entry) in line.iter_mut().zip(entries) {
                *value -= factor * entry;
            }
        }
        self.open[position] = false;
        let [_, unit, sum] = entries;
        self.events.push(WindowEvent {
            node,
            time,
            unit_stiffness: unit * unit,
            closing: sum * unit,
        });
        Ok(())
    }

    /// Forgets all but the first events. Their nodes are not watched any more.
    pub(super) fn truncate(&mut self, events: usize) {
        self.events.truncate(events);
        self.touched.truncate(events);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes 7, 8 and 9 with S = C and σ = row sums of C, before any contact.
    fn window(
        c: [[f64; 3]; 3],
        lines: [(f64, f64); 3],
        horizon: f64,
    ) -> Result<Window, crate::Error> {
        let mut window = Window::default();
        let lines = lines.into_iter().zip(7..);
        let lines = lines.map(|((gap, closing), node)| Line { node, gap, closing });
        let (nodes, schur) = window.open(lines, (horizon, 0.0));
        assert_eq!(nodes, [7, 8, 9]);
        schur.resize(3)?;
        for (i, row) in c.iter().enumerate() {
            schur.row_sums_mut()[i] = row.iter().sum();
            for (j, value) in row.iter().enumerate() {
                schur.matrix_mut()[(i, j)] = *value;
            }
        }
        Ok(window)
    }

    const C: [[f64; 3]; 3] = [[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]];

    #[test]
    fn a_node_that_touches_delays_its_neighbour() -> Result<(), crate::Error> {
        // Node 7 touches at 0; then node 8 rises by half of the approach, and touches at 2 instead of 1.
        let mut window = window(C, [(0.0, 1.0), (1.0, 1.0), (5.0, 1.0)], 10.0)?;
        assert_eq!(window.play(2), None);
        let found: Vec<_> = window.events().iter().map(|e| (e.node, e.time)).collect();
        // A few roundings of numbers near 1.
        assert_eq!(found[0], (7, 0.0));
        assert!(
            found[1].0 == 8 && (found[1].1 - 2.0).abs() < 1e-14,
            "{found:?}"
        );
        let [first, second] = window.events() else {
            unreachable!("two were asked for");
        };
        // eᵀ C⁻¹ e of the first node alone, and of the first two: 1/2 and 2/3.
        assert!((first.unit_stiffness - 0.5).abs() < 1e-15);
        assert!((first.unit_stiffness + second.unit_stiffness - 2.0 / 3.0).abs() < 1e-15);
        assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
        Ok(())
    }

    #[test]
    fn the_horizon_ends_a_window_but_not_before_its_first_event() -> Result<(), crate::Error> {
        let mut early = window(C, [(0.5, 1.0), (1.0, 1.0), (5.0, 1.0)], 0.1)?;
        assert_eq!(early.play(3), None);
        assert_eq!(early.events().len(), 1);
        // Until the horizon, and at it.
        let lines = [(0.0, 1.0), (1.0, 1.0), (9.0, 1.0)];
        let mut free = window(C, lines, 100.0)?;
        free.play(2);
        let second = free.events()[1].time;
        for (horizon, events) in [(second, 2), (second * (1.0 - 1e-12), 1)] {
            let mut until = window(C, lines, horizon)?;
            assert_eq!(until.play(3), None);
            assert_eq!(until.events().len(), events, "horizon {horizon}");
        }
        let mut late = window(C, [(0.5, 1.0), (1.0, 1.0), (5.0, 1.0)], 100.0)?;
        assert_eq!(late.play(3), None);
        assert_eq!(late.events().len(), 3);
        Ok(())
    }

    /// A gap that is nothing and does not close is no contact, and keeps no other one from being found.
    #[test]
    fn gaps_that_do_not_close_never_touch() -> Result<(), crate::Error> {
        let mut window = window(C, [(0.0, 0.0), (1.0, 1.0), (5.0, -1.0)], 100.0)?;
        assert_eq!(window.play(3), None);
        let found: Vec<_> = window.events().iter().map(|e| (e.node, e.time)).collect();
        assert_eq!(found, [(8, 1.0)]);
        Ok(())
    }

    #[test]
    fn ties_go_to_the_lowest_index_and_times_never_fall() -> Result<(), crate::Error> {
        let mut window = window(C, [(1.0, 1.0), (0.0, 1.0), (0.0, 1.0)], 100.0)?;
        assert_eq!(window.play(3), None);
        let nodes: Vec<_> = window.events().iter().map(|e| e.node).collect();
        assert_eq!(nodes, [8, 9, 7]);
        assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
        Ok(())
    }

    /// Node 9 seems to touch first, by less than a tie: node 8 comes first all the same, and both at times that do not fall.
    /// However slowly they close, it is their gaps that tell.
    #[test]
    fn rounding_does_not_order_ties() -> Result<(), crate::Error> {
        let alone = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
        let fast = [(5.0, 1.0), (1.0, 1.0), (1.0 - 1e-12, 1.0)];
        let slow = [(5.0, 1.0), (1e-3, 1e-3), (1e-3 - 1e-12, 1e-3)];
        // 10⁻¹³ of the approach, 1 and 21.
        for (approach, lines, order) in [
            (0.0, fast, [9, 8]),
            (20.0, fast, [8, 9]),
            (0.0, slow, [9, 8]),
            (20.0, slow, [8, 9]),
        ] {
            let mut window = window(alone, lines, 4.0)?;
            window.approach = approach;
            assert_eq!(window.play(3), None);
            let nodes: Vec<_> = window.events().iter().map(|e| e.node).collect();
            assert_eq!(nodes, order);
            assert!(window.events().is_sorted_by(|a, b| a.time <= b.time));
        }
        Ok(())
    }

    #[test]
    fn a_pivot_that_is_not_positive_ends_the_window() -> Result<(), crate::Error> {
        let singular = [[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let mut window = window(singular, [(0.0, 1.0), (0.0, 2.0), (9.0, 1.0)], 100.0)?;
        let bad = window.play(3);
        assert!(
            matches!(
                bad,
                Some(BadPivot {
                    node: 8,
                    pivot: 0.0,
                    ..
                })
            ),
            "{bad:?}"
        );
        assert_eq!(window.events().len(), 1);
        Ok(())
    }

    #[test]
    fn nodes_of_forgotten_events_are_not_watched_any_more() -> Result<(), crate::Error> {
        let mut window = window(C, [(0.0, 1.0), (1.0, 1.0), (5.0, 1.0)], 100.0)?;
        window.play(2);
        window.truncate(1);
        assert_eq!((window.events().len(), window.touched().len()), (1, 1));
        assert_eq!(window.untouched().collect::<Vec<_>>(), [9]);
        Ok(())
    }
}
