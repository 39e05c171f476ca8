//! Elimination of the nodes of a network, without a subtraction: conductances may be any number of decades apart.
//!
//! Without a node its neighbours are joined to each other, those of conductances a and b by a b / d more, d being the
//! sum of all at the node (from a star to a mesh; Grassmann, Taksar and Heyman do the same with Markov chains). All are
//! sums, products and quotients of positive numbers, so that each is right to rounding, relative to itself. Backwards,
//! the pressure of a node is the mean of those of its neighbours, weighted by their conductances: the difference to the
//! strongest one is added to its pressure. The error of the flow through any channel is then rounding of what flows
//! through the meshes, which is no more than the whole flow.
//!
//! Nodes are eliminated in the order of nested dissection: lines of nodes that divide the others come after them.
//! Fill-in is some 8 n log₂ n numbers on n nodes, work some 10 n^(3/2) (George, SIAM J. Numer. Anal. 10 (1973) 345).

use super::expansion::{Expansion, difference, sum};
use super::graph::Graph;

/// Nodes that are eliminated without dividing them further.
const FEW: usize = 8;

/// Nodes that are eliminated one after the other, first those of a part of the grid and at last the line that divides
/// it.
#[derive(Debug)]
struct Block {
    /// The nodes that are eliminated, and all that they are joined to then.
    nodes: Vec<u32>,
    /// Sums of the conductances of the former.
    diagonals: Vec<f64>,
    /// For each of the former the share of each node behind it in this sum.
    shares: Vec<f64>,
}

/// What is left of a block: conductances between its nodes.
struct Mesh {
    nodes: Vec<u32>,
    /// A square whose last rows and columns hold them, above the diagonal.
    rows: Vec<f64>,
    /// Number of the nodes before.
    eliminated: usize,
}

impl Mesh {
    /// Adds it to the conductances, above the diagonal, between nodes with these places.
    fn add_to(&self, sums: &mut [f64], places: &[u32], size: usize) {
        let own = self.eliminated + self.nodes.len();
        for (i, &node) in self.nodes.iter().enumerate() {
            let row = &self.rows[(self.eliminated + i) * own + self.eliminated..];
            let from = places[node as usize] as usize;
            for (&other, conductance) in self.nodes[i + 1..].iter().zip(&row[i + 1..]) {
                let to = places[other as usize] as usize;
                sums[from.min(to) * size + from.max(to)] += conductance;
            }
        }
    }
}

/// An eliminated network between two ends, which have the numbers behind all nodes.
#[derive(Debug)]
pub(super) struct Elimination {
    blocks: Vec<Block>,
    nodes: usize,
}

impl Elimination {
    /// Eliminates all nodes. They lie at `places` of a lattice, and edges lead from one place to the next; along the
    /// second direction also from the last place of a `ring` to the first, if it is one.
    pub(super) fn new(graph: &Graph, places: &[[usize; 2]], ring: Option<usize>) -> Self {
        let nodes = graph.len();
        let (eliminated, front) = (vec![false; nodes + 2], vec![NONE; nodes + 2]);
        let blocks = Vec::new();
        let mut dissection = Dissection { graph, places, ring, eliminated, front, blocks };
        dissection.dissect((0..nodes as u32).collect());
        Self { blocks: dissection.blocks, nodes }
    }

    /// The pressures under what flows into each node, and under those of both ends.
    pub(super) fn solve(&self, inflow: &[f64], ends: [f64; 2]) -> Vec<Expansion> {
        let mut inflow = inflow.to_vec();
        inflow.extend([0.0; 2]);
        for block in &self.blocks {
            let mut shares = block.shares.as_slice();
            for (k, &node) in block.nodes.iter().take(block.diagonals.len()).enumerate() {
                let (own, others) = shares.split_at(block.nodes.len() - k - 1);
                shares = others;
                let flow = inflow[node as usize];
                for (share, &other) in own.iter().zip(&block.nodes[k + 1..]) {
                    inflow[other as usize] += share * flow;
                }
            }
        }
        let mut pressures = vec![[0.0; 4]; self.nodes + 2];
        for (pressure, end) in pressures[self.nodes..].iter_mut().zip(ends) {
            pressure[0] = end;
        }
        for block in self.blocks.iter().rev() {
            let mut shares = block.shares.as_slice();
            for (k, diagonal) in block.diagonals.iter().enumerate().rev() {
                let others = &block.nodes[k + 1..];
                let (before, own) = shares.split_at(shares.len() - others.len());
                shares = before;
                let node = block.nodes[k] as usize;
                let strongest =
                    own.iter().zip(others).fold((0.0, node), |most, (&share, &other)| {
                        if share > most.0 { (share, other as usize) } else { most }
                    });
                let base = pressures[strongest.1];
                let mut more = inflow[node] / diagonal;
                for (share, &other) in own.iter().zip(others) {
                    more += share * difference(pressures[other as usize], base);
                }
                pressures[node] = sum(base, more);
            }
        }
        pressures.truncate(self.nodes);
        pressures
    }
}

/// No place in a front.
const NONE: u32 = u32::MAX;

/// An elimination under way.
struct Dissection<'a> {
    graph: &'a Graph,
    places: &'a [[usize; 2]],
    /// The last place along the second direction, if an edge leads from there to the first.
    ring: Option<usize>,
    eliminated: Vec<bool>,
    /// The place of each node among those of the present block.
    front: Vec<u32>,
    blocks: Vec<Block>,
}

impl Dissection<'_> {
    /// Eliminates some nodes: those at both sides of a line first.
    fn dissect(&mut self, nodes: Vec<u32>) -> Mesh {
        if nodes.len() <= FEW {
            return self.eliminate(nodes, Vec::new());
        }
        let places = self.places;
        let sorted = |axis: usize| {
            let mut all: Vec<usize> =
                nodes.iter().map(|&node| places[node as usize][axis]).collect();
            all.sort_unstable();
            all
        };
        let length = |sorted: &[usize]| sorted[sorted.len() - 1] - sorted[0];
        let [along, across] = [sorted(0), sorted(1)];
        // A ring is opened once it is no longer than wide.
        let is_ring = across[0] == 0 && self.ring == across.last().copied();
        if is_ring && length(&along) <= length(&across) {
            let (line, others) = nodes.iter().partition(|node| places[**node as usize][1] == 0);
            return self.eliminate(line, vec![others]);
        }
        let (axis, sorted) =
            if length(&along) >= length(&across) { (0, along) } else { (1, across) };
        let middle = sorted[sorted.len() / 2];
        let place = |node: &u32| places[*node as usize][axis];
        let (line, others): (Vec<u32>, Vec<u32>) =
            nodes.iter().partition(|&node| place(node) == middle);
        let (before, behind) = others.into_iter().partition(|node| place(node) < middle);
        self.eliminate(line, vec![before, behind])
    }

    /// Eliminates parts, and then a line of nodes between them.
    fn eliminate(&mut self, line: Vec<u32>, parts: Vec<Vec<u32>>) -> Mesh {
        let meshes: Vec<Mesh> = parts.into_iter().map(|part| self.dissect(part)).collect();
        let (mut nodes, own) = self.front(line, &meshes);
        let size = nodes.len();
        let mut rows = vec![0.0; size * size];
        for (k, &node) in nodes.iter().take(own).enumerate() {
            for (other, weight) in self.graph.edges(node as usize) {
                // Edges to nodes before are in the meshes, and each edge between two of these nodes is met twice.
                let place = self.front[other] as usize;
                if !self.eliminated[other] && place > k {
                    rows[k * size + place] += weight;
                }
            }
        }
        for mesh in &meshes {
            mesh.add_to(&mut rows, &self.front, size);
        }
        for &node in &nodes {
            self.front[node as usize] = NONE;
        }
        let (mut diagonals, mut shares) = (Vec::with_capacity(own), Vec::new());
        for (k, &node) in nodes.iter().take(own).enumerate() {
            self.eliminated[node as usize] = true;
            let (before, behind) = rows.split_at_mut((k + 1) * size);
            let conductances = &before[k * size + k + 1..];
            let diagonal: f64 = conductances.iter().sum();
            diagonals.push(diagonal);
            let first = shares.len();
            shares.extend(conductances.iter().map(|conductance| conductance / diagonal));
            for (row, (i, share)) in
                behind.chunks_exact_mut(size).zip(shares[first..].iter().enumerate())
            {
                if *share > 0.0 {
                    let others = row[k + 2 + i..].iter_mut().zip(&conductances[i + 1..]);
                    others.for_each(|(sum, conductance)| *sum += share * conductance);
                }
            }
        }
        let left = nodes[own..].to_vec();
        nodes.shrink_to_fit();
        self.blocks.push(Block { nodes, diagonals, shares });
        Mesh { nodes: left, rows, eliminated: own }
    }

    /// The nodes of a line, their number, and behind them all that they and the meshes are joined to; each knows its
    /// place.
    fn front(&mut self, line: Vec<u32>, meshes: &[Mesh]) -> (Vec<u32>, usize) {
        let (mut nodes, own) = (Vec::new(), line.len());
        let edges = line.iter().flat_map(|&node| self.graph.edges(node as usize));
        let joined =
            edges.map(|(other, _)| other as u32).filter(|&other| !self.eliminated[other as usize]);
        let left = meshes.iter().flat_map(|mesh| &mesh.nodes).copied();
        for node in line.iter().copied().chain(joined).chain(left) {
            let place = &mut self.front[node as usize];
            if *place == NONE {
                *place = nodes.len() as u32;
                nodes.push(node);
            }
        }
        (nodes, own)
    }
}
