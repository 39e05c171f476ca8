//! Laplacians of weighted graphs, kept as their edges: `(A x)ᵢ = eᵢ xᵢ + Σⱼ wᵢⱼ (xᵢ − xⱼ)` with positive weights.
//!
//! No number is ever the difference of two others. Sums of weights are therefore right to rounding, each relative to
//! itself, however far the weights are apart; diagonals of a matrix would lose those that are small beside others.

/// A graph, and the conductances from its nodes to a ground.
#[derive(Debug, Clone, Default)]
pub(super) struct Graph {
    /// Where the neighbours of each node begin, and the end.
    start: Vec<usize>,
    neighbours: Vec<u32>,
    weights: Vec<f64>,
    /// Conductance to the ground.
    pub(super) ground: Vec<f64>,
    /// The sum of all conductances of a node.
    diagonal: Vec<f64>,
}

impl Graph {
    /// Of nodes, one after the other.
    pub(super) fn with_capacity(nodes: usize) -> Self {
        let mut start = Vec::with_capacity(nodes + 1);
        start.push(0);
        Self { start, ..Self::default() }
    }

    /// Adds the next node with its edges; each edge is added at both its ends.
    pub(super) fn push(&mut self, ground: f64, edges: impl Iterator<Item = (u32, f64)>) {
        let mut diagonal = ground;
        for (other, weight) in edges {
            self.neighbours.push(other);
            self.weights.push(weight);
            diagonal += weight;
        }
        self.start.push(self.neighbours.len());
        self.ground.push(ground);
        self.diagonal.push(diagonal);
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.ground.len()
    }

    /// Number of edges, each counted at both ends.
    pub(super) fn edge_ends(&self) -> usize {
        self.neighbours.len()
    }

    /// Neighbours of a node, with weights.
    pub(super) fn edges(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let all = self.start[node]..self.start[node + 1];
        let neighbours = self.neighbours[all.clone()].iter().map(|&other| other as usize);
        neighbours.zip(self.weights[all].iter().copied())
    }

    /// The sum of all conductances of a node.
    pub(super) fn diagonal(&self, node: usize) -> f64 {
        self.diagonal[node]
    }

    /// The graph of groups of nodes, `groups` of them: conductances between groups are the sums of those between their
    /// nodes.
    pub(super) fn grouped(&self, group_of: &[u32], groups: usize) -> Self {
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); groups];
        for (node, &group) in group_of.iter().enumerate() {
            members[group as usize].push(node as u32);
        }
        let mut coarse = Self::with_capacity(groups);
        // Where the edge to a group is among those of the present one.
        let mut place = vec![usize::MAX; groups];
        let mut edges: Vec<(u32, f64)> = Vec::new();
        for (group, members) in members.iter().enumerate() {
            edges.clear();
            let mut ground = 0.0;
            for &node in members {
                ground += self.ground[node as usize];
                for (other, weight) in self.edges(node as usize) {
                    let other = group_of[other];
                    if other as usize == group {
                        continue;
                    }
                    match edges.get_mut(place[other as usize]) {
                        Some((_, sum)) => *sum += weight,
                        None => {
                            place[other as usize] = edges.len();
                            edges.push((other, weight));
                        }
                    }
                }
            }
            for (other, _) in &edges {
                place[*other as usize] = usize::MAX;
            }
            coarse.push(ground, edges.iter().copied());
        }
        coarse
    }

    /// The solution on a small graph, by elimination without a subtraction (Grassmann, Taksar and Heyman).
    pub(super) fn eliminate(&self, b: &[f64], x: &mut [f64]) {
        let n = self.len();
        // Column n is the ground, column n + 1 the right-hand side.
        let mut rows = vec![0.0; n * (n + 2)];
        let at = |row: usize, column: usize| row * (n + 2) + column;
        for node in 0..n {
            rows[at(node, n)] = self.ground[node];
            rows[at(node, n + 1)] = b[node];
            for (other, weight) in self.edges(node) {
                rows[at(node, other)] += weight;
            }
        }
        for node in (0..n).rev() {
            let sum: f64 = (0..node).chain([n]).map(|column| rows[at(node, column)]).sum();
            for row in 0..node {
                // A node without any conductance gives nothing on.
                let part = rows[at(row, node)] / sum;
                if part > 0.0 {
                    for column in (0..node).chain([n, n + 1]).filter(|&column| column != row) {
                        rows[at(row, column)] += part * rows[at(node, column)];
                    }
                }
            }
            rows[at(node, node)] = sum;
        }
        for node in 0..n {
            let inflow: f64 = (0..node).map(|other| rows[at(node, other)] * x[other]).sum();
            let sum = rows[at(node, node)];
            x[node] = if sum > 0.0 { (rows[at(node, n + 1)] + inflow) / sum } else { 0.0 };
        }
    }
}

/// The same as a matrix to calculate with: each edge once, at the later one of its nodes. What flows through it is
/// taken from one node and given to the other.
#[derive(Debug, Clone)]
pub(super) struct Matrix {
    start: Vec<usize>,
    /// The earlier node of each edge.
    earlier: Vec<u32>,
    weights: Vec<f64>,
    ground: Vec<f64>,
    /// Reciprocals of the diagonal.
    inverses: Vec<f64>,
}

impl Matrix {
    pub(super) fn new(graph: &Graph) -> Self {
        let mut matrix = Self {
            start: vec![0],
            earlier: Vec::new(),
            weights: Vec::new(),
            ground: graph.ground.clone(),
            inverses: graph.diagonal.iter().map(|diagonal| 1.0 / diagonal).collect(),
        };
        for node in 0..graph.len() {
            for (other, weight) in graph.edges(node).filter(|(other, _)| *other < node) {
                matrix.earlier.push(other as u32);
                matrix.weights.push(weight);
            }
            matrix.start.push(matrix.earlier.len());
        }
        matrix
    }

    /// Edges to earlier nodes.
    fn edges(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let all = self.start[node]..self.start[node + 1];
        let earlier = self.earlier[all.clone()].iter().map(|&other| other as usize);
        earlier.zip(self.weights[all].iter().copied())
    }

    /// `product = A x`.
    pub(super) fn apply(&self, x: &[f64], product: &mut [f64]) {
        for node in 0..x.len() {
            let own = x[node];
            let mut sum = self.ground[node] * own;
            for (other, weight) in self.edges(node) {
                let flow = weight * (own - x[other]);
                sum += flow;
                product[other] -= flow;
            }
            product[node] = sum;
        }
    }

    /// Sweeps forwards from zero: the lower triangle of A, inverted. `residual` becomes what is left of `b`: nodes
    /// before are up to date when a node is, so that it comes from those behind it.
    pub(super) fn sweep_forwards(&self, b: &[f64], x: &mut [f64], residual: &mut [f64]) {
        for node in 0..x.len() {
            let inflow: f64 = self.edges(node).map(|(other, weight)| weight * x[other]).sum();
            let value = (b[node] + inflow) * self.inverses[node];
            x[node] = value;
            residual[node] = 0.0;
            for (other, weight) in self.edges(node) {
                residual[other] += weight * value;
            }
        }
    }

    /// Sweeps backwards over what there is: the transpose of a sweep forwards. `inflow` is overwritten.
    pub(super) fn sweep_backwards(&self, b: &[f64], x: &mut [f64], inflow: &mut [f64]) {
        inflow.copy_from_slice(b);
        for node in (0..x.len()).rev() {
            let before: f64 = self.edges(node).map(|(other, weight)| weight * x[other]).sum();
            let value = (inflow[node] + before) * self.inverses[node];
            x[node] = value;
            for (other, weight) in self.edges(node) {
                inflow[other] += weight * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of four nodes with conductances 1, 1e-20 and 1, the first grounded by 2 and the last by 3e-20.
    fn chain() -> Graph {
        let weights = [1.0, 1e-20, 1.0];
        let mut graph = Graph::with_capacity(4);
        for node in 0..4_usize {
            let before = node.checked_sub(1).map(|other| (other as u32, weights[other]));
            let behind = (node < 3).then(|| (node as u32 + 1, weights[node.min(2)]));
            let ground = [2.0, 0.0, 0.0, 3e-20][node];
            graph.push(ground, before.into_iter().chain(behind));
        }
        graph
    }

    /// Under 1e-20 into the last node: of the two ways to the ground one conducts 3e-20 and the other 1 / (1/2 + 1 +
    /// 1e20 + 1), which is 1e-20; the last node is at 1/4 plus 3/4 of the drop of its part through weights of 1, which
    /// is below rounding.
    #[test]
    fn conductances_far_apart_are_solved_to_rounding() {
        let graph = chain();
        let mut x = [0.0; 4];
        graph.eliminate(&[0.0, 0.0, 0.0, 1e-20], &mut x);
        let expected = [0.125e-20, 0.375e-20, 0.25, 0.25];
        for (x, expected) in x.iter().zip(expected) {
            assert!((x / expected - 1.0_f64).abs() < 1e-14, "{x:e} {expected:e}");
        }
    }

    #[test]
    fn elimination_inverts_the_product() {
        let mut graph = Graph::with_capacity(3);
        graph.push(1.0, [(1, 2.0), (2, 5.0)].into_iter());
        graph.push(0.0, [(0, 2.0), (2, 3.0)].into_iter());
        graph.push(4.0, [(0, 5.0), (1, 3.0)].into_iter());
        let (x, mut b, mut found) = ([1.0, -2.0, 3.0], [0.0; 3], [0.0; 3]);
        Matrix::new(&graph).apply(&x, &mut b);
        // By hand: 1 + 2·3 − 5·2, −2·3 − 3·5, 12 + 5·2 + 3·5.
        assert_eq!(b, [-3.0, -21.0, 37.0]);
        graph.eliminate(&b, &mut found);
        for (found, x) in found.iter().zip(x) {
            assert!((found - x).abs() < 1e-14);
        }
    }

    /// Groups {0, 1} and {2, 3} of the chain: 1e-20 between them.
    #[test]
    fn groups_conduct_what_their_nodes_do() {
        let coarse = chain().grouped(&[0, 0, 1, 1], 2);
        assert_eq!(coarse.ground, [2.0, 3e-20]);
        assert_eq!(coarse.edges(0).collect::<Vec<_>>(), [(1, 1e-20)]);
        assert_eq!(coarse.edges(1).collect::<Vec<_>>(), [(0, 1e-20)]);
        assert_eq!((coarse.diagonal(0), coarse.edge_ends()), (2.0 + 1e-20, 2));
    }

    /// A sweep forwards leaves the residual that it says, and both sweeps together are symmetric.
    #[test]
    fn sweeps_are_each_others_transposes() {
        let matrix = Matrix::new(&chain());
        let both = |b: [f64; 4]| {
            let (mut x, mut residual, mut product) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            matrix.sweep_forwards(&b, &mut x, &mut residual);
            matrix.apply(&x, &mut product);
            for node in 0..4 {
                assert!((b[node] - product[node] - residual[node]).abs() < 1e-15);
            }
            matrix.sweep_backwards(&b, &mut x, &mut residual);
            x
        };
        let units = [0, 1, 2, 3].map(|node| {
            let mut unit = [0.0; 4];
            unit[node] = 1.0;
            both(unit)
        });
        for i in 0..4 {
            for j in 0..4 {
                let scale = (units[i][i] * units[j][j]).sqrt();
                assert!((units[i][j] - units[j][i]).abs() <= 1e-15 * scale);
            }
        }
    }
}
