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
/// Greatest change of a pressure by the last correction, over the pressure drop: what hangs on a weak channel alone loses little, wherever its
/// pressure is.
const SETTLED: f64 = 1e-9;
/// Residual of a correction, relative to what it is to correct.
const CORRECTED: f64 = 1e-8;
/// Most iterations of a correction, and most corrections: a flow of 10⁻¹⁸⁰ of what flows at the open edge takes some 25 of them.
const ITERATIONS: usize = 400;
const CORRECTIONS: usize = 60;
/// Corrections that make nothing better before it is given up.
const IDLE: usize = 3;

/// Pressures, relative to the pressure drop, and what flows, relative to the conductance of a square of the greatest gap.
#[derive(Debug)]
pub(super) struct Flow {
    /// Of each flowing node, by its place among them: a sum of two numbers, so that small differences of large pressures are not lost.
    pressures: Vec<[f64; 2]>,
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
            pressures: vec![[0.0; 2]; flowing.len()],
            numbers,
            rate: 0.0,
            lost: f64::INFINITY,
            iterations: 0,
        };
        let mut residual = vec![0.0; flowing.len()];
        let mut correction = vec![0.0; flowing.len()];
        let (mut idle, mut change) = (0, f64::INFINITY);
        for _ in 0..CORRECTIONS {
            let rate = flow.residuals(network, flowing, &mut residual);
            let lost = size(&residual) / rate.abs();
            if lost < flow.lost {
                idle = 0;
                flow.lost = lost;
                flow.rate = rate;
            } else {
                idle += 1;
            }
            if lost <= LOST && rate > 0.0 && change <= SETTLED {
                flow.lost = lost;
                flow.rate = rate;
                return Ok(flow);
            }
            if idle == IDLE || !size(&residual).is_finite() {
                break;
            }
            flow.iterations += correct(&mut hierarchy, &mut residual, &mut correction);
            change = correction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
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
            let flows =
                [0, 1, 2, 3].map(|face| self.into_face(network, node, (face, beyond[face])));
            *residual = -flows.iter().sum::<f64>();
            if beyond[0] == Beyond::Inlet {
                rate -= flows[0];
            }
        }
        rate
    }

    /// What flows out of a node through a face.
    pub(super) fn into_face(
        &self,
        network: &Network,
        node: usize,
        (face, beyond): (usize, Beyond),
    ) -> f64 {
        let [high, low] = self.pressure(node);
        let drop = match beyond {
            Beyond::Wall => return 0.0,
            Beyond::Inlet => (high - 1.0) + low,
            Beyond::Outlet => high + low,
            Beyond::Node(other) if network.places[other] != Place::Flowing => return 0.0,
            Beyond::Node(other) => {
                let [other_high, other_low] = self.pressure(other);
                (high - other_high) + (low - other_low)
            }
        };
        network.conductance(node, face, beyond) * drop
    }

    /// The pressure of a flowing node, as a sum.
    pub(super) fn pressure(&self, node: usize) -> [f64; 2] {
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
fn correct(hierarchy: &mut Hierarchy, residual: &mut [f64], x: &mut [f64]) -> usize {
    let n = residual.len();
    let (mut direction, mut product, mut z) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    x.fill(0.0);
    let first = size(residual);
    for iteration in 0..ITERATIONS {
        if size(residual) <= CORRECTED * first {
            return iteration;
        }
        hierarchy.precondition(residual, &mut z);
        // Conjugate to the direction before: the preconditioner is not the same in each iteration.
        let along = quotient(dot(&z, &product), dot(&direction, &product));
        for (direction, z) in direction.iter_mut().zip(&z) {
            *direction = z - along * *direction;
        }
        hierarchy.graph().apply(&direction, &mut product);
        let step = quotient(dot(&direction, residual), dot(&direction, &product));
        add(x, step, &direction);
        add(residual, -step, &product);
    }
    ITERATIONS
}

/// A sum of two numbers and one more, the first of which is the sum rounded.
fn sum([high, low]: [f64; 2], more: f64) -> [f64; 2] {
    // Knuth's: what rounding takes from a sum is a number again.
    let exact = |a: f64, b: f64| {
        let sum = a + b;
        let part = sum - a;
        [sum, (a - (sum - part)) + (b - part)]
    };
    let [total, rest] = exact(high, more);
    exact(total, low + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_keep_what_rounding_takes() {
        let mut total = [1.0, 0.0];
        for more in [1e-20, 1e-30, -1.0] {
            total = sum(total, more);
        }
        assert_eq!(total[0] + total[1], 1e-20 + 1e-30);
    }
}
