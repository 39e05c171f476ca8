//! All gaps, from a solution on the contact.

use std::time::{Duration, Instant};

use crate::contact::ContactSequence;
use crate::convolution::Convolution;
use crate::updater::{LinearUpdater, Solution, SolveRequest};
use crate::{Boundary, Error, Grid, Problem, UpdaterError};

/// The solution on a contact at an approach δ and the displacements of all nodes, which together give
/// every gap as a line: `gap = a − t b` at the approach δ + t, as long as no other node joins.
#[derive(Debug)]
pub(super) struct GapField {
    convolution: Convolution,
    pressure: [Vec<f64>; 2],
    displacement: [Vec<f64>; 2],
    solution: Solution,
    /// The contact that solution and displacements belong to.
    revision: Option<u64>,
    /// The approach that they belong to.
    approach: f64,
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

impl Line {
    /// When the node would touch if no other did.
    pub(super) fn touches(&self) -> f64 {
        if self.closing > 0.0 {
            self.gap / self.closing
        } else {
            f64::INFINITY
        }
    }
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
            approach: 0.0,
            time: Duration::ZERO,
        }
    }

    /// Bytes that all gaps of a grid take.
    pub(super) fn bytes_on(grid: &Grid, boundary: Boundary) -> usize {
        4 * grid.nodes() * size_of::<f64>() + Convolution::bytes_on(grid, boundary)
    }

    /// Time spent on convolutions so far.
    pub(super) fn time(&self) -> Duration {
        self.time
    }

    /// Whether everything is that of a contact at an approach.
    pub(super) fn belongs_to(&self, contact: &ContactSequence, approach: f64) -> bool {
        self.revision == Some(contact.revision()) && self.approach == approach
    }

    /// Solves on the contact at an approach, for rates that serve over a span of it, and computes all displacements.
    pub(super) fn solve<U: LinearUpdater>(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        updater: &mut U,
        [approach, span]: [f64; 2],
    ) -> Result<(), Error> {
        self.revision = None;
        let request = SolveRequest {
            count: contact.len(),
            approach,
            span,
            gap_error: 0.0,
        };
        solve(problem, contact, request, updater, &mut self.solution)?;
        let [u, rate] = &mut self.solution.displacement;
        if u.is_empty() {
            let Solution { pressure, rate, .. } = &self.solution;
            for (field, values) in self.pressure.iter_mut().zip([pressure, rate]) {
                field.fill(0.0);
                for (&node, &value) in contact.order().iter().zip(values) {
                    field[node] = value;
                }
            }
            let start = Instant::now();
            let ([p1, p2], [u1, u2]) = (&self.pressure, &mut self.displacement);
            self.convolution.apply_two([p1, p2], [u1, u2])?;
            self.time += start.elapsed();
        } else {
            let [own, own_rate] = &mut self.displacement;
            std::mem::swap(own, u);
            std::mem::swap(own_rate, rate);
        }
        self.revision = Some(contact.revision());
        self.approach = approach;
        Ok(())
    }

    /// The solution on the contact.
    pub(super) fn solution(&self) -> &Solution {
        &self.solution
    }

    /// What a solution leaves of the contact conditions at a node in contact: its gap, and the rate of that.
    pub(super) fn left_at(&self, problem: &Problem, node: usize) -> [f64; 2] {
        let [u, rate] = &self.displacement;
        let gap = problem.initial_gap()[node] + u[node] - self.approach;
        [gap, rate[node] - 1.0]
    }

    /// (node, pressure) of the contact at an approach, in the order of contact.
    pub(super) fn pressures<'a>(
        &'a self,
        contact: &'a ContactSequence,
        approach: f64,
    ) -> impl Iterator<Item = (usize, f64)> + Clone + 'a {
        let Solution { pressure, rate, .. } = &self.solution;
        let time = approach - self.approach;
        let values = pressure.iter().zip(rate);
        let values = values.map(move |(p, y2)| p + time * y2);
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
        let [u, rate] = &self.displacement;
        let closing = 1.0 - rate[node];
        let gap = problem.initial_gap()[node] + u[node] - self.approach;
        Line {
            node,
            gap: gap - (approach - self.approach) * closing,
            closing,
        }
    }

    /// Follows a contact whose last nodes, from the one at `first` on, have changed places; `order[k]` is where
    /// the node at `first + k` was before, from `first` on.
    pub(super) fn rearrange(&mut self, contact: &ContactSequence, first: usize, order: &[usize]) {
        for values in [&mut self.solution.pressure, &mut self.solution.rate] {
            let before = values[first..].to_vec();
            for (value, &place) in values[first..].iter_mut().zip(order) {
                *value = before[place];
            }
        }
        self.revision = Some(contact.revision());
    }

    /// The displacement that a pressure field causes.
    pub(super) fn displace(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        self.revision = None;
        self.convolution
            .apply(pressure, &mut self.displacement[0])?;
        Ok(&self.displacement[0])
    }
}

/// Solves on the first nodes of a contact, and checks that there is a value for each.
pub(super) fn solve<U: LinearUpdater>(
    problem: &Problem,
    contact: &ContactSequence,
    request: SolveRequest,
    updater: &mut U,
    solution: &mut Solution,
) -> Result<(), Error> {
    for field in &mut solution.displacement {
        field.clear();
    }
    updater.solve(problem, contact, request, solution)?;
    let Solution {
        pressure,
        rate,
        displacement: [u, u_rate],
    } = solution;
    let everywhere = |u: &Vec<f64>| {
        if u.is_empty() {
            0
        } else {
            problem.initial_gap().len()
        }
    };
    let checked = [
        ("pressures", &*pressure, request.count),
        ("displacements", u, everywhere(u)),
        ("pressures per unit of approach", rate, request.count),
        ("displacements per unit of approach", u_rate, everywhere(u)),
    ];
    // A rate that was not asked for may be anything.
    let asked = if request.span > 0.0 { 4 } else { 2 };
    for (quantity, values, expected) in checked.into_iter().take(asked) {
        if values.len() != expected {
            return Err(Error::Updater(UpdaterError::UpdaterMismatch {
                quantity,
                expected,
                found: values.len(),
            }));
        }
    }
    Ok(())
}
