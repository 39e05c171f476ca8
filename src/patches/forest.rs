//! Patches that grow: disjoint sets of nodes, joined by every node that comes.
//!
//! Union by size with path compression, so that n nodes take O(n α(n)). On a periodic lattice every node also knows
//! by how many periods it lies from the root of its patch, on the way through the patch: where two ways to a node
//! differ, the patch winds around the lattice.
//!
//! Newman & Ziff, Phys. Rev. E 64 (2001) 016706; the windings after Machta et al., Phys. Rev. E 54 (1996) 1332.

use super::lattice::{Lattice, Neighbour, Winding, place};
use crate::surface::Axis;

/// How far a patch reaches.
#[derive(Debug, Clone, Copy, Default)]
struct Reach {
    /// Whether it has nodes at the lower end, along x and along y.
    low: [bool; 2],
    /// The same at the upper end.
    high: [bool; 2],
    /// Whether it winds around the lattice.
    winds: [bool; 2],
}

impl Reach {
    fn or(self, other: Self) -> Self {
        let or = |a: [bool; 2], b: [bool; 2]| [a[0] || b[0], a[1] || b[1]];
        Self {
            low: or(self.low, other.low),
            high: or(self.high, other.high),
            winds: or(self.winds, other.winds),
        }
    }
}

/// A patch as it was before it joined another.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Part {
    pub(super) root: usize,
    pub(super) nodes: usize,
}

/// The patches that a new node found beside it: at most one for each neighbour.
#[derive(Debug, Default)]
pub(super) struct Parts {
    parts: [Part; 8],
    count: usize,
}

impl Parts {
    pub(super) fn as_slice(&self) -> &[Part] {
        &self.parts[..self.count]
    }

    fn push(&mut self, part: Part) {
        self.parts[self.count] = part;
        self.count += 1;
    }
}

/// Nodes, and the patches that they make.
#[derive(Debug, Clone)]
pub(super) struct Forest {
    lattice: Lattice,
    /// The node above, which for a root is itself.
    parent: Vec<usize>,
    /// Periods from the node above. Between two nodes of a patch there are fewer than the lattice has nodes along
    /// a side, up to one, since each takes a way through all of them: sums of three are far from the ends of the type.
    winding: Vec<Winding>,
    /// Number of nodes of the patch, at its root; 0 for nodes outside all patches, and only for them.
    nodes: Vec<usize>,
    reach: Vec<Reach>,
}

impl Forest {
    pub(super) fn new(lattice: Lattice) -> Self {
        let nodes = lattice.nodes();
        Self {
            lattice,
            parent: (0..nodes).collect(),
            winding: vec![[0; 2]; nodes],
            nodes: vec![0; nodes],
            reach: vec![Reach::default(); nodes],
        }
    }

    pub(super) fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Whether a node belongs to a patch.
    pub(super) fn contains(&self, node: usize) -> bool {
        self.nodes[node] > 0
    }

    /// The root of the patch of a node, and the periods from there to the node.
    pub(super) fn find(&mut self, node: usize) -> (usize, Winding) {
        let (mut root, mut total) = (node, [0; 2]);
        while self.parent[root] != root {
            total = sum(total, self.winding[root]);
            root = self.parent[root];
        }
        let (mut at, mut rest) = (node, total);
        while self.parent[at] != root {
            let (next, winding) = (self.parent[at], self.winding[at]);
            self.parent[at] = root;
            self.winding[at] = rest;
            rest = difference(rest, winding);
            at = next;
        }
        (root, total)
    }

    /// Number of nodes in the patch of a node.
    pub(super) fn size(&mut self, node: usize) -> usize {
        let (root, _) = self.find(node);
        self.nodes[root]
    }

    /// Whether the patch of a node percolates along an axis: around the lattice if it has no ends there, else from
    /// one to the other.
    pub(super) fn percolates(&mut self, node: usize, axis: Axis) -> bool {
        let (root, _) = self.find(node);
        let (reach, k) = (self.reach[root], place(axis));
        if self.lattice.wraps(axis) { reach.winds[k] } else { reach.low[k] && reach.high[k] }
    }

    /// Adds a node, which joins the patches of its neighbours; returns them as they were before.
    pub(super) fn add(&mut self, node: usize) -> Parts {
        let (low, high) = self.lattice.at_ends(node);
        self.nodes[node] = 1;
        self.reach[node] = Reach { low, high, winds: [false; 2] };
        let mut parts = Parts::default();
        for neighbour in self.lattice.neighbours(node) {
            if self.contains(neighbour.node)
                && let Some(part) = self.join(node, neighbour)
            {
                parts.push(part);
            }
        }
        parts
    }

    /// Makes the patches of two neighbours one; returns that of the second, if it was another.
    fn join(&mut self, node: usize, neighbour: Neighbour) -> Option<Part> {
        let (first, to_node) = self.find(node);
        let (second, to_neighbour) = self.find(neighbour.node);
        let between = difference(sum(to_node, neighbour.winding), to_neighbour);
        if first == second {
            for (winds, periods) in self.reach[first].winds.iter_mut().zip(between) {
                *winds |= periods != 0;
            }
            return None;
        }
        let part = Part { root: second, nodes: self.nodes[second] };
        let (above, below, winding) = if self.nodes[first] >= self.nodes[second] {
            (first, second, between)
        } else {
            (second, first, difference([0; 2], between))
        };
        self.parent[below] = above;
        self.winding[below] = winding;
        self.nodes[above] += self.nodes[below];
        self.reach[above] = self.reach[above].or(self.reach[below]);
        Some(part)
    }
}

fn sum(a: Winding, b: Winding) -> Winding {
    [a[0] + b[0], a[1] + b[1]]
}

fn difference(a: Winding, b: Winding) -> Winding {
    [a[0] - b[0], a[1] - b[1]]
}
