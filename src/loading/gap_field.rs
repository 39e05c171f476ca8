//! All gaps, from a solution on the contact.

use std::time::{Duration, Instant};

use crate::contact::ContactSequence;
use crate::convolution::Convolution;
use crate::updater::{LinearUpdater, Solution};
use crate::{Error, Problem};

/// The solution on a contact and the displacements of all nodes, which together give every gap as a
/// line: `gap = a − t b` at the approach δ + t, as long as no other node joins.
#[derive(Debug)]
pub(super) struct GapField {
    convolution: Convolution,
    pressure: [Vec<f64>; 2],
    displacement: [Vec<f64>; 2],
    solution: Solution,
    /// The contact that solution and displacements belong to.
    revision: Option<u64>,
    time: Duration,
}

/// The gap of a node out of contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) node: usize,
    /// a: the gap now.
    pub(super) gap: f64,
    /// b: how fast it closes with the approach.
    pub(super) closing: f64,
}

impl GapField {
    pub(super) fn new(problem: &Problem) -> Self {
        let field = || vec![0.0; problem.initial_gap().len()];
        Self {
            convolution: problem.convolution(),
            pressure: [field(), field()],
            displacement: [field(), field()],
            solution: Solution::default(),
            revision: None,
            time: Duration::ZERO,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        4 * size_of_val(&self.pressure[0][..]) + self.convolution.bytes()
    }

    /// Time spent on convolutions so far.
    pub(super) fn time(&self) -> Duration {
        self.time
    }

    /// Solves on the contact and computes all displacements, unless that was done last.
    pub(super) fn renew<U: LinearUpdater>(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        updater: &mut U,
    ) -> Result<(), Error> {
        if self.revision == Some(contact.revision()) {
            return Ok(());
        }
        self.revision = None;
        solve(problem, contact, contact.len(), updater, &mut self.solution)?;
        let Solution { y1, y2 } = &self.solution;
        for (field, values) in self.pressure.iter_mut().zip([y1, y2]) {
            field.fill(0.0);
            for (&node, &value) in contact.order().iter().zip(values) {
                field[node] = value;
            }
        }
        let start = Instant::now();
        let ([p1, p2], [u1, u2]) = (&self.pressure, &mut self.displacement);
        self.convolution.apply_two([p1, p2], [u1, u2])?;
        self.time += start.elapsed();
        self.revision = Some(contact.revision());
        Ok(())
    }

    /// The solution on the contact.
    pub(super) fn solution(&self) -> &Solution {
        &self.solution
    }

    /// (node, pressure) of the contact at an approach, in the order of contact.
    pub(super) fn pressures<'a>(
        &'a self,
        contact: &'a ContactSequence,
        approach: f64,
    ) -> impl Iterator<Item = (usize, f64)> + Clone + 'a {
        let Solution { y1, y2 } = &self.solution;
        let values = y1.iter().zip(y2).map(move |(y1, y2)| y1 + approach * y2);
        contact.order().iter().copied().zip(values)
    }

    /// The gaps out of contact from an approach on.
    pub(super) fn lines<'a>(
        &'a self,
        problem: &'a Problem,
        contact: &'a ContactSequence,
        approach: f64,
    ) -> impl Iterator<Item = Line> + 'a {
        let nodes = 0..problem.initial_gap().len();
        let out = nodes.filter(|&node| !contact.contains(node));
        out.map(move |node| self.line(problem, node, approach))
    }

    /// The gap of a node from an approach on.
    pub(super) fn line(&self, problem: &Problem, node: usize, approach: f64) -> Line {
        let [u1, u2] = &self.displacement;
        let closing = 1.0 - u2[node];
        let start = problem.initial_gap()[node] + u1[node];
        Line {
            node,
            gap: start - approach * closing,
            closing,
        }
    }

    /// The displacement that a pressure field causes.
    pub(super) fn displace(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        self.revision = None;
        self.convolution
            .apply(pressure, &mut self.displacement[0])?;
        Ok(&self.displacement[0])
    }
}

/// Solves on the first `count` nodes of a contact, and checks that there is a value for each.
pub(super) fn solve<U: LinearUpdater>(
    problem: &Problem,
    contact: &ContactSequence,
    count: usize,
    updater: &mut U,
    solution: &mut Solution,
) -> Result<(), Error> {
    updater.solve(problem, contact, count, solution)?;
    for (quantity, values) in [("y1", &solution.y1), ("y2", &solution.y2)] {
        if values.len() != count {
            return Err(Error::UpdaterMismatch {
                quantity,
                expected: count,
                found: values.len(),
            });
        }
    }
    Ok(())
}
