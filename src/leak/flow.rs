//! The flow through a network: pressures that let nothing be lost at any node.
//!
//! They are found by elimination, on more nodes by iterations, and again by elimination where the iterations do not
//! end.

use super::elimination::Elimination;
use super::expansion::{Expansion, difference, sum};
use super::graph::Graph;
use super::hierarchy::{Hierarchy, add, dot, quotient, size};
use super::network::{Beyond, Network, Place};
use crate::Error;

/// What may be lost at all nodes together, of what flows from edge to edge.
///
/// Rounding loses some 10⁻¹⁶ of the flow through each face, and the flow passes some N to 5 N faces along the N nodes
/// from edge to edge: 10⁻¹² on 4096 of them.
const LOST: f64 = 1e-11;
/// Greatest change of a pressure that a further correction would bring, over the pressure drop: what hangs on a weak
/// channel alone loses little, wherever its pressure is. A correction reduces errors of all kinds by about as much as
/// the residual: this is what multigrid does.
const SETTLED: f64 = 1e-10;
/// Least residual of a correction, relative to what it is to correct: as far as it can be followed in double precision.
const CORRECTED: f64 = 1e-8;
/// A correction leaves less than may be lost, so that it is the last one.
const LESS: f64 = 0.1;
/// Greatest residual of a correction.
const LARGEST: f64 = 1e-2;
/// Most iterations of a correction, and most corrections: a flow of 10⁻³⁶ of what flows at the open edge takes some 7
/// of them.
const ITERATIONS: usize = 400;
const CORRECTIONS: usize = 20;
/// Corrections that make nothing better before it is given up.
const IDLE: usize = 3;
/// Most nodes that are eliminated at once. It takes half the time of the iterations on them, and some 900 bytes for
/// each; both grow faster than the number of nodes.
const MOST_ELIMINATED: usize = 1 << 20;

/// Pressures, relative to the pressure drop, and what flows, relative to the conductance of a square of the greatest
/// gap.
#[derive(Debug)]
pub(super) struct Flow {
    /// Of each flowing node, by its place among them: a sum of four numbers, so that small differences of large
    /// pressures are not lost.
    pressures: Vec<Expansion>,
    /// The place of each node of the grid among those that flow.
    numbers: Vec<u32>,
    /// What flows from edge to edge.
    pub(super) rate: f64,
    /// What is lost at all nodes together, over the rate.
    pub(super) lost: f64,
    /// Iterations in all, or corrections of what elimination found.
    pub(super) iterations: usize,
}

impl Flow {
    /// The flow of a network through which there is one.
    pub(super) fn through(network: &Network, flowing: &[usize]) -> Result<Self, Error> {
        let mut flow = Self::new(network, flowing);
        let is_large = flowing.len() > MOST_ELIMINATED;
        let is_settled =
            (is_large && flow.iterate(network, flowing)) || flow.eliminate(network, flowing);
        let Self { lost, iterations, .. } = flow;
        let failed = Error::NoConvergence { residual: lost, tolerance: LOST, iterations };
        if is_settled { Ok(flow) } else { Err(failed) }
    }

    fn new(network: &Network, flowing: &[usize]) -> Self {
        let mut numbers = vec![u32::MAX; network.places.len()];
        for (number, &node) in (0..).zip(flowing) {
            numbers[node] = number;
        }
        let pressures = vec![[0.0; 4]; flowing.len()];
        Self { pressures, numbers, rate: 0.0, lost: f64::INFINITY, iterations: 0 }
    }

    /// Finds the pressures by iterations, in memory proportional to the grid; says whether they are found.
    fn iterate(&mut self, network: &Network, flowing: &[usize]) -> bool {
        let mut hierarchy = Hierarchy::new(self.graph(network, flowing, true));
        let mut correction = vec![0.0; flowing.len()];
        self.settle(network, flowing, f64::INFINITY, |pressures, residual, reduction| {
            let iterations = correct(&mut hierarchy, (residual, reduction), &mut correction);
            for (pressure, correction) in pressures.iter_mut().zip(&correction) {
                *pressure = sum(*pressure, *correction);
            }
            let most = correction.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            (iterations, reduction * most)
        })
    }

    /// The same by elimination, to which conductances of any contrast are alike: a correction only takes what rounding
    /// left.
    fn eliminate(&mut self, network: &Network, flowing: &[usize]) -> bool {
        let places: Vec<_> = flowing.iter().map(|&node| network.layout.place(node)).collect();
        let graph = self.graph(network, flowing, false);
        let layout = &network.layout;
        let ring = layout.wraps().then_some(layout.nodes[1] - 1);
        let elimination = Elimination::new(&graph, &places, ring);
        self.pressures = elimination.solve(&vec![0.0; flowing.len()], [1.0, 0.0]);
        self.settle(network, flowing, 0.0, |pressures, residual, _| {
            let correction = elimination.solve(residual, [0.0; 2]);
            for (pressure, correction) in pressures.iter_mut().zip(&correction) {
                *pressure = correction.iter().fold(*pressure, |total, part| sum(total, *part));
            }
            (1, 0.0)
        })
    }

    /// Corrects the pressures until nothing is lost and `change` is small, the greatest one that a further correction
    /// would bring; says whether that is so. A correction adds to the pressures what the residual asks for, to some
    /// reduction of it, and returns its iterations and the next change.
    fn settle(
        &mut self,
        network: &Network,
        flowing: &[usize],
        mut change: f64,
        mut correct: impl FnMut(&mut [Expansion], &mut [f64], f64) -> (usize, f64),
    ) -> bool {
        let mut residual = vec![0.0; flowing.len()];
        let (mut idle, mut least) = (0, f64::INFINITY);
        for _ in 0..CORRECTIONS {
            self.rate = self.residuals(network, flowing, &mut residual);
            let remains = size(&residual);
            self.lost = remains / self.rate.abs();
            if self.lost <= LOST && self.rate > 0.0 && change <= SETTLED {
                return true;
            }
            idle = if remains < 0.5 * least { 0 } else { idle + 1 };
            least = remains.min(least);
            if idle == IDLE || !remains.is_finite() {
                break;
            }
            let enough = LESS * LOST * self.rate.abs() / remains;
            let reduction = enough.clamp(CORRECTED, LARGEST);
            let (iterations, next_change) = correct(&mut self.pressures, &mut residual, reduction);
            self.iterations += iterations;
            change = next_change;
        }
        false
    }

    /// What is lost at each node; returns what flows in at the edge.
    fn residuals(&self, network: &Network, flowing: &[usize], residual: &mut [f64]) -> f64 {
        let mut rate = 0.0;
        for (&node, residual) in flowing.iter().zip(residual) {
            let beyond = network.layout.beyond(node);
            let flows =
                [0, 1, 2, 3].map(|face| self.face_flux(network, node, (face, beyond[face])));
            *residual = -flows.iter().sum::<f64>();
            if beyond[0] == Beyond::Inlet {
                rate -= flows[0];
            }
        }
        rate
    }

    /// What flows out of a node through a face.
    pub(super) fn face_flux(
        &self,
        network: &Network,
        node: usize,
        (face, beyond): (usize, Beyond),
    ) -> f64 {
        let own = self.pressure(node);
        let drop = match beyond {
            Beyond::Wall => return 0.0,
            Beyond::Inlet => difference(own, [1.0, 0.0, 0.0, 0.0]),
            Beyond::Outlet => difference(own, [0.0; 4]),
            Beyond::Node(other) if network.places[other] != Place::Flowing => return 0.0,
            Beyond::Node(other) => difference(own, self.pressure(other)),
        };
        network.conductance(node, face, beyond) * drop
    }

    /// The pressure of a flowing node, as a sum.
    pub(super) fn pressure(&self, node: usize) -> Expansion {
        self.pressures.get(self.numbers[node] as usize).copied().unwrap_or_default()
    }

    /// The flowing nodes as a graph. Both edges are its ground, or two further nodes.
    fn graph(&self, network: &Network, flowing: &[usize], is_grounded: bool) -> Graph {
        let mut graph = Graph::with_capacity(flowing.len());
        let inlet = flowing.len() as u32;
        for &node in flowing {
            let mut ground = 0.0;
            let faces = (0..4).zip(network.layout.beyond(node));
            let edges = faces.filter_map(|(face, beyond)| {
                let weight = network.conductance(node, face, beyond);
                let other = match beyond {
                    Beyond::Inlet | Beyond::Outlet if is_grounded => {
                        ground += weight;
                        return None;
                    }
                    Beyond::Inlet => inlet,
                    Beyond::Outlet => inlet + 1,
                    Beyond::Node(other) => self.numbers[other],
                    Beyond::Wall => return None,
                };
                (weight > 0.0 && other != u32::MAX).then_some((other, weight))
            });
            let edges: Vec<_> = edges.collect();
            graph.push(ground, edges.into_iter());
        }
        graph
    }
}

/// Solves for a correction by flexible conjugate gradients, as well as the residual can be followed; returns the number
/// of iterations. What is left of the residual takes its place.
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

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::surface::Axis;
    use crate::{Boundary, Grid};

    /// The flow through gaps of some decades in no order, a quarter of them closed, by elimination and by iterations
    /// where these end.
    fn both(decades: f64, boundary: Boundary) -> Result<(Flow, Option<Flow>), Error> {
        let (nx, ny) = (40, 30);
        let mut state = 1_u64;
        let mut random = || {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let gap = DMatrix::from_fn(nx, ny, |_, _| 10_f64.powf(-decades * random()));
        let closed = gap.map(|_| random() < 0.25);
        let network =
            Network::new(&gap, &closed, 0.0, (&Grid::new(nx, ny, 3.0, 1.0)?, boundary), Axis::X)?;
        let flowing = network.flowing();
        let eliminated = Flow::through(&network, &flowing)?;
        let mut iterated = Flow::new(&network, &flowing);
        let is_one = iterated.iterate(&network, &flowing);
        Ok((eliminated, is_one.then_some(iterated)))
    }

    /// Each rate is off by no more than is lost, and pressures by what a further correction would change.
    #[test]
    fn iterations_and_elimination_agree() -> Result<(), Error> {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            for decades in [1.0, 3.0] {
                let (eliminated, iterated) = both(decades, boundary)?;
                assert!(iterated.is_some() && eliminated.iterations == 0);
                if let Some(iterated) = iterated {
                    let error = iterated.rate / eliminated.rate - 1.0;
                    assert!(error.abs() <= iterated.lost + eliminated.lost);
                    for (a, b) in iterated.pressures.iter().zip(&eliminated.pressures) {
                        assert!(difference(*a, *b).abs() <= 10.0 * SETTLED);
                    }
                }
            }
        }
        Ok(())
    }

    /// Where iterations do not end, elimination is as good as ever: flows through some hundred nodes, each lost to
    /// rounding.
    #[test]
    fn elimination_is_right_where_iterations_do_not_end() -> Result<(), Error> {
        let (eliminated, iterated) = both(12.0, Boundary::Periodic)?;
        assert!(iterated.is_none());
        assert!(eliminated.lost < 1e-13, "{:e}", eliminated.lost);
        Ok(())
    }
}
