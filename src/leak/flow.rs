//! The flow through a network: pressures that let nothing be lost at any node.

use super::graph::Graph;
use super::hierarchy::{Hierarchy, add, dot, quotient, size};
use super::network::{Beyond, Network, Place};
use crate::Error;

/// What may be lost at all nodes together, of what flows from edge to edge.
///
/// Rounding loses some 10⁻¹⁶ of the flow through each face, and the flow passes some N to 5 N faces along the N nodes from edge to edge: 10⁻¹² on
/// 4096 of them.
const LOST: f64 = 1e-11;
/// Greatest change of a pressure that a further correction would bring, over the pressure drop: what hangs on a weak channel alone loses
/// little, wherever its pressure is. A correction reduces errors of all kinds by about as much as the residual: this is what multigrid does.
const SETTLED: f64 = 1e-10;
/// Least residual of a correction, relative to what it is to correct: as far as it can be followed in double precision.
const CORRECTED: f64 = 1e-8;
/// A correction leaves less than may be lost, so that it is the last one.
const LESS: f64 = 0.1;
/// Greatest residual of a correction.
const LARGEST: f64 = 1e-2;
/// Most iterations of a correction, and most corrections: a flow of 10⁻³⁶ of what flows at the open edge takes some 7 of them.
const ITERATIONS: usize = 400;
const CORRECTIONS: usize = 20;
/// Corrections that make nothing better before it is given up.
const IDLE: usize = 3;

/// Pressures, relative to the pressure drop, and what flows, relative to the conductance of a square of the greatest gap.
#[derive(Debug)]
pub(super) struct Flow {
    /// Of each flowing node, by its place among them: a sum of three numbers, so that small differences of large pressures are not lost.
    pressures: Vec<[f64; 3]>,
    /// The place of each node of the grid among those that flow.
    numbers: Vec<u32>,
    /// What flows from edge to edge.
    pub(super) rate: f64,
    /// What is lost at all nodes together, over the rate.
    pub(super) lost: f64,
    /// Iterations in all.
    pub(super) iterations: usize,
}

impl Flow {
    /// The flow of a network through which there is one.
    pub(super) fn through(network: &Network, flowing: &[usize]) -> Result<Self, Error> {
        let mut numbers = vec![u32::MAX; network.places.len()];
        for (number, &node) in (0..).zip(flowing) {
            numbers[node] = number;
        }
        let mut hierarchy = Hierarchy::new(graph(network, flowing, &numbers));
        let mut flow = Self {
            pressures: vec![[0.0; 3]; flowing.len()],
            numbers,
            rate: 0.0,
            lost: f64::INFINITY,
            iterations: 0,
        };
        let mut residual = vec![0.0; flowing.len()];
        let mut correction = vec![0.0; flowing.len()];
        let (mut idle, mut change) = (0, f64::INFINITY);
        let mut least = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            flow.rate = flow.residuals(network, flowing, &mut residual);
            let remains = size(&residual);
            flow.lost = remains / flow.rate.abs();
            if flow.lost <= LOST && flow.rate > 0.0 && change <= SETTLED {
                return Ok(flow);
            }
            idle = if remains < 0.5 * least { 0 } else { idle + 1 };
            least = remains.min(least);
            if idle == IDLE || !remains.is_finite() {
                break;
            }
            let enough = LESS * LOST * flow.rate.abs() / remains;
            let reduction = enough.clamp(CORRECTED, LARGEST);
            flow.iterations += correct(&mut hierarchy, (&mut residual, reduction), &mut correction);
            change = reduction * correction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            for (pressure, correction) in flow.pressures.iter_mut().zip(&correction) {
                *pressure = sum(*pressure, *correction);
            }
        }
        Err(Error::NoConvergence {
            residual: flow.lost,
            tolerance: LOST,
            iterations: flow.iterations,
        })
    }

    /// What is lost at each node; returns what flows in at the edge.
    fn residuals(&self, network: &Network, flowing: &[usize], residual: &mut [f64]) -> f64 {
        let mut rate = 0.0;
        for (&node, residual) in flowing.iter().zip(residual) {
            let beyond = network.layout.beyond(node);
            let flows = [0, 1, 2, 3].map(|face| self.outflow(network, node, (face, beyond[face])));
            *residual = -flows.iter().sum::<f64>();
            if beyond[0] == Beyond::Inlet {
                rate -= flows[0];
            }
        }
        rate
    }

    /// What flows out of a node through a face.
    pub(super) fn outflow(
        &self,
        network: &Network,
        node: usize,
        (face, beyond): (usize, Beyond),
    ) -> f64 {
        let own = self.pressure(node);
        let drop = match beyond {
            Beyond::Wall => return 0.0,
            Beyond::Inlet => difference(own, [1.0, 0.0, 0.0]),
            Beyond::Outlet => difference(own, [0.0; 3]),
            Beyond::Node(other) if network.places[other] != Place::Flowing => return 0.0,
            Beyond::Node(other) => difference(own, self.pressure(other)),
        };
        network.conductance(node, face, beyond) * drop
    }

    /// The pressure of a flowing node, as a sum.
    pub(super) fn pressure(&self, node: usize) -> [f64; 3] {
        self.pressures.get(self.numbers[node] as usize).copied().unwrap_or_default()
    }
}

/// The flowing nodes as a graph; the ground are both edges.
fn graph(network: &Network, flowing: &[usize], numbers: &[u32]) -> Graph {
    let mut graph = Graph::with_capacity(flowing.len());
    for &node in flowing {
        let beyond = network.layout.beyond(node);
        let faces = || (0..4).zip(beyond);
        let to_edges =
            faces().filter(|(_, beyond)| matches!(beyond, Beyond::Inlet | Beyond::Outlet));
        let ground: f64 =
            to_edges.map(|(face, beyond)| network.conductance(node, face, beyond)).sum();
        let to_nodes = faces().filter_map(|(face, beyond)| match beyond {
            Beyond::Node(other) if network.places[other] == Place::Flowing => {
                let weight = network.conductance(node, face, beyond);
                (weight > 0.0).then_some((numbers[other], weight))
            }
            _ => None,
        });
        graph.push(ground, to_nodes);
    }
    graph
}

/// Solves for a correction by flexible conjugate gradients, as well as the residual can be followed; returns the number of iterations.
/// What is left of the residual takes its place.
fn correct(
    hierarchy: &mut Hierarchy,
    (residual, reduction): (&mut [f64], f64),
    x: &mut [f64],
) -> usize {
    let n = residual.len();
    let (mut direction, mut product, mut z) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    x.fill(0.0);
    let first = size(residual);
    for iteration in 0..ITERATIONS {
        if size(residual) <= reduction * first {
            return iteration;
        }
        hierarchy.precondition(residual, &mut z);
        // Conjugate to the direction before: the preconditioner is not the same in each iteration.
        let along = quotient(dot(&z, &product), dot(&direction, &product));
        for (direction, z) in direction.iter_mut().zip(&z) {
            *direction = z - along * *direction;
        }
        hierarchy.matrix().apply(&direction, &mut product);
        let step = quotient(dot(&direction, residual), dot(&direction, &product));
        add(x, step, &direction);
        add(residual, -step, &product);
    }
    ITERATIONS
}

/// A sum of two numbers, and what rounding takes from it: both together are exact (Knuth).
fn exact(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let part = sum - a;
    [sum, (a - (sum - part)) + (b - part)]
}

/// A sum of three numbers and one more, each small beside the one before it.
fn sum([high, middle, low]: [f64; 3], more: f64) -> [f64; 3] {
    let [high, rest] = exact(high, more);
    let [middle, more_rest] = exact(middle, rest);
    let low = low + more_rest;
    let [middle, low] = exact(middle, low);
    let [high, middle] = exact(high, middle);
    let [middle, low] = exact(middle, low);
    [high, middle, low]
}

/// The difference of two sums, to rounding of the difference of their last numbers and of itself.
fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [high, rest] = exact(a[0], -b[0]);
    let [middle, more_rest] = exact(a[1], -b[1]);
    let [high, last_rest] = exact(high, middle);
    high + (rest + last_rest + (more_rest + (a[2] - b[2])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_what_rounding_takes() {
        let total = |all: &[f64]| all.iter().fold([0.0; 3], |total, more| sum(total, *more));
        assert_eq!(total(&[1.0, 1e-20, 1e-38, -1.0])[0], 1e-20);
        let (first, second) = (total(&[1.0, 1e-20, 3e-38]), total(&[1.0, 1e-20, 1e-38]));
        // Of 1e-38 the last number keeps all, and its rounding.
        assert!((difference(first, second) / 2e-38 - 1.0).abs() < 1e-14);
        assert_eq!(difference(first, [1.0, 0.0, 0.0]), 1e-20);
        assert_eq!(difference(second, first), -difference(first, second));
        assert_eq!(difference(first, first), 0.0);
    }
}
