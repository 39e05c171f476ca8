//! A growing Cholesky factor with the columns of the watched nodes.

use std::time::Duration;

use super::columns::Columns;
use super::panels::{Panels, remove};
use crate::clock::Stopwatch;
use crate::contact::ContactSequence;
use crate::updater::{Schur, WindowFactor, check_count};
use crate::{Error, Problem};

/// Where a Cholesky updater spent its time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct CholeskyTimings {
    /// Forward substitution of the columns of newly watched nodes: n²/2 products each.
    pub forward: Duration,
    /// Schur complement of the watched nodes.
    pub schur: Duration,
    /// Rows that become part of the factor.
    pub commit: Duration,
    /// Rows of nodes that left the contact.
    pub release: Duration,
    /// Solutions on the contact set.
    pub solve: Duration,
}

/// `Ok` if a position is one of `count`.
fn check_position(position: usize, count: usize) -> Result<(), Error> {
    if position < count {
        return Ok(());
    }
    Err(Error::LengthMismatch { expected: count, found: position })
}

/// The factor `C_II = L Lᵀ` and the columns `F = L⁻¹ C_IP` of the watched nodes P.
#[derive(Debug, Clone)]
pub(super) struct Factor {
    pub(super) panels: Panels,
    pub(super) columns: Columns,
    watched: Vec<usize>,
    pub(super) timings: CholeskyTimings,
}

impl Factor {
    pub(super) fn new() -> Self {
        Self {
            panels: Panels::default(),
            columns: Columns::default(),
            watched: Vec::new(),
            timings: CholeskyTimings::default(),
        }
    }

    /// Number of nodes in contact.
    pub(super) fn len(&self) -> usize {
        self.panels.rows()
    }

    /// Makes `nodes` and those at `places` of the contact the watched ones, and writes their Schur complement to
    /// `schur`.
    ///
    /// Nodes that were watched before are recognised if they come first and in the same order; only
    /// the others cost a forward substitution.
    pub(super) fn eliminate(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        positions: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        problem.check_nodes(nodes)?;
        problem.check_nodes(contact.order())?;
        check_count(self.len(), contact.len())?;
        for &position in positions {
            check_position(position, contact.len())?;
        }
        let start = Stopwatch::start();
        let out = nodes.len();
        let nodes: Vec<usize> =
            nodes.iter().copied().chain(positions.iter().map(|&p| contact.order()[p])).collect();
        let kept = self.watch(&nodes);
        let table = problem.table();
        let places_of = |nodes: &[usize]| -> Vec<usize> {
            nodes.iter().map(|&node| table.place(node)).collect()
        };
        let (places, contact) = (places_of(&nodes[..out]), places_of(contact.order()));
        self.columns.forward_substitute(&self.panels, kept, |row, first, values| {
            let outside = values.len().min(out.saturating_sub(first));
            let (coefficients, units) = values.split_at_mut(outside);
            if outside > 0 {
                table.fill_column(contact[row], &places[first..first + outside], coefficients);
            }
            for (value, position) in
                units.iter_mut().zip(&positions[(first + outside).saturating_sub(out)..])
            {
                *value = f64::from(u8::from(*position == row));
            }
        });
        self.timings.forward += start.elapsed();

        let start = Stopwatch::start();

        schur.resize(nodes.len())?;
        let matrix = schur.as_mut_slice();
        for (j, column) in matrix.chunks_mut(nodes.len().max(1)).enumerate() {
            let (outside, inside) = column[j..].split_at_mut(out.saturating_sub(j));
            if let Some(&place) = places.get(j) {
                table.fill_column(place, &places[j..], outside);
            }
            inside.fill(0.0);
        }
        self.columns.subtract_gram(matrix);
        self.timings.schur += start.elapsed();
        Ok(())
    }

    /// Makes `nodes` the watched ones; returns how many of them, at the beginning, were before.
    fn watch(&mut self, nodes: &[usize]) -> usize {
        let mut earlier = self.watched.iter().enumerate();
        let kept: Vec<usize> = nodes
            .iter()
            .map_while(|node| earlier.find(|(_, watched)| *watched == node))
            .map(|(position, _)| position)
            .collect();
        self.columns.watch(&kept, nodes.len() - kept.len());
        self.watched.clear();
        self.watched.extend_from_slice(nodes);
        kept.len()
    }

    /// Adds the watched nodes that touched.
    pub(super) fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        check_count(self.watched.len(), touched.watched())?;
        check_count(self.len() + touched.len(), contact.len())?;
        problem.check_nodes(contact.order())?;
        let start = Stopwatch::start();
        let mut open = vec![true; self.watched.len()];
        for &position in touched.positions() {
            open[position] = false;
        }
        let untouched: Vec<usize> = (0..open.len()).filter(|&position| open[position]).collect();
        self.columns.commit(&mut self.panels, touched, &untouched);
        self.watched = untouched.iter().map(|&position| self.watched[position]).collect();
        self.timings.commit += start.elapsed();
        Ok(())
    }

    /// Keeps the first `rows` nodes. Nodes that were watched and did not touch stay watched.
    pub(super) fn truncate(&mut self, rows: usize) {
        if rows < self.len() {
            self.panels.truncate(rows);
            self.columns.truncate(rows);
        }
    }

    /// Removes the nodes at `positions` (ascending) from the contact, which is `contact` now, and forgets the watched
    /// ones.
    pub(super) fn release(
        &mut self,
        contact: &ContactSequence,
        positions: &[usize],
    ) -> Result<(), Error> {
        check_count(self.len(), contact.len() + positions.len())?;
        for (k, &position) in positions.iter().enumerate() {
            check_position(position, self.len())?;
            if k > 0 {
                check_position(positions[k - 1], position)?;
            }
        }
        let start = Stopwatch::start();
        self.watched.clear();
        remove(&mut self.panels, positions);
        self.columns.forget(self.panels.rows());
        self.timings.release += start.elapsed();
        Ok(())
    }

    /// Bytes held with `contact` nodes in contact and `watched` watched.
    pub(super) fn bytes(contact: usize, watched: usize) -> usize {
        Panels::bytes(contact).saturating_add(Columns::bytes(contact, watched))
    }
}
