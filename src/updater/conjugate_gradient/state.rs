//! The contact, its solutions and the columns of the watched nodes.

use crate::contact::ContactSequence;
use crate::krylov::{LinearSystem, NodeSet, Operator, Preconditioner, dot};
use crate::updater::{Schur, Solution, Touched};
use crate::{Error, Problem};

/// Which of the right-hand sides the row sums are.
const ROW_SUMS: usize = 2;

/// What depends on the problem and its contact, made at first use.
#[derive(Debug, Clone)]
pub(super) struct State {
    operator: Operator,
    preconditioner: Preconditioner,
    contact: NodeSet,
    /// `C_II⁻¹ B_I` by place in the contact.
    solutions: [Vec<f64>; Problem::RHS],
    /// Columns of the watched nodes, in the order of the window.
    columns: Vec<Column>,
}

/// `x = C_II⁻¹ C_Ij` of a watched node j, and the residual of this equation.
#[derive(Debug, Clone, Default)]
struct Column {
    node: usize,
    values: Vec<f64>,
    residual: Vec<f64>,
}

/// When iterations end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Criteria {
    /// Greatest residual relative to the greatest right-hand side.
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
}

impl State {
    pub(super) fn new(problem: &Problem) -> Self {
        Self {
            operator: Operator::new(problem.convolution()),
            preconditioner: Preconditioner::new(problem.table()),
            contact: NodeSet::new(problem.grid().nodes()),
            solutions: Default::default(),
            columns: Vec::new(),
        }
    }

    /// With a contact and the solution on it; the row sums begin from nothing.
    pub(super) fn from_solution(
        problem: &Problem,
        contact: &ContactSequence,
        solution: &Solution,
    ) -> Self {
        let mut state = Self::new(problem);
        state.choose(|node| contact.contains(node));
        let places = state.contact.places();
        let known = [(&solution.y1, -1.0), (&solution.y2, 1.0)];
        for (start, (values, sign)) in state.solutions.iter_mut().zip(known) {
            start.resize(contact.len(), 0.0);
            for (&node, value) in contact.order().iter().zip(values) {
                start[places[node] as usize] = sign * value;
            }
        }
        state
    }

    /// Number of nodes in contact.
    pub(super) fn len(&self) -> usize {
        self.contact.len()
    }

    /// Number of watched nodes.
    pub(super) fn watched(&self) -> usize {
        self.columns.len()
    }

    /// Bytes held, besides values for each contact node.
    pub(super) fn bytes(&self) -> usize {
        self.operator.bytes() + 2 * self.preconditioner.bytes()
    }

    /// Makes the contact the nodes for which `is_in` holds.
    fn choose(&mut self, is_in: impl Fn(usize) -> bool) {
        self.contact.assign(is_in);
        self.preconditioner.update(&self.contact);
    }

    /// Solves `C_II x = B_I` for one right-hand side, from the start `x`, and returns the residual.
    /// The operator then holds the displacements of x.
    fn solve_rhs(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        rhs: usize,
        x: &mut Vec<f64>,
    ) -> Result<Vec<f64>, Error> {
        let nodes = self.contact.nodes().iter();
        let b: Vec<f64> = nodes.map(|&n| problem.rhs(n as usize)[rhs]).collect();
        x.resize(b.len(), 0.0);
        self.iterate(criteria, &b, x)
    }

    /// Solves `C_II x = b` from the start `x`, and returns the residual. The operator then holds the
    /// displacements of x.
    fn iterate(&mut self, criteria: Criteria, b: &[f64], x: &mut [f64]) -> Result<Vec<f64>, Error> {
        let greatest = b.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut equations = LinearSystem {
            operator: &mut self.operator,
            preconditioner: &mut self.preconditioner,
            contact: &self.contact,
            tolerance: criteria.tolerance * greatest,
            max_iterations: criteria.max_iterations,
        };
        let mut residual = Vec::new();
        equations.residual(b, x, &mut residual)?;
        let outcome = equations.solve(b, x, &mut residual)?;
        if outcome.converged {
            return Ok(residual);
        }
        Err(Error::NoConvergence {
            residual: outcome.residual / greatest,
            tolerance: criteria.tolerance,
            iterations: outcome.iterations,
        })
    }

    pub(super) fn watch(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let mut earlier = std::mem::take(&mut self.columns);
        schur.resize(nodes.len());
        let table = problem.table();
        let contact = self.contact.len();
        // Columns to the root of the tolerance: see the type.
        let columns = Criteria {
            tolerance: 0.1 * criteria.tolerance.sqrt(),
            ..criteria
        };
        // `S = C_PP − Bᵀ C_II⁻¹ B` with B the coefficients between contact and watched.
        let mut b = Vec::new();
        for (j, &node) in nodes.iter().enumerate() {
            let mut column = match earlier.iter().position(|column| column.node == node) {
                Some(found) => earlier.swap_remove(found),
                None => Column {
                    node,
                    values: vec![0.0; contact],
                    residual: Vec::new(),
                },
            };
            let place = table.place(node);
            let others = self.contact.nodes().iter();
            b.clear();
            b.extend(others.map(|&other| table.between(place, table.place(other as usize))));
            column.residual = self.iterate(columns, &b, &mut column.values)?;
            let inside = self.operator.displacement();
            let matrix = schur.as_mut_slice();
            for (i, &other) in nodes.iter().enumerate().skip(j) {
                matrix[i + nodes.len() * j] =
                    table.between(table.place(other), place) - inside[other];
            }
            self.columns.push(column);
        }
        let matrix = schur.as_mut_slice();
        for j in 0..nodes.len() {
            for i in j..nodes.len() {
                let corrected = dot(&self.columns[i].values, &self.columns[j].residual);
                matrix[i + nodes.len() * j] -= corrected;
            }
        }
        let mut x = std::mem::take(&mut self.solutions[ROW_SUMS]);
        let residual = self.solve_rhs(criteria, problem, ROW_SUMS, &mut x)?;
        let inside = self.operator.displacement();
        let reduced = schur.row_sums_mut().iter_mut();
        for ((reduced, column), &node) in reduced.zip(&self.columns).zip(nodes) {
            let corrected = dot(&column.values, &residual);
            *reduced = problem.row_sums()[node] - inside[node] - corrected;
        }
        self.solutions[ROW_SUMS] = x;
        Ok(())
    }

    /// Carries columns and solutions over to the contact set with `touched`.
    pub(super) fn join(&mut self, problem: &Problem, grown: &ContactSequence, touched: &Touched) {
        let joined = &grown.order()[grown.len() - touched.len()..];
        let mut contact = self.contact.clone();
        contact.assign(|node| grown.contains(node));
        // The right-hand sides of the new nodes, with the old contact and then each other eliminated.
        let inside: Vec<_> = self
            .contact
            .nodes()
            .iter()
            .map(|&node| problem.rhs(node as usize))
            .collect();
        let mut entries: Vec<[f64; Problem::RHS]> = Vec::with_capacity(touched.len());
        for (&position, &node) in touched.positions().iter().zip(joined) {
            let mut rhs = problem.rhs(node);
            for (x, inside) in self.columns[position].values.iter().zip(&inside) {
                for (rhs, inside) in rhs.iter_mut().zip(inside) {
                    *rhs -= x * inside;
                }
            }
            entries.push(rhs);
        }
        touched.solve(&mut entries);
        let carry = |values: &[f64], entry: &dyn Fn(usize) -> f64| {
            // `R_TTᵀ w = entries`, then `x_I − X_T w` on the old nodes and w on the new ones.
            let mut w = vec![0.0; touched.len()];
            for t in (0..w.len()).rev() {
                let mut value = entry(t);
                for (later, w) in w.iter().enumerate().skip(t + 1) {
                    value -= touched.factor(touched.positions()[later], t) * w;
                }
                w[t] = value / touched.factor(touched.positions()[t], t);
            }
            let mut old = values.to_vec();
            for (&position, w) in touched.positions().iter().zip(&w) {
                for (value, x) in old.iter_mut().zip(&self.columns[position].values) {
                    *value -= w * x;
                }
            }
            let mut grown = vec![0.0; contact.len()];
            let moved = self.contact.nodes().iter().map(|&node| node as usize);
            let values = moved.zip(&old);
            for (node, &value) in values.chain(joined.iter().copied().zip(&w)) {
                grown[contact.places()[node] as usize] = value;
            }
            grown
        };
        let solutions =
            std::array::from_fn(|rhs| carry(&self.solutions[rhs], &|t| entries[t][rhs]));
        let columns = (0..self.columns.len())
            .filter(|&position| !touched.has_touched(position))
            .map(|position| Column {
                node: self.columns[position].node,
                values: carry(&self.columns[position].values, &|t| {
                    touched.factor(position, t)
                }),
                residual: Vec::new(),
            })
            .collect();
        self.solutions = solutions;
        self.columns = columns;
        self.contact = contact;
        self.preconditioner.update(&self.contact);
    }

    /// Solves on the first nodes of `contact`, which are not all of them.
    pub(super) fn solve_prefix(
        &self,
        criteria: Criteria,
        problem: &Problem,
        nodes: &[usize],
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let mut is_in = vec![false; self.contact.places().len()];
        for &node in nodes {
            is_in[node] = true;
        }
        let mut prefix = self.clone();
        prefix.solutions = Default::default();
        prefix.choose(|node| is_in[node]);
        prefix.solve(criteria, problem, nodes, solution)
    }

    /// Solves on the contact, whose nodes are `nodes` in the order in which they joined.
    pub(super) fn solve(
        &mut self,
        criteria: Criteria,
        problem: &Problem,
        nodes: &[usize],
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let outputs = [(&mut solution.y1, -1.0), (&mut solution.y2, 1.0)];
        for (rhs, (output, sign)) in outputs.into_iter().enumerate() {
            let mut x = std::mem::take(&mut self.solutions[rhs]);
            self.solve_rhs(criteria, problem, rhs, &mut x)?;
            let places = self.contact.places();
            output.clear();
            output.extend(nodes.iter().map(|&node| sign * x[places[node] as usize]));
            self.solutions[rhs] = x;
        }
        Ok(())
    }

    /// Takes nodes out of the contact: solutions start from what they were on those that stay.
    pub(super) fn shrink(&mut self, left: &ContactSequence) {
        self.columns.clear();
        let stays = |node: u32| left.contains(node as usize);
        for x in &mut self.solutions {
            let values = self.contact.nodes().iter().zip(x.iter());
            *x = values
                .filter(|(node, _)| stays(**node))
                .map(|(_, value)| *value)
                .collect();
        }
        self.choose(|node| left.contains(node));
    }
}
