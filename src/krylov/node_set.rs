//! A set of nodes, such as a contact, in the order of their indices.

use std::ops::Range;

use super::Value;
use super::tuning::CHUNK;
use crate::parallel::for_each_chunk;

/// A set of nodes in the order of their indices, and where each is among them.
#[derive(Debug, Clone)]
pub(crate) struct NodeSet {
    nodes: Vec<u32>,
    /// For each node of the grid its place in `nodes`, or [`NodeSet::NONE`].
    places: Vec<u32>,
}

/// A node that enters a set, or leaves it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Change {
    pub(crate) node: u32,
    pub(crate) enters: bool,
}

impl NodeSet {
    /// Marks a node that is not in contact.
    pub(crate) const NONE: u32 = u32::MAX;

    /// An empty set on a grid of so many nodes, at most 2³⁰.
    pub(crate) fn new(grid_nodes: usize) -> Self {
        Self { nodes: Vec::new(), places: vec![Self::NONE; grid_nodes] }
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

    /// Whether a node of the grid is one of them.
    pub(crate) fn contains(&self, node: usize) -> bool {
        self.places[node] != Self::NONE
    }

    /// For each node of the grid its place among [`Self::nodes`], or [`Self::NONE`].
    pub(crate) fn places(&self) -> &[u32] {
        &self.places
    }

    /// Number of nodes in contact.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The changes that lead to `other`, in the order of the nodes.
    pub(crate) fn changes(&self, other: &Self) -> Vec<Change> {
        let mut changes = Vec::new();
        for (node, (old, new)) in self.places.iter().zip(&other.places).enumerate() {
            let enters = *new != Self::NONE;
            if enters != (*old != Self::NONE) {
                changes.push(Change { node: node as u32, enters });
            }
        }
        changes
    }

    /// The values of a field of the grid at the nodes in contact.
    pub(crate) fn gather<T: Value>(&self, field: &[T], values: &mut Vec<T>) {
        self.fill(values, |_, node| field[node]);
    }

    /// value(place, node) at the nodes in contact.
    pub(crate) fn fill<T: Value>(
        &self,
        values: &mut Vec<T>,
        value: impl Fn(usize, usize) -> T + Sync + Send,
    ) {
        values.resize(self.nodes.len(), T::default());
        for_each_chunk(values, CHUNK, |chunk, values| {
            let places = chunk * CHUNK..;
            let nodes = &self.nodes[chunk * CHUNK..];
            for ((target, place), &node) in values.iter_mut().zip(places).zip(nodes) {
                *target = value(place, node as usize);
            }
        });
    }

    /// Makes a field of the grid that of values at the nodes in contact, and zero elsewhere.
    pub(crate) fn spread<T: Value>(&self, values: &[T], field: &mut [T]) {
        for_each_chunk(field, CHUNK, |chunk, field| {
            let first = chunk * CHUNK;
            let own = self.within(first, field.len());
            field.fill(T::default());
            for (&node, value) in self.nodes[own.clone()].iter().zip(&values[own]) {
                field[node as usize - first] = *value;
            }
        });
    }

    /// Where among [`Self::nodes`] those from `first` on are, as far as `length`.
    pub(crate) fn within(&self, first: usize, length: usize) -> Range<usize> {
        let below = |end: usize| self.nodes.partition_point(|&node| (node as usize) < end);
        below(first)..below(first + length)
    }

    /// Writes values at the nodes in contact into a field of the grid.
    pub(crate) fn scatter(&self, values: &[f64], field: &mut [f64]) {
        for (&node, &value) in self.nodes.iter().zip(values) {
            field[node as usize] = value;
        }
    }
}
