//! Patches, state by state.

use std::iter::FusedIterator;

use super::forest::Forest;
use super::lattice::Lattice;
use super::{Connectivity, Perimeter};
use crate::contact::ContactSequence;
use crate::{Boundary, Grid};

/// What a node that touches does to the patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PatchEvent {
    /// It touches apart from all others, and is a new patch.
    Birth,
    /// It touches beside one patch, which grows by it.
    Growth,
    /// It touches between patches, which it makes one.
    Merge {
        /// How many patches become one: two or more.
        patches: usize,
    },
}

/// The patches at a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct PatchState {
    /// Number of the state, which is the number of nodes in contact.
    pub step: usize,
    /// The node that touches, (ix, iy).
    pub node: (usize, usize),
    /// Its effect on the patches.
    pub event: PatchEvent,
    /// Number of patches.
    pub patches: usize,
    /// Nodes of the largest patch.
    pub largest: usize,
    /// The perimeter of all patches together.
    pub perimeter: Perimeter,
}

impl PatchState {
    /// Contact area \[m²\] without what cells count too much: see [`Perimeter::corrected_area`].
    #[must_use]
    pub fn corrected_area(&self, grid: &Grid) -> f64 {
        self.perimeter.corrected_area(self.step, grid)
    }
}

/// The patches of a path at every state: an iterator of [`PatchState`], one for each node that touches.
///
/// A whole path of n states takes O(n α(n)) operations and some 30 bytes a node of the grid.
///
/// ```
/// use asperity::contact::ContactSequence;
/// use asperity::patches::{Connectivity, PatchEvent, PatchHistory};
/// use asperity::{Boundary, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let grid = Grid::square(4, 1.0)?;
/// let contact = ContactSequence::with_order(grid, [0, 2, 1])?;
/// let history = PatchHistory::new(&contact, Boundary::Free, Connectivity::Four);
/// let patches: Vec<_> = history.clone().map(|state| state.patches).collect();
/// assert_eq!(patches, [1, 2, 1]);
/// let last = history.last().map(|state| state.event);
/// assert_eq!(last, Some(PatchEvent::Merge { patches: 2 }));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct PatchHistory<'a> {
    order: std::slice::Iter<'a, usize>,
    grid: Grid,
    forest: Forest,
    step: usize,
    patches: usize,
    largest: usize,
    perimeter: Perimeter,
}

impl<'a> PatchHistory<'a> {
    /// The patches of a contact in the order in which its nodes touched, from the first of them.
    #[must_use]
    pub fn new(
        contact: &'a ContactSequence,
        boundary: Boundary,
        connectivity: Connectivity,
    ) -> Self {
        let grid = contact.grid();
        Self {
            order: contact.order().iter(),
            grid,
            forest: Forest::new(Lattice::new(grid, boundary, connectivity)),
            step: 0,
            patches: 0,
            largest: 0,
            perimeter: Perimeter::default(),
        }
    }
}

impl Iterator for PatchHistory<'_> {
    type Item = PatchState;

    fn next(&mut self) -> Option<PatchState> {
        let &node = self.order.next()?;
        let merged = self.forest.add(node).as_slice().len();
        self.step += 1;
        self.patches = self.patches + 1 - merged;
        self.largest = self.largest.max(self.forest.size(node));
        let forest = &self.forest;
        self.perimeter.change(forest.lattice(), node, 1, |other| forest.contains(other));
        Some(PatchState {
            step: self.step,
            node: self.grid.coordinates(node),
            event: match merged {
                0 => PatchEvent::Birth,
                1 => PatchEvent::Growth,
                patches => PatchEvent::Merge { patches },
            },
            patches: self.patches,
            largest: self.largest,
            perimeter: self.perimeter,
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.order.size_hint()
    }
}

impl ExactSizeIterator for PatchHistory<'_> {}

impl FusedIterator for PatchHistory<'_> {}
