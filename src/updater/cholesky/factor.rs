//! A growing Cholesky factor with the columns of the watched nodes.

use std::time::{Duration, Instant};

use super::columns::Columns;
use super::panels::{Panels, Rotations, remove};
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

    /// Makes `nodes` the watched ones and writes their Schur complement to `schur`.
    ///
    /// Nodes that were watched before are recognised if they come first and in the same order; only
    /// the others cost a forward substitution.
    pub(super) fn eliminate(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        problem.check_nodes(nodes)?;
        problem.check_nodes(contact.order())?;
        check_count(self.len(), contact.len())?;
        let start = Instant::now();
        let kept = self.watch(nodes);
        let table = problem.table();
        let places_of = |nodes: &[usize]| -> Vec<usize> {
            nodes.iter().map(|&node| table.place(node)).collect()
        };
        let (places, contact) = (places_of(nodes), places_of(contact.order()));
        self.columns.forward_substitute(&self.panels, kept, |row, first, values| {
            table.fill_column(contact[row], &places[first..], values);
        });
        let forward_done = Instant::now();
        self.timings.forward += forward_done - start;

        schur.resize(nodes.len())?;
        let matrix = schur.as_mut_slice();
        for (j, column) in matrix.chunks_mut(nodes.len().max(1)).enumerate() {
            table.fill_column(places[j], &places[j..], &mut column[j..]);
        }
        self.columns.subtract_gram(matrix);
        self.timings.schur += forward_done.elapsed();
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
        let start = Instant::now();
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

    /// Removes the node at `position` from the contact, which is `contact` now, and forgets the watched
    /// ones. Returns what removes its entry from L⁻¹B.
    pub(super) fn release(
        &mut self,
        contact: &ContactSequence,
        position: usize,
    ) -> Result<Rotations, Error> {
        check_count(self.len(), contact.len() + 1)?;
        if position >= self.len() {
            return Err(Error::NodeOutOfGrid { node: position, nodes: self.len() });
        }
        let start = Instant::now();
        self.watched.clear();
        let rotations = remove(&mut self.panels, position);
        self.columns.forget(self.panels.rows());
        self.timings.release += start.elapsed();
        Ok(rotations)
    }

    /// Bytes held with `contact` nodes in contact and `watched` watched.
    pub(super) fn bytes(contact: usize, watched: usize) -> usize {
        Panels::bytes(contact).saturating_add(Columns::bytes(contact, watched))
    }
}
