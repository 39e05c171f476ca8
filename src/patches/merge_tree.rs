//! Which patches came from where: births, and mergers.

use super::Connectivity;
use super::forest::Forest;
use super::lattice::Lattice;
use crate::Boundary;
use crate::contact::ContactSequence;

/// The merger of a patch into an older one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Merger {
    /// Number of the state: of the node that touches between the two.
    pub step: usize,
    /// The patch that goes on, by its place in [`MergeTree::branches`].
    pub into: usize,
}

/// A patch from its first node on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Branch {
    /// Number of the state at which its first node touches.
    pub birth: usize,
    /// Its first node, (ix, iy).
    pub node: (usize, usize),
    /// How it ends; `None` if it lasts to the last state.
    pub merger: Option<Merger>,
    /// Number of its nodes when it ends, or at the last state: those that merged into it included, the node between
    /// not.
    pub nodes: usize,
}

impl Branch {
    /// Whether it is a patch of its own at this state.
    #[must_use]
    pub fn lives_at(&self, step: usize) -> bool {
        self.birth <= step && self.merger.is_none_or(|merger| step < merger.step)
    }
}

/// All patches of a path in the order of their births, with what each merged into: the data of a dendrogram.
///
/// Of patches that merge, the one born first goes on, so that a patch keeps its first node. A node that joins k
/// patches ends k − 1 of them at one state. The whole path takes O(n α(n)).
///
/// ```
/// use asperity::contact::ContactSequence;
/// use asperity::patches::{Connectivity, MergeTree};
/// use asperity::{Boundary, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let contact = ContactSequence::with_order(Grid::square(4, 1.0)?, [0, 2, 3, 1])?;
/// let tree = MergeTree::new(&contact, Boundary::Free, Connectivity::Four);
/// let [first, second] = tree.branches() else { return Ok(()) };
/// assert_eq!((first.birth, first.node, first.merger), (1, (0, 0), None));
/// assert_eq!((second.birth, second.node, second.nodes), (2, (2, 0), 2));
/// assert!(second.merger.is_some_and(|merger| merger.step == 4 && merger.into == 0));
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MergeTree {
    branches: Vec<Branch>,
}

impl MergeTree {
    /// The patches of a contact in the order in which its nodes touched.
    #[must_use]
    pub fn new(contact: &ContactSequence, boundary: Boundary, connectivity: Connectivity) -> Self {
        let grid = contact.grid();
        let mut forest = Forest::new(Lattice::new(grid, boundary, connectivity));
        let mut branches: Vec<Branch> = Vec::new();
        // The branch of every patch, at its root.
        let mut branch_of = vec![0; grid.nodes()];
        for (&node, step) in contact.order().iter().zip(1..) {
            let parts = forest.add(node);
            let parts = parts.as_slice();
            let oldest = parts.iter().map(|part| branch_of[part.root]).min();
            let goes_on = oldest.unwrap_or_else(|| {
                branches.push(Branch {
                    birth: step,
                    node: grid.coordinates(node),
                    merger: None,
                    nodes: 0,
                });
                branches.len() - 1
            });
            for part in parts {
                let branch = branch_of[part.root];
                if branch != goes_on {
                    branches[branch].nodes = part.nodes;
                    branches[branch].merger = Some(Merger { step, into: goes_on });
                }
            }
            branch_of[forest.find(node).0] = goes_on;
        }
        for branch in branches.iter_mut().filter(|branch| branch.merger.is_none()) {
            let (ix, iy) = branch.node;
            branch.nodes = forest.size(grid.index(ix, iy));
        }
        Self { branches }
    }

    /// The patches, in the order of their births.
    #[must_use]
    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }
}
