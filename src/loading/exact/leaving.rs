//! Windows with a factor on bodies on which nodes may leave: until one does.
//!
//! Nodes only touch in such a window. Between two events every pressure and every gap is a line, so that its values at
//! the events tell all. With the pressures q of the nodes J that have touched, the pressures of the contact I, and the
//! gap of a node o that is neither watched nor in contact, are
//!
//! ```text
//! p(t) = p(0) + t p'(0) − A q(t),    g(t) = g(0) + t g'(0) + (C_oJ − C_oI A) q(t),    A = C_II⁻¹ C_IJ
//! ```
//!
//! A window ends with the last event before a pressure falls to zero. Of most nodes a bound says that they stay open:
//! with T the end of the window, and C(0, 0) no less than any pivot,
//!
//! ```text
//! |g(t) − (1 − t/T) g(0) − t/T g(T)|² ≤ C(0, 0) δqᵀ S δq,    δq = q(t) − t/T q(T)
//! ```

use nalgebra::DMatrix;

use crate::loading::gap_field::GapLine;
use crate::loading::run::LoadingRun;
use crate::loading::window::{Window, WindowEvent};
use crate::updater::Solution;

/// Pressures and gaps when a window begins.
pub(super) struct AtStart {
    /// Of the contact.
    solution: Solution,
    /// Of the nodes that are not watched.
    gaps: Vec<(usize, GapLine)>,
    /// What pressures on the nodes of the first events take off the contact.
    relief: DMatrix<f64>,
}

impl AtStart {
    pub(super) fn of(
        run: &LoadingRun,
        relief: DMatrix<f64>,
        unwatched: impl Iterator<Item = usize>,
    ) -> Self {
        let gaps = unwatched.map(|node| (node, run.line(node))).collect();
        Self { solution: run.field.solution().clone(), gaps, relief }
    }

    /// How many events of a window come before a pressure falls below `-tension`, on the contact or on a node that has
    /// touched: the first at least.
    pub(super) fn before_release(&self, window: &Window, tension: f64) -> usize {
        let events = window.events();
        let mut stand = events.len();
        let mut touched: Vec<Vec<f64>> = Vec::with_capacity(stand);
        for (event, count) in events.iter().zip(0..) {
            let pressures = window.answers(count, event.time);
            let pressures: Vec<f64> = pressures.into_iter().map(|[pressure, _]| pressure).collect();
            if count > 0 && pressures.iter().any(|pressure| *pressure < -tension) {
                stand = count;
                break;
            }
            touched.push(pressures);
        }
        // What is taken off each node at most.
        let mut most = vec![0.0; self.relief.nrows()];
        for (j, column) in self.relief.column_iter().enumerate() {
            let pressures = touched.iter().filter_map(|pressures| pressures.get(j));
            let greatest = pressures.copied().fold(0.0, f64::max);
            for (most, taken) in most.iter_mut().zip(column.iter()) {
                *most += greatest * taken.max(0.0);
            }
        }
        let Solution { pressure, rate } = &self.solution;
        let [first, last] = [events.first(), events.last()].map(|e| e.map_or(0.0, |e| e.time));
        for (i, most) in most.into_iter().enumerate() {
            let least = (pressure[i] + first * rate[i]).min(pressure[i] + last * rate[i]);
            if least - most >= -tension {
                continue;
            }
            let row: Vec<f64> = self.relief.row(i).iter().copied().collect();
            let falls = |count: &usize| {
                let taken: f64 = row.iter().zip(&touched[*count]).map(|(a, q)| a * q).sum();
                pressure[i] + events[*count].time * rate[i] - taken < -tension
            };
            stand = (1..stand.min(touched.len())).find(falls).unwrap_or(stand);
        }
        stand
    }

    /// How many events come before a node that is not watched touches, in a window that has joined and at whose end the
    /// solution is.
    pub(super) fn before_others(&self, run: &LoadingRun, window: &Window, overlap: f64) -> usize {
        let events = window.events();
        let (mut stand, span) = (events.len(), events.last().map_or(0.0, |event| event.time));
        if stand < 2 {
            return stand;
        }
        let (problem, table) = (&run.problem, run.problem.table());
        let end = run.scalars.approach() + span;
        let at_end = window.reduced(stand, span);
        let bound = |(k, event): (usize, &WindowEvent)| {
            let way = event.time / span;
            let mut off: Vec<f64> = at_end.iter().map(|[z, _]| -way * z).collect();
            for (off, [z, _]) in off.iter_mut().zip(window.reduced(k, event.time)) {
                *off += z;
            }
            let energy: f64 = off.iter().map(|z| z * z).sum();
            (table.self_influence() * energy).sqrt()
        };
        let bounds: Vec<f64> = events.iter().enumerate().map(bound).collect();
        let most = bounds.iter().copied().fold(0.0, f64::max);
        let touched: Vec<usize> = window.touched().map(|node| table.place(node)).collect();
        let before = &run.contact.order()[..self.relief.nrows()];
        let contact: Vec<usize> = before.iter().map(|&node| table.place(node)).collect();
        let mut influence = vec![0.0; contact.len()];
        let mut beside = vec![0.0; touched.len()];
        for &(node, GapLine { gap, closing }) in &self.gaps {
            let at_end = run.field.line(problem, node, end).gap;
            if gap.min(at_end) >= most {
                continue;
            }
            let chord = |time: f64| gap + time / span * (at_end - gap);
            if events.iter().zip(&bounds).all(|(event, bound)| chord(event.time) >= *bound) {
                continue;
            }
            let place = table.place(node);
            table.fill_column(place, &contact, &mut influence);
            table.fill_column(place, &touched, &mut beside);
            for (beside, column) in beside.iter_mut().zip(self.relief.column_iter()) {
                *beside -= column.iter().zip(&influence).map(|(a, c)| a * c).sum::<f64>();
            }
            let has_touched = |count: &usize| {
                let time = events[*count].time;
                let pressed = window.answers(*count, time);
                let moved: f64 = beside.iter().zip(pressed).map(|(s, [q, _])| s * q).sum();
                gap - time * closing + moved < -overlap
            };
            stand = (1..stand).find(has_touched).unwrap_or(stand);
        }
        stand
    }
}
