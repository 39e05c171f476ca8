//! A growing Cholesky factor with the columns of the watched nodes.

use std::time::Duration;

use nalgebra::DMatrix;

use super::columns::Columns;
use super::panels::{Panels, remove, remove_and};
use crate::clock::Stopwatch;
use crate::contact::ContactSequence;
use crate::updater::{Left, Schur, WindowFactor, check_count};
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

    /// Makes some nodes the watched ones, each with its position if it is in contact, and writes their Schur complement
    /// to `schur`, which may have that of the first `known` of them already.
    ///
    /// Nodes that were watched before are recognised if they come first and in the same order; only
    /// the others cost a forward substitution.
    pub(super) fn eliminate(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        watched: &[(usize, Option<usize>)],
        known: usize,
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let nodes: Vec<usize> = watched.iter().map(|&(node, _)| node).collect();
        problem.check_nodes(&nodes)?;
        problem.check_nodes(contact.order())?;
        check_count(self.len(), contact.len())?;
        let units: Vec<(usize, usize)> = watched
            .iter()
            .enumerate()
            .filter_map(|(column, &(_, position))| Some((column, position?)))
            .collect();
        for &(_, position) in &units {
            check_position(position, contact.len())?;
        }
        let start = Stopwatch::start();
        let kept = self.watch(&nodes);
        let table = problem.table();
        let places_of = |nodes: &[usize]| -> Vec<usize> {
            nodes.iter().map(|&node| table.place(node)).collect()
        };
        let (places, contact) = (places_of(&nodes), places_of(contact.order()));
        // Of a column from one of its numbers on: those of nodes in contact are unit vectors.
        let units_from = |first: usize, count: usize| {
            let from = units.partition_point(|&(column, _)| column < first);
            let to = units.partition_point(|&(column, _)| column < first + count);
            units[from..to].iter().map(move |&(column, position)| (column - first, position))
        };
        self.columns.forward_substitute(&self.panels, kept, |row, first, values| {
            table.fill_column(contact[row], &places[first..first + values.len()], values);
            for (column, position) in units_from(first, values.len()) {
                values[column] = f64::from(u8::from(position == row));
            }
        });
        self.timings.forward += start.elapsed();

        let start = Stopwatch::start();
        let known = if known == kept && schur.size() == nodes.len() { known } else { 0 };
        schur.resize(nodes.len())?;
        let matrix = schur.as_mut_slice();
        for (j, column) in matrix.chunks_mut(nodes.len().max(1)).enumerate() {
            let from = j.max(known);
            let values = &mut column[from..];
            if watched[j].1.is_some() {
                values.fill(0.0);
            } else {
                table.fill_column(places[j], &places[from..], values);
                for (row, _) in units_from(from, values.len()) {
                    values[row] = 0.0;
                }
            }
        }
        self.columns.subtract_gram(known, matrix);
        self.timings.schur += start.elapsed();
        Ok(())
    }

    /// `C_II⁻¹ C_IJ` for some of the watched nodes, J.
    pub(super) fn relief(&self, nodes: &[usize]) -> Result<DMatrix<f64>, Error> {
        let place = |node: &usize| self.watched.iter().position(|other| other == node);
        let positions: Vec<usize> = nodes.iter().filter_map(place).collect();
        check_count(nodes.len(), positions.len())?;
        Ok(self.columns.solved_backwards(&self.panels, &positions))
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
        self.check_release(contact, positions)?;
        let start = Stopwatch::start();
        self.watched.clear();
        remove(&mut self.panels, positions);
        self.columns.forget(self.panels.rows());
        self.timings.release += start.elapsed();
        Ok(())
    }

    /// The same, but the watched nodes stay watched, and those that left are too, behind the others.
    pub(super) fn release_watched(
        &mut self,
        contact: &ContactSequence,
        left: &[Left],
    ) -> Result<(), Error> {
        let positions: Vec<usize> = left.iter().map(|left| left.position).collect();
        self.check_release(contact, &positions)?;
        let start = Stopwatch::start();
        let has_left = |node: &usize| left.iter().any(|left| left.node == *node);
        let kept: Vec<usize> =
            (0..self.watched.len()).filter(|&place| !has_left(&self.watched[place])).collect();
        let rows: Vec<Vec<f64>> =
            positions.iter().map(|&position| self.panels.row(position).to_vec()).collect();
        let mut rotations = Vec::new();
        remove_and(&mut self.panels, &positions, |column| rotations.push(column));
        self.columns.leave(&kept, &positions, &rows, &rotations);
        let others = kept.iter().map(|&place| self.watched[place]);
        self.watched = others.chain(left.iter().map(|left| left.node)).collect();
        self.timings.release += start.elapsed();
        Ok(())
    }

    fn check_release(&self, contact: &ContactSequence, positions: &[usize]) -> Result<(), Error> {
        check_count(self.len(), contact.len() + positions.len())?;
        for (k, &position) in positions.iter().enumerate() {
            check_position(position, self.len())?;
            if k > 0 {
                check_position(positions[k - 1], position)?;
            }
        }
        Ok(())
    }

    /// Bytes held with `contact` nodes in contact and `watched` watched.
    pub(super) fn bytes(contact: usize, watched: usize) -> usize {
        Panels::bytes(contact).saturating_add(Columns::bytes(contact, watched))
    }
}
