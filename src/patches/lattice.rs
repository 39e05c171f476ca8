//! The nodes as a lattice: the neighbours of each, and what lies at its border.

use super::Connectivity;
use crate::surface::Axis;
use crate::{Boundary, Grid};

/// How many periods further along x and y.
pub(super) type Winding = [i32; 2];

/// The node next to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Neighbour {
    pub(super) node: usize,
    /// The periods between the two: not zero where the border of the grid lies between them.
    pub(super) winding: Winding,
}

/// The nodes of a grid with their neighbours.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    shape: [usize; 2],
    /// Whether it goes on beyond its border, along x and along y.
    wraps: [bool; 2],
    connectivity: Connectivity,
}

/// Steps to the neighbours: those across a side along y, across one along x, and across corners.
const STEPS: [[isize; 2]; 8] =
    [[-1, 0], [1, 0], [0, -1], [0, 1], [-1, -1], [1, -1], [-1, 1], [1, 1]];

/// The place of an axis in a pair.
pub(super) fn place(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
    }
}

impl Lattice {
    pub(super) fn new(grid: Grid, boundary: Boundary, connectivity: Connectivity) -> Self {
        let (nx, ny) = grid.shape();
        Self { shape: [nx, ny], wraps: boundary.repeats(), connectivity }
    }

    /// The same with two ends along this axis.
    pub(super) fn cut(mut self, axis: Axis) -> Self {
        self.wraps[place(axis)] = false;
        self
    }

    /// Number of nodes.
    pub(super) fn nodes(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Whether it goes on beyond its border along this axis.
    pub(super) fn wraps(&self, axis: Axis) -> bool {
        self.wraps[place(axis)]
    }

    /// The indices of a node along x and y.
    pub(super) fn coordinates(&self, node: usize) -> [usize; 2] {
        [node % self.shape[0], node / self.shape[0]]
    }

    /// The nodes across the four sides of a cell, two sides along y and then two along x; `None` across the border.
    pub(super) fn beside(&self, node: usize) -> [Option<Neighbour>; 4] {
        let at = self.coordinates(node);
        [0, 1, 2, 3].map(|k| self.step(at, STEPS[k]))
    }

    /// The neighbours of a node; on a lattice of one or two nodes a side, itself and others twice, each across
    /// another part of the border.
    pub(super) fn neighbours(&self, node: usize) -> impl Iterator<Item = Neighbour> + use<> {
        let (lattice, at) = (*self, self.coordinates(node));
        let count = match self.connectivity {
            Connectivity::Four => 4,
            Connectivity::Eight => 8,
        };
        let steps = STEPS.into_iter().take(count);
        steps.filter_map(move |step| lattice.step(at, step))
    }

    fn step(&self, at: [usize; 2], step: [isize; 2]) -> Option<Neighbour> {
        let along = |k: usize| {
            let wraps = self.wraps[k];
            match at[k].checked_add_signed(step[k]) {
                Some(next) if next < self.shape[k] => Some((next, 0)),
                Some(_) => wraps.then_some((0, 1)),
                None => wraps.then_some((self.shape[k] - 1, -1)),
            }
        };
        let ((ix, across_x), (iy, across_y)) = (along(0)?, along(1)?);
        Some(Neighbour { node: ix + self.shape[0] * iy, winding: [across_x, across_y] })
    }

    /// Whether a node lies at the lower and at the upper end, along x and along y.
    pub(super) fn at_ends(&self, node: usize) -> ([bool; 2], [bool; 2]) {
        let at = self.coordinates(node);
        let low = at.map(|index| index == 0);
        let high = [at[0] + 1 == self.shape[0], at[1] + 1 == self.shape[1]];
        (low, high)
    }
}
