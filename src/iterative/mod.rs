//! What iterations need: the influence operator on a contact set, a sparse approximation of its
//! inverse, and preconditioned conjugate gradients, all in O(grid) memory.

#[cfg(test)]
mod comparison;
mod directions;
mod lattice;
mod operator;
mod pcg;
mod sparse_inverse;
mod vector;

pub(crate) use directions::Directions;
pub(crate) use operator::Operator;
pub(crate) use pcg::LinearSystem;
pub(crate) use sparse_inverse::SparseInverse;
pub(crate) use vector::{add_scaled, dot, greatest, sum, sum_over};

/// The contact set: nodes in the order of their indices, and where each is among them.
#[derive(Debug, Clone)]
pub(crate) struct ContactSet {
    nodes: Vec<u32>,
    /// For each node of the grid its place in `nodes`, or [`ContactSet::NONE`].
    places: Vec<u32>,
}

impl ContactSet {
    /// Marks a node that is not in contact.
    pub(crate) const NONE: u32 = u32::MAX;

    /// An empty set on a grid of so many nodes, at most 2³⁰.
    pub(crate) fn new(grid_nodes: usize) -> Self {
        Self {
            nodes: Vec::new(),
            places: vec![Self::NONE; grid_nodes],
        }
    }

    /// Makes it the nodes for which `is_in` holds. Returns whether that changed anything.
    pub(crate) fn assign(&mut self, is_in: impl Fn(usize) -> bool) -> bool {
        let mut changed = false;
        self.nodes.clear();
        for (node, place) in self.places.iter_mut().enumerate() {
            if is_in(node) {
                changed |= *place == Self::NONE;
                *place = self.nodes.len() as u32;
                self.nodes.push(node as u32);
            } else {
                changed |= *place != Self::NONE;
                *place = Self::NONE;
            }
        }
        changed
    }

    /// The nodes, in the order of their indices.
    pub(crate) fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// For each node of the grid its place among [`Self::nodes`], or [`Self::NONE`].
    pub(crate) fn places(&self) -> &[u32] {
        &self.places
    }

    /// Number of nodes in contact.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The values of a field of the grid at the nodes in contact.
    pub(crate) fn gather(&self, field: &[f64], values: &mut Vec<f64>) {
        values.clear();
        values.extend(self.nodes.iter().map(|&node| field[node as usize]));
    }

    /// Writes values at the nodes in contact into a field of the grid.
    pub(crate) fn scatter(&self, values: &[f64], field: &mut [f64]) {
        for (&node, &value) in self.nodes.iter().zip(values) {
            field[node as usize] = value;
        }
    }
}
