//! The nodes in contact, in the order in which they joined.

use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::DMatrix;

use crate::{Error, Grid};

/// The nodes in contact, in the order in which they joined.
///
/// A path adds to its sequence, and takes from it. Every change gives the sequence a new [`revision`](Self::revision),
/// a number that no other content of any sequence has had: what was computed from a sequence belongs to all that have
/// its revision.
///
/// ```
/// use asperity::contact::ContactSequence;
/// use asperity::{Error, Grid};
///
/// # fn main() -> Result<(), Error> {
/// let contact = ContactSequence::with_order(Grid::square(4, 1.0)?, [5, 6])?;
/// assert_eq!(contact.order(), [5, 6]);
/// assert!(contact.contains(6) && !contact.contains(7));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct ContactSequence {
    grid: Grid,
    order: Vec<usize>,
    is_in: Vec<bool>,
    revision: u64,
}

/// A number that was never used before.
fn next_revision() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl ContactSequence {
    /// No node in contact yet.
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        Self {
            grid,
            order: Vec::new(),
            is_in: vec![false; grid.nodes()],
            revision: next_revision(),
        }
    }

    /// The nodes of an order of contact, the first to touch first.
    ///
    /// # Errors
    ///
    /// [`Error::NodeOutOfGrid`], and [`Error::AlreadyInContact`] for a node that is given twice.
    pub fn with_order(grid: Grid, order: impl IntoIterator<Item = usize>) -> Result<Self, Error> {
        let mut contact = Self::new(grid);
        for node in order {
            contact.push(node)?;
        }
        Ok(contact)
    }

    /// The grid that the nodes belong to.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Which nodes were in contact when there were `contact_nodes` of them; all of them beyond the last.
    #[must_use]
    pub fn map_at(&self, contact_nodes: usize) -> DMatrix<bool> {
        let (nx, ny) = self.grid.shape();
        let mut map = DMatrix::from_element(nx, ny, false);
        for &node in self.order.iter().take(contact_nodes) {
            map.as_mut_slice()[node] = true;
        }
        map
    }

    /// Node indices in the order in which they joined.
    #[must_use]
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Number of nodes in contact.
    #[must_use]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether no node is in contact.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Whether a node is in contact; false for one outside the grid.
    #[must_use]
    pub fn contains(&self, node: usize) -> bool {
        self.is_in.get(node).copied().unwrap_or(false)
    }

    /// The place of each node of the grid in the order of joining; `None` out of contact.
    pub(crate) fn places(&self) -> Vec<Option<usize>> {
        let mut places = vec![None; self.is_in.len()];
        for (place, &node) in self.order.iter().enumerate() {
            places[node] = Some(place);
        }
        places
    }

    /// A number that changes with every edit: two sequences of the same revision are equal.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Adds a node.
    ///
    /// # Errors
    ///
    /// [`Error::NodeOutOfGrid`], and [`Error::AlreadyInContact`].
    pub(crate) fn push(&mut self, node: usize) -> Result<(), Error> {
        self.insert(self.len(), node)
    }

    /// Puts a node between others, `position` nodes before it.
    pub(crate) fn insert(&mut self, position: usize, node: usize) -> Result<(), Error> {
        let nodes = self.is_in.len();
        match self.is_in.get_mut(node) {
            None => Err(Error::NodeOutOfGrid { node, nodes }),
            Some(true) => {
                let (ix, iy) = self.grid.coordinates(node);
                Err(Error::AlreadyInContact { ix, iy })
            }
            Some(is_in) => {
                *is_in = true;
                self.order.insert(position.min(self.order.len()), node);
                self.revision = next_revision();
                Ok(())
            }
        }
    }

    /// Keeps the first `count` nodes.
    pub(crate) fn truncate(&mut self, count: usize) {
        if count < self.order.len() {
            for node in self.order.drain(count..) {
                self.is_in[node] = false;
            }
            self.revision = next_revision();
        }
    }

    /// Takes a node out; those after it move up by one. Returns how many were before it.
    ///
    /// # Errors
    ///
    /// [`Error::NodeOutOfGrid`], and [`Error::NotInContact`].
    pub(crate) fn remove(&mut self, node: usize) -> Result<usize, Error> {
        let nodes = self.is_in.len();
        if node >= nodes {
            return Err(Error::NodeOutOfGrid { node, nodes });
        }
        let Some(position) = self.order.iter().position(|&other| other == node) else {
            let (ix, iy) = self.grid.coordinates(node);
            return Err(Error::NotInContact { ix, iy });
        };
        self.order.remove(position);
        self.is_in[node] = false;
        self.revision = next_revision();
        Ok(position)
    }

    /// Bytes held at most on a grid.
    pub(crate) fn bytes_on(grid: &Grid) -> usize {
        grid.nodes() * (size_of::<usize>() + size_of::<bool>())
    }
}

/// The index of a node of a grid.
pub(crate) fn node_of(grid: &Grid, (ix, iy): (usize, usize)) -> Result<usize, Error> {
    grid.node(ix, iy).ok_or_else(|| Error::NodeOutOfGrid {
        node: iy.saturating_mul(grid.nx()).saturating_add(ix),
        nodes: grid.nodes(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_and_membership_go_together() -> Result<(), Error> {
        let mut contact = ContactSequence::new(Grid::new(3, 2, 1.0, 1.0)?);
        assert!(contact.is_empty());
        for node in [4, 0, 5] {
            contact.push(node)?;
            assert!(!contact.is_empty());
        }
        assert!(matches!(contact.push(0), Err(Error::AlreadyInContact { ix: 0, iy: 0 })));
        assert!(matches!(contact.push(6), Err(Error::NodeOutOfGrid { node: 6, nodes: 6 })));
        assert_eq!(contact.remove(0)?, 1);
        assert_eq!(contact.order(), [4, 5]);
        assert!(matches!(contact.remove(0), Err(Error::NotInContact { .. })));
        contact.insert(1, 2)?;
        assert_eq!(contact.order(), [4, 2, 5]);
        contact.truncate(1);
        let members: Vec<usize> = (0..7).filter(|&node| contact.contains(node)).collect();
        assert_eq!(members, [4]);
        Ok(())
    }

    /// A contact of all nodes holds what was said before there was one.
    #[test]
    fn bytes_are_those_of_full_contact() -> Result<(), Error> {
        let grid = Grid::new(30, 20, 1.0, 1.0)?;
        let contact = ContactSequence::with_order(grid, 0..600)?;
        let held = size_of_val(contact.order()) + size_of_val(&contact.is_in[..]);
        assert_eq!(ContactSequence::bytes_on(&grid), held);
        Ok(())
    }

    #[test]
    fn the_contact_of_any_state_is_a_beginning_of_the_order() -> Result<(), Error> {
        let grid = Grid::new(3, 2, 1.0, 1.0)?;
        let contact = ContactSequence::with_order(grid, [4, 0, 5])?;
        for nodes in 0..5 {
            let map = contact.map_at(nodes);
            assert_eq!(map.shape(), (3, 2));
            let members: Vec<usize> = (0..6).filter(|&node| map.as_slice()[node]).collect();
            let expected: [&[usize]; 5] = [&[], &[4], &[0, 4], &[0, 4, 5], &[0, 4, 5]];
            assert_eq!(members, expected[nodes]);
        }
        let twice = ContactSequence::with_order(grid, [1, 3, 1]);
        assert!(matches!(twice, Err(Error::AlreadyInContact { ix: 1, iy: 0 })));
        Ok(())
    }

    #[test]
    fn a_revision_belongs_to_one_content() -> Result<(), Error> {
        let mut contact = ContactSequence::new(Grid::square(3, 1.0)?);
        contact.push(1)?;
        let mut other = contact.clone();
        assert_eq!(contact.revision(), other.revision());
        contact.push(2)?;
        other.push(3)?;
        assert_ne!(contact.revision(), other.revision());
        let before = contact.revision();
        contact.truncate(9);
        assert_eq!(contact.revision(), before);
        contact.truncate(1);
        assert_ne!(contact.revision(), before);
        Ok(())
    }
}
