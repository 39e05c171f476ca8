//! A sparse inverse Cholesky factor of the influence matrix of a contact set.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::lattice::{Lattice, Lattices, Neighbour};
use super::tuning::{
    CHUNK, FEW, GROWTH, MANY, NEIGHBOURS, PARTS, SAME_INFLUENCE, SEARCH, SEARCHED,
};
use super::{Change, NodeSet, greatest};
use crate::kernel::KernelTable;
use crate::parallel::{for_each_block, for_each_chunk, vectorized};

/// ```math
/// M = U U^T \approx C_{II}^{-1}
/// ```
///
/// the best in the sense of Kullback and Leibler for its sparsity. Nodes are ordered coarse to fine.
/// Each conditions on the k earlier nodes of greatest influence: with A their influence matrix and a
/// their influence on the node, `w = A⁻¹ a` and `v = C(0, 0) − aᵀ w`, its column of U is
/// `(1, −w) / √v` (Vecchia; Schäfer, Katzfuss and Owhadi, SIAM J. Sci. Comput. 43 (2021) A2019). M is
/// positive definite by construction, in whatever precision the columns are computed: here single.
///
/// Nodes whose neighbours lie at the same offsets share a column: its pattern.
#[derive(Debug, Clone)]
pub(crate) struct SparseInverse<const K: usize = NEIGHBOURS> {
    lattices: Lattices,
    /// 1 / C(0, 0).
    unit: f64,
    contact: NodeSet,
    /// The pattern of each node of the grid that is in contact.
    chosen: Vec<u32>,
    patterns: Vec<Pattern<K>>,
    index: HashMap<Found<K>, u32>,
    /// Number of patterns when all neighbours were last looked for.
    fresh: usize,
    /// What M is applied to, and what comes of it, on the whole grid; of the nodes of each part what
    /// lies in others.
    source: Vec<f32>,
    result: Vec<f32>,
    outside: Vec<Vec<(u32, f32)>>,
}

/// Where the neighbours of a node are; missing ones at the node itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Found<const K: usize> {
    level: u32,
    count: u32,
    neighbours: [Neighbour; K],
}

/// A column of U.
#[derive(Debug, Clone, Copy)]
struct Pattern<const K: usize> {
    /// From the index of the node to those of its neighbours.
    steps: [i32; K],
    weights: [f32; K],
    /// 1 / v, times C(0, 0).
    precision: f32,
    /// Nodes of less influence, relative to C(0, 0), are no neighbours, whether in contact or not.
    least: f32,
}

impl<const K: usize> SparseInverse<K> {
    /// Bytes taken for each node in contact at most: a pattern of its own, and its entry in an index
    /// that may be half empty.
    pub(crate) const BYTES_A_NODE: usize =
        size_of::<Pattern<K>>() + 2 * size_of::<(Found<K>, u32)>() + size_of::<u32>();

    /// For an empty contact set.
    pub(crate) fn new(table: &KernelTable) -> Self {
        let nodes = table.grid().nodes();
        Self {
            lattices: Lattices::new(table),
            unit: 1.0 / table.self_influence(),
            contact: NodeSet::new(nodes),
            chosen: vec![0; nodes],
            patterns: Vec::new(),
            index: HashMap::default(),
            fresh: 0,
            source: vec![0.0; nodes],
            result: vec![0.0; nodes],
            outside: vec![Vec::new(); PARTS],
        }
    }

    /// The contact set it is of.
    pub(crate) fn contact(&self) -> &NodeSet {
        &self.contact
    }

    /// Makes it that of another contact set, and returns whether it was of another. Only nodes whose
    /// neighbours change cost anything much.
    pub(crate) fn update(&mut self, contact: &NodeSet) -> bool {
        let changes = self.contact.changes(contact);
        if changes.is_empty() {
            return false;
        }
        let all =
            MANY * changes.len() > contact.len() || self.patterns.len() > GROWTH * self.fresh + FEW;
        if all {
            self.patterns.clear();
            self.index.clear();
            self.choose(contact, contact.nodes());
            self.fresh = self.patterns.len();
        } else {
            let affected = self.affected(&changes, contact);
            self.choose(contact, &affected);
        }
        self.contact.clone_from(contact);
        true
    }

    /// Nodes of the new contact whose neighbours may change, in the order of their indices.
    fn affected(&self, changes: &[Change], contact: &NodeSet) -> Vec<u32> {
        let (old, new) = (self.contact.places(), contact.places());
        let mut affected = Vec::new();
        for change in changes {
            if change.enters {
                affected.push(change.node);
            }
            self.lattices.later(change.node as usize, |node, influence| {
                let stays = old[node] != NodeSet::NONE && new[node] != NodeSet::NONE;
                if stays && influence >= self.patterns[self.chosen[node] as usize].least {
                    affected.push(node as u32);
                }
            });
        }
        affected.sort_unstable();
        affected.dedup();
        affected
    }

    /// Chooses the patterns of some nodes of a contact set.
    fn choose(&mut self, contact: &NodeSet, nodes: &[u32]) {
        let (lattices, places) = (&self.lattices, contact.places());
        let mut found = Vec::new();
        for nodes in nodes.chunks(SEARCHED) {
            found.resize(nodes.len(), Found::NONE);
            for_each_chunk(&mut found, SEARCH, |chunk, found| {
                for (found, &node) in found.iter_mut().zip(&nodes[chunk * SEARCH..]) {
                    let is_in = |node: usize| places[node] != NodeSet::NONE;
                    *found = Found::of(lattices, node, is_in);
                }
            });
            let first = self.patterns.len();
            let mut new = Vec::new();
            for (found, &node) in found.iter().zip(nodes) {
                self.chosen[node as usize] = match self.index.entry(*found) {
                    Entry::Occupied(pattern) => *pattern.get(),
                    Entry::Vacant(place) => {
                        let pattern = (first + new.len()) as u32;
                        new.push(*found);
                        *place.insert(pattern)
                    }
                };
            }
            self.patterns.resize(first + new.len(), Pattern::ALONE);
            for_each_chunk(&mut self.patterns[first..], SEARCH, |chunk, patterns| {
                for (pattern, found) in patterns.iter_mut().zip(&new[chunk * SEARCH..]) {
                    let lattice = lattices.level(found.level);
                    vectorized(
                        #[inline(always)]
                        || pattern.fill(lattice, found),
                    );
                }
            });
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.patterns[..])
            + self.index.capacity() * size_of::<(Found<K>, u32)>()
            + self.contact.len() * size_of::<u32>()
            + 4 * size_of_val(self.contact.places())
    }

    /// y = M x for values at the nodes in contact, in single precision.
    pub(crate) fn apply(&mut self, x: &[f64], y: &mut Vec<f64>) {
        let nodes = self.contact.nodes();
        let most = greatest(x.len(), 0.0, |i| x[i].abs());
        let scale = if most == 0.0 { 1.0 } else { most };
        let per_scale = 1.0 / scale;
        for_each_chunk(&mut self.source, CHUNK, |chunk, source| {
            let first = chunk * CHUNK;
            let own = self.contact.within(first, source.len());
            for (&node, x) in nodes[own.clone()].iter().zip(&x[own]) {
                source[node as usize - first] = (x * per_scale) as f32;
            }
        });
        let (source, chosen, patterns) = (&self.source, &self.chosen, &self.patterns);
        let part_length = source.len().div_ceil(self.outside.len());
        for_each_block(
            &mut self.result,
            part_length,
            &mut self.outside,
            |part, values, outside| {
                values.fill(0.0);
                outside.clear();
                let first = part * part_length;
                let own = &nodes[self.contact.within(first, values.len())];
                let part = Part { first, values, outside };
                part.add(own, chosen, patterns, source);
            },
        );
        for &(node, value) in self.outside.iter().flatten() {
            self.result[node as usize] += value;
        }
        y.resize(x.len(), 0.0);
        let (result, back) = (&self.result, scale * self.unit);
        for_each_chunk(y, CHUNK, |chunk, y| {
            for (y, &node) in y.iter_mut().zip(&nodes[chunk * CHUNK..]) {
                *y = back * f64::from(result[node as usize]);
            }
        });
    }
}

/// Results of the nodes of a part of the grid: inside it, from node `first` on, and outside.
struct Part<'a> {
    first: usize,
    values: &'a mut [f32],
    outside: &'a mut Vec<(u32, f32)>,
}

impl Part<'_> {
    /// Adds what the columns of some of its nodes make of `source`.
    fn add<const K: usize>(
        self,
        nodes: &[u32],
        chosen: &[u32],
        patterns: &[Pattern<K>],
        source: &[f32],
    ) {
        let Self { first, values, outside } = self;
        for &node in nodes {
            let pattern = &patterns[chosen[node as usize] as usize];
            let at = |step: i32| node.wrapping_add_signed(step) as usize;
            let (mut even, mut odd) = (source[node as usize], 0.0);
            let weights = pattern.weights.chunks_exact(2);
            for (steps, weights) in pattern.steps.chunks_exact(2).zip(weights) {
                even -= weights[0] * source[at(steps[0])];
                odd += weights[1] * source[at(steps[1])];
            }
            let value = pattern.precision * (even - odd);
            let start = node as usize - first;
            values[start] += value;
            let terms = pattern.steps.iter().zip(&pattern.weights);
            for (&step, weight) in terms {
                match values.get_mut(at(step).wrapping_sub(first)) {
                    Some(other) => *other -= weight * value,
                    None => outside.push((at(step) as u32, -weight * value)),
                }
            }
        }
    }
}

impl<const K: usize> Found<K> {
    const NONE: Self =
        Self { level: 0, count: 0, neighbours: [Neighbour { node: 0, offset: 0 }; K] };

    /// The neighbours of a node among those for which `is_in` holds, counted from its own index.
    fn of(lattices: &Lattices, node: u32, is_in: impl Fn(usize) -> bool) -> Self {
        let mut found = Self::NONE;
        let (count, level) = lattices.earlier(node as usize, is_in, &mut found.neighbours);
        (found.count, found.level) = (count as u32, level);
        for neighbour in &mut found.neighbours[..count] {
            neighbour.node = neighbour.node.wrapping_sub(node);
        }
        found
    }
}

impl<const K: usize> Pattern<K> {
    /// That of a node without neighbours.
    const ALONE: Self =
        Self { steps: [0; K], weights: [0.0; K], precision: 1.0, least: f32::NEG_INFINITY };

    /// The column given the neighbours: Gaussian elimination of their k × k influence matrix, with
    /// unit rows for missing ones.
    #[inline(always)]
    fn fill(&mut self, lattice: &Lattice, found: &Found<K>) {
        let count = found.count as usize;
        let found = &found.neighbours;
        self.steps = found.map(|neighbour| neighbour.node as i32);
        if count == K {
            self.least = lattice.between(found[K - 1].offset, 0).abs() - SAME_INFLUENCE;
        }
        let mut matrix = [[0.0_f32; K]; K];
        let mut rhs = [0.0_f32; K];
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = 1.0;
            if i < count {
                rhs[i] = lattice.between(found[i].offset, 0);
                for (value, other) in row[i + 1..count].iter_mut().zip(&found[i + 1..count]) {
                    *value = lattice.between(found[i].offset, other.offset);
                }
            }
        }
        let mut unexplained = 1.0_f32;
        for j in 0..K {
            let pivot_row = matrix[j];
            let inverse = 1.0 / pivot_row[j];
            unexplained -= rhs[j] * rhs[j] * inverse;
            for i in j + 1..K {
                let factor = pivot_row[i] * inverse;
                for (value, pivot) in matrix[i].iter_mut().zip(&pivot_row) {
                    *value -= factor * pivot;
                }
                rhs[i] -= factor * rhs[j];
            }
        }
        for j in (0..K).rev() {
            let row = &matrix[j];
            let mut value = rhs[j];
            for (entry, weight) in row[j + 1..].iter().zip(&self.weights[j + 1..]) {
                value -= entry * weight;
            }
            self.weights[j] = value / row[j];
        }
        self.precision = 1.0 / unexplained;
        // A kernel may be too close to singular for single precision: then the node stands alone.
        let sane = unexplained > 1e-4 && self.weights.iter().all(|weight| weight.is_finite());
        if !sane {
            self.weights = [0.0; K];
            self.precision = 1.0;
        }
    }
}

#[cfg(test)]
mod tests;
