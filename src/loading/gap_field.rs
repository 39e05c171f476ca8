//! All gaps, from a solution on the contact.

use std::time::Duration;

use crate::clock::Stopwatch;
use crate::contact::ContactSequence;
use crate::convolution::Convolution;
use crate::updater::{Behind, Iterations, LinearUpdater, Solution, Solved};
use crate::{Boundary, Error, Grid, Problem, UpdaterError};

/// The solution on a contact at an approach δ and the displacements of all nodes, which together give
/// every gap as a line: `gap = a − t b` at the approach δ + t, as long as no other node joins.
#[derive(Debug)]
pub(super) struct GapField {
    convolution: Convolution,
    scratch: [Vec<f64>; 2],
    solved: Solved,
    /// The contact that solution and displacements belong to.
    revision: Option<u64>,
    /// The approach that they belong to.
    approach: f64,
    time: Duration,
}

/// The gap of a node out of contact as the approach grows and no other node joins: `gap − t closing`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct GapLine {
    /// The gap now.
    pub(super) gap: f64,
    /// How fast it closes with the approach.
    pub(super) closing: f64,
}

impl GapLine {
    /// When the node would touch.
    pub(super) fn touches(&self) -> f64 {
        if self.closing > 0.0 { self.gap / self.closing } else { f64::INFINITY }
    }
}

impl GapField {
    pub(super) fn new(problem: &Problem) -> Self {
        let field = || vec![0.0; problem.initial_gap().len()];
        Self {
            convolution: problem.convolution(),
            scratch: [field(), field()],
            solved: Solved { displacement: [field(), field()], ..Solved::default() },
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

    /// Says that nothing is known: whoever needs the field solves anew.
    pub(super) fn forget(&mut self) {
        self.revision = None;
    }

    /// Solves on the contact at an approach, and computes all displacements.
    pub(super) fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        updater: &mut dyn LinearUpdater,
        approach: f64,
    ) -> Result<(), Error> {
        self.revision = None;
        solve(problem, contact, updater, (contact.len(), approach), &mut self.solved.solution)?;
        self.displace_solution(contact, approach)
    }

    /// Goes to a contact at an approach with a solution that is known, and computes all displacements.
    pub(super) fn place(
        &mut self,
        contact: &ContactSequence,
        solution: Solution,
        approach: f64,
    ) -> Result<(), Error> {
        self.revision = None;
        check_solution(&solution, contact.len())?;
        self.solved.solution = solution;
        self.displace_solution(contact, approach)
    }

    /// Computes the displacements under the solution on a contact at an approach.
    fn displace_solution(&mut self, contact: &ContactSequence, approach: f64) -> Result<(), Error> {
        let Solved { solution, displacement: [u, u_rate] } = &mut self.solved;
        let values = [&solution.pressure, &solution.rate];
        for (field, values) in self.scratch.iter_mut().zip(values) {
            field.fill(0.0);
            for (&node, &value) in contact.order().iter().zip(values) {
                field[node] = value;
            }
        }
        let start = Stopwatch::start();
        let [p, p_rate] = &self.scratch;
        self.convolution.apply_two([p, p_rate], [u, u_rate])?;
        self.time += start.elapsed();
        self.belong_to(contact, approach);
        Ok(())
    }

    /// Moves iterations to a state, with a rate that serves over a span of the approach.
    pub(super) fn advance(
        &mut self,
        behind: &Behind<'_>,
        iterations: &mut dyn Iterations,
        span: f64,
    ) -> Result<(), Error> {
        self.revision = None;
        iterations.advance(behind, span, &mut self.solved)?;
        check_solution(&self.solved.solution, behind.contact.len())?;
        for field in &self.solved.displacement {
            let nodes = behind.problem.grid().nodes();
            UpdaterError::check_length("displacements", field.len(), nodes)?;
        }
        self.belong_to(behind.contact, behind.approach);
        Ok(())
    }

    /// Follows a contact into another order of its nodes.
    pub(super) fn reorder(&mut self, before: &ContactSequence, contact: &ContactSequence) {
        let Solution { pressure, rate } = &mut self.solved.solution;
        let mut field = vec![0.0; self.scratch[0].len()];
        for values in [pressure, rate] {
            for (&node, value) in before.order().iter().zip(&*values) {
                field[node] = *value;
            }
            for (value, &node) in values.iter_mut().zip(contact.order()) {
                *value = field[node];
            }
        }
        self.revision = Some(contact.revision());
    }

    fn belong_to(&mut self, contact: &ContactSequence, approach: f64) {
        self.revision = Some(contact.revision());
        self.approach = approach;
    }

    /// The solution on the contact.
    pub(super) fn solution(&self) -> &Solution {
        &self.solved.solution
    }

    /// Residuals of a solution at a node in contact: the gap that it leaves, and the rate of that.
    pub(super) fn left_at(&self, problem: &Problem, node: usize) -> [f64; 2] {
        let [u, rate] = &self.solved.displacement;
        let gap = problem.initial_gap()[node] + u[node] - self.approach;
        [gap, rate[node] - 1.0]
    }

    /// (node, pressure) of the contact at an approach, in the order of contact.
    pub(super) fn pressures<'a>(
        &'a self,
        contact: &'a ContactSequence,
        approach: f64,
    ) -> impl Iterator<Item = (usize, f64)> + Clone + 'a {
        let Solution { pressure, rate } = &self.solved.solution;
        let time = approach - self.approach;
        let values = pressure.iter().zip(rate);
        let values = values.map(move |(p, y2)| p + time * y2);
        contact.order().iter().copied().zip(values)
    }

    /// The nodes out of contact, and their gaps from an approach on.
    pub(super) fn lines<'a>(
        &'a self,
        problem: &'a Problem,
        contact: &'a ContactSequence,
        approach: f64,
    ) -> impl Iterator<Item = (usize, GapLine)> + 'a {
        let nodes = 0..problem.initial_gap().len();
        let out = nodes.filter(|&node| !contact.contains(node));
        out.map(move |node| (node, self.line(problem, node, approach)))
    }

    /// The gap of a node from an approach on.
    pub(super) fn line(&self, problem: &Problem, node: usize, approach: f64) -> GapLine {
        let [u, rate] = &self.solved.displacement;
        let closing = 1.0 - rate[node];
        let gap = problem.initial_gap()[node] + u[node] - self.approach;
        GapLine { gap: gap - (approach - self.approach) * closing, closing }
    }

    /// A lower bound of the eigenvalues of the influence matrix: see [`Convolution::least_eigenvalue`].
    pub(super) fn least_eigenvalue(&self) -> f64 {
        self.convolution.least_eigenvalue()
    }

    /// The displacement that a pressure field causes. What is known of the contact stays.
    pub(super) fn displace(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        let [displacement, _] = &mut self.scratch;
        self.convolution.apply(pressure, displacement)?;
        Ok(displacement)
    }
}

/// Solves on the first `count` nodes of a contact at an approach, and checks that there is a value for each.
pub(super) fn solve(
    problem: &Problem,
    contact: &ContactSequence,
    updater: &mut dyn LinearUpdater,
    (count, approach): (usize, f64),
    solution: &mut Solution,
) -> Result<(), Error> {
    updater.solve(problem, contact, count, approach, solution)?;
    check_solution(solution, count)
}

/// `Ok` if a solution has a value for each of `count` nodes in contact.
pub(super) fn check_solution(solution: &Solution, count: usize) -> Result<(), Error> {
    UpdaterError::check_length("pressures", solution.pressure.len(), count)?;
    UpdaterError::check_length("pressures per unit of approach", solution.rate.len(), count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::loading::test_chain;

    fn near(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            // Rounding errors of a transform of numbers up to 8.
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }

    /// Nodes 0 and 2 carry 3/4 and 1/2 at the approach 3, and 1/4 more for each metre: node 1 sinks by 5/4 and 1/2,
    /// node 3 by 1/2 and 1/4.
    #[test]
    fn gaps_are_lines() -> Result<(), Error> {
        let run = test_chain::solved(&[0.0, 4.0, 1.0, 8.0], &[0, 2], 3.0)?;
        let (problem, contact, field) = (&run.problem, &run.contact, &run.field);
        for (ahead, gaps) in [(0.0, [2.25, 5.5]), (2.0, [1.25, 4.0])] {
            let (nodes, lines): (Vec<_>, Vec<_>) =
                field.lines(problem, contact, 3.0 + ahead).unzip();
            assert_eq!(nodes, [1, 3]);
            near(&[lines[0].gap, lines[1].gap], &gaps);
            near(&[lines[0].closing, lines[1].closing], &[0.5, 0.75]);
            let [one, three] = gaps;
            near(&[lines[0].touches(), lines[1].touches()], &[one / 0.5, three / 0.75]);
            let pressures: Vec<(usize, f64)> = field.pressures(contact, 3.0 + ahead).collect();
            assert_eq!([pressures[0].0, pressures[1].0], [0, 2]);
            let more = 0.25 * ahead;
            near(&[pressures[0].1, pressures[1].1], &[0.75 + more, 0.5 + more]);
        }
        near(&field.left_at(problem, 2), &[0.0, 0.0]);
        near(&field.left_at(problem, 3), &[5.5, -0.75]);
        Ok(())
    }

    #[test]
    fn gaps_that_do_not_close_never_touch() {
        let touches = |gap, closing| GapLine { gap, closing }.touches();
        assert_eq!([touches(1.0, 0.0), touches(-1.0, -1.0)], [f64::INFINITY; 2]);
        assert_eq!([touches(-1.0, 0.5), touches(3.0, 2.0)], [-2.0, 1.5]);
    }

    /// Solution and displacements belong to one contact at one approach; after a change of places to the new order.
    /// Those of another pressure change neither.
    #[test]
    fn what_is_known_belongs_to_a_contact() -> Result<(), Error> {
        let mut run = test_chain::solved(&[0.0, 4.0, 1.0, 8.0, 2.0], &[0, 2, 4], 3.0)?;
        assert!(run.field.belongs_to(&run.contact, 3.0));
        assert!(!run.field.belongs_to(&run.contact, 3.5));
        // A convolution takes some time.
        assert!(run.field.time() > Duration::ZERO);
        // 3/4, 1/2, 1/4, of which the last two change places.
        let ordered = ContactSequence::with_order(run.problem.grid(), [0, 4, 2])?;
        run.field.reorder(&run.contact, &ordered);
        run.contact = ordered;
        assert!(run.field.belongs_to(&run.contact, 3.0));
        near(&run.field.solution().pressure, &[0.75, 0.25, 0.5]);
        let mut pressure = vec![0.0; 5];
        pressure[3] = 2.0;
        let known = run.field.solved.displacement.clone();
        near(run.field.displace(&pressure)?, &[0.0, 0.0, 2.0, 8.0, 2.0]);
        assert!(run.field.belongs_to(&run.contact, 3.0));
        assert_eq!(run.field.solved.displacement, known);
        run.contact.truncate(2);
        assert!(!run.field.belongs_to(&run.contact, 3.0));
        Ok(())
    }

    /// Two fields of pressure and two of displacement of 15 nodes, and a convolution.
    #[test]
    fn bytes_are_those_of_four_fields() -> Result<(), Error> {
        let grid = Grid::new(5, 3, 1.0, 1.0)?;
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let found = GapField::bytes_on(&grid, boundary);
            assert_eq!(found - Convolution::bytes_on(&grid, boundary), 480);
        }
        Ok(())
    }

    /// A value for each node in contact, here two.
    #[test]
    fn there_is_a_value_for_each_node() -> Result<(), Error> {
        let problem = crate::test_chain::problem(&[0.0; 4])?;
        let contact = ContactSequence::with_order(problem.grid(), [0, 2])?;
        for (lengths, refused) in [
            ([2, 2], None),
            ([2, 0], Some(("pressures per unit of approach", 0))),
            ([2, 3], Some(("pressures per unit of approach", 3))),
            ([1, 2], Some(("pressures", 1))),
            ([3, 2], Some(("pressures", 3))),
        ] {
            let [pressure, rate] = lengths.map(|length| vec![0.5; length]);
            let mut updater = test_chain::Altered::solutions(move |solution| {
                solution.pressure.clone_from(&pressure);
                solution.rate.clone_from(&rate);
            });
            let mut solution = Solution::default();
            let solved = solve(&problem, &contact, &mut updater, (2, 1.0), &mut solution);
            match (solved, refused) {
                (Ok(()), None) => {}
                (
                    Err(Error::Updater(UpdaterError::UpdaterMismatch {
                        quantity,
                        expected: 2,
                        found,
                    })),
                    Some(refused),
                ) => assert_eq!((quantity, found), refused),
                (found, _) => unreachable!("{lengths:?}: {found:?}"),
            }
        }
        Ok(())
    }
}
