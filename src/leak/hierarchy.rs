//! Coarser and coarser graphs, and cycles through them as a preconditioner.
//!
//! Nodes are grouped in pairs, and these in pairs again, along their strongest edges: what a weak channel joins is
//! grouped after all else. Each group takes one value. Every level is solved by up to two steps of flexible conjugate
//! gradients whose preconditioner is the next one (a K-cycle), with which the number of iterations does not grow with
//! the grid: Notay, Electron. Trans. Numer. Anal. 37 (2010) 123; Napov and Notay, SIAM J. Sci. Comput. 34 (2012) A1079.

use super::graph::{Graph, Matrix};

/// Nodes of a graph that is solved by elimination.
const SMALLEST: usize = 24;
/// Greatest ratio of the energies of the smoother and of the graph that a pair may have: Napov and Notay's threshold.
const QUALITY: f64 = 8.0;
/// A node that finds no other to pair with joins the pair of its strongest neighbour, if that edge has this share of
/// its conductances.
const STRONG: f64 = 0.25;
/// A level is visited twice from the one above if it has at most this share of its edges: the work of all levels is
/// then no more than four times that of the first.
const TWICE: f64 = 0.375;
/// A second step is left out if the first has reduced the residual to this share.
const REDUCED: f64 = 0.25;

/// The matrix of a graph, how its nodes are grouped, and vectors to work with.
#[derive(Debug)]
struct Level {
    matrix: Matrix,
    /// The group of each node; none on the last level.
    group_of: Vec<u32>,
    /// How often the next level is visited from here.
    visits: usize,
    residual: Vec<f64>,
    /// Two directions with their products, for the steps on this level.
    first: [Vec<f64>; 2],
    second: [Vec<f64>; 2],
    /// Right-hand side and solution, for visits from above.
    b: Vec<f64>,
    x: Vec<f64>,
}

impl Level {
    fn new(graph: &Graph) -> Self {
        let vector = || vec![0.0; graph.len()];
        let pair = || [vector(), vector()];
        Self {
            group_of: Vec::new(),
            visits: 1,
            residual: vector(),
            first: pair(),
            second: pair(),
            b: vector(),
            x: vector(),
            matrix: Matrix::new(graph),
        }
    }
}

/// All levels of a graph.
#[derive(Debug)]
pub(super) struct Hierarchy {
    levels: Vec<Level>,
    /// The graph of the last one.
    last: Graph,
}

impl Hierarchy {
    pub(super) fn new(graph: Graph) -> Self {
        let mut levels = vec![Level::new(&graph)];
        let mut last = graph;
        while last.len() > SMALLEST {
            let (group_of, coarse) = coarsen(&last);
            // What can be grouped no more is left to the sweeps.
            if 10 * coarse.len() > 9 * last.len() {
                break;
            }
            let size = |graph: &Graph| (graph.len() + graph.edge_ends()) as f64;
            if let Some(level) = levels.last_mut() {
                level.visits = if size(&coarse) <= TWICE * size(&last) { 2 } else { 1 };
                level.group_of = group_of;
            }
            levels.push(Level::new(&coarse));
            last = coarse;
        }
        Self { levels, last }
    }

    /// The matrix of the graph itself.
    pub(super) fn matrix(&self) -> &Matrix {
        &self.levels[0].matrix
    }

    /// An approximate solution of `A x = b`.
    pub(super) fn precondition(&mut self, b: &[f64], x: &mut [f64]) {
        cycle(&mut self.levels, &self.last, b, x);
    }
}

/// One cycle from a level down to the last one, and back.
fn cycle(levels: &mut [Level], last: &Graph, b: &[f64], x: &mut [f64]) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        return;
    };
    let Some(next) = coarser.first_mut() else {
        if last.len() <= SMALLEST {
            last.eliminate(b, x);
        } else {
            level.matrix.sweep_forwards(b, x, &mut level.residual);
            level.matrix.sweep_backwards(b, x, &mut level.residual);
        }
        return;
    };
    level.matrix.sweep_forwards(b, x, &mut level.residual);
    let mut coarse_b = std::mem::take(&mut next.b);
    let mut coarse_x = std::mem::take(&mut next.x);
    coarse_b.fill(0.0);
    for (residual, group) in level.residual.iter().zip(&level.group_of) {
        coarse_b[*group as usize] += residual;
    }
    if level.visits == 2 && coarser.len() > 1 {
        two_steps(coarser, last, &mut coarse_b, &mut coarse_x);
    } else {
        cycle(coarser, last, &coarse_b, &mut coarse_x);
    }
    for (x, group) in x.iter_mut().zip(&level.group_of) {
        *x += coarse_x[*group as usize];
    }
    if let Some(next) = coarser.first_mut() {
        next.b = coarse_b;
        next.x = coarse_x;
    }
    level.matrix.sweep_backwards(b, x, &mut level.residual);
}

/// Up to two steps of conjugate gradients on the first of these levels, from zero; the residual takes the place of `b`.
fn two_steps(levels: &mut [Level], last: &Graph, b: &mut [f64], x: &mut [f64]) {
    let Some(level) = levels.first_mut() else {
        return;
    };
    let [mut c, mut v] = std::mem::take(&mut level.first);
    let [mut d, mut w] = std::mem::take(&mut level.second);
    cycle(levels, last, b, &mut c);
    levels[0].matrix.apply(&c, &mut v);
    let (curvature, slope) = (dot(&c, &v), dot(&c, b));
    let step = quotient(slope, curvature);
    let before = size(b);
    add(b, -step, &v);
    if size(b) <= REDUCED * before {
        x.copy_from_slice(&c);
        x.iter_mut().for_each(|x| *x *= step);
    } else {
        cycle(levels, last, b, &mut d);
        levels[0].matrix.apply(&d, &mut w);
        // The second direction without its part along the first.
        let along = quotient(dot(&d, &v), curvature);
        let second = quotient(dot(&d, b), dot(&d, &w) - along * along * curvature);
        for ((x, c), d) in x.iter_mut().zip(&c).zip(&d) {
            *x = (step - second * along) * c + second * d;
        }
    }
    levels[0].first = [c, v];
    levels[0].second = [d, w];
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The sum of magnitudes: squares of small ones would be lost.
pub(super) fn size(a: &[f64]) -> f64 {
    a.iter().map(|a| a.abs()).sum()
}

pub(super) fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += factor * b;
    }
}

/// A step of no length where rounding has left no curvature.
pub(super) fn quotient(slope: f64, curvature: f64) -> f64 {
    let quotient = slope / curvature;
    if curvature > 0.0 && quotient.is_finite() { quotient } else { 0.0 }
}

/// Groups in pairs twice.
fn coarsen(graph: &Graph) -> (Vec<u32>, Graph) {
    let diagonals: Vec<f64> = (0..graph.len()).map(|node| graph.diagonal(node)).collect();
    let (first, groups) = paired(graph, &diagonals);
    let pairs = graph.grouped(&first, groups);
    // The smoother is that of the graph: it does nothing for what the strong edge of a pair holds together.
    let mut sums = vec![0.0; groups];
    for (pair, diagonal) in first.iter().zip(&diagonals) {
        sums[*pair as usize] += diagonal;
    }
    let (second, groups) = paired(&pairs, &sums);
    let coarse = pairs.grouped(&second, groups);
    let group_of = first.iter().map(|&pair| second[pair as usize]).collect();
    (group_of, coarse)
}

/// Pairs each node with the neighbour with which it makes the best pair, for a smoother with these diagonals; returns
/// the group of each node, and their number.
fn paired(graph: &Graph, diagonals: &[f64]) -> (Vec<u32>, usize) {
    const NONE: u32 = u32::MAX;
    let mut group_of = vec![NONE; graph.len()];
    let mut groups = 0;
    for node in 0..graph.len() {
        if group_of[node] != NONE {
            continue;
        }
        let mut best: Option<(f64, usize)> = None;
        let mut strongest: Option<(f64, usize)> = None;
        for (other, weight) in graph.edges(node) {
            if group_of[other] == NONE {
                // How much more than the edge the smoother sees in a difference of both nodes.
                let smoothed = 2.0 * in_series(diagonals[node], diagonals[other]);
                let held = weight + in_series(graph.ground[node], graph.ground[other]);
                let quality = smoothed / held;
                if best.is_none_or(|(least, _)| quality < least) {
                    best = Some((quality, other));
                }
            }
            if strongest.is_none_or(|(most, _)| weight > most) {
                strongest = Some((weight, other));
            }
        }
        match (best, strongest) {
            (Some((quality, other)), _) if quality <= QUALITY => {
                group_of[node] = groups;
                group_of[other] = groups;
                groups += 1;
            }
            (_, Some((weight, other)))
                if group_of[other] != NONE && weight >= STRONG * diagonals[node] =>
            {
                group_of[node] = group_of[other];
            }
            _ => {
                group_of[node] = groups;
                groups += 1;
            }
        }
    }
    (group_of, groups as usize)
}

/// Two conductances one behind the other.
fn in_series(a: f64, b: f64) -> f64 {
    let (less, more) = if a < b { (a, b) } else { (b, a) };
    if less > 0.0 { less / (1.0 + less / more) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square lattice with conductances of ten decades in no order, grounded at one side.
    fn lattice(n: usize) -> Graph {
        let mut graph = Graph::with_capacity(n * n);
        let weight = |a: usize, b: usize| {
            let (a, b) = (a.min(b) as u64, a.max(b) as u64);
            let mixed = (a * 0x9E37_79B9 + b).wrapping_mul(0xD6E8_FEB8_6659_FD93) >> 40;
            10_f64.powf(-10.0 * (mixed as f64 / (1_u64 << 24) as f64))
        };
        for node in 0..n * n {
            let (x, y) = (node % n, node / n);
            let others = [
                (x > 0).then(|| node - 1),
                (x + 1 < n).then(|| node + 1),
                (y > 0).then(|| node - n),
                (y + 1 < n).then(|| node + n),
            ];
            let edges = others.into_iter().flatten();
            let ground = if x == 0 { weight(node, node) } else { 0.0 };
            graph.push(ground, edges.map(|other| (other as u32, weight(node, other))));
        }
        graph
    }

    /// Levels shrink, and conductances to the ground are kept: sums of positive numbers, in another order.
    #[test]
    fn levels_shrink_and_keep_their_ground() {
        let all = Hierarchy::new(lattice(40));
        for pair in all.levels.windows(2) {
            let [fine, coarse] = pair else { continue };
            assert!(coarse.x.len() * 2 < fine.x.len());
        }
        let ground = |graph: &Graph| graph.ground.iter().sum::<f64>();
        assert!((ground(&all.last) / ground(&lattice(40)) - 1.0).abs() < 1e-13);
        assert!(all.levels.len() > 3 && all.last.len() <= SMALLEST);
    }

    /// A star of leaves that only hang on one node: all of it is one group.
    #[test]
    fn leaves_join_the_node_they_hang_on() {
        let leaves = 100;
        let mut star = Graph::with_capacity(leaves + 1);
        star.push(1.0, (1..=leaves as u32).map(|leaf| (leaf, 1.0)));
        for _ in 0..leaves {
            star.push(0.0, [(0, 1.0)].into_iter());
        }
        let (group_of, coarse) = coarsen(&star);
        assert_eq!(coarse.len(), 1);
        assert!(group_of.iter().all(|group| *group == 0));
        assert_eq!(coarse.ground, [1.0]);
    }

    /// One iteration with the cycle as preconditioner reduces the error in the energy norm, on conductances of ten
    /// decades too.
    #[test]
    fn a_cycle_is_a_good_solution() {
        let mut all = Hierarchy::new(lattice(40));
        let n = 1600;
        let b: Vec<f64> = (0..n).map(|k| ((k * 7919) % 101) as f64 - 50.0).collect();
        let (mut x, mut product) = (vec![0.0; n], vec![0.0; n]);
        all.precondition(&b, &mut x);
        all.matrix().apply(&x, &mut product);
        // The energy that one step along x gains, of the most that there is to gain, the energy of the solution.
        let step = dot(&b, &x) / dot(&x, &product);
        let gained = step * dot(&b, &x);
        let mut exact = vec![0.0; n];
        lattice(40).eliminate(&b, &mut exact);
        let share = gained / dot(&b, &exact);
        assert!((0.5..=1.0).contains(&share), "{share}");
    }
}
