//! Solutions by conjugate gradients and FFT, without a factor.

use super::{LinearUpdater, Schur, Solution, System, Touched, WindowCost};
use crate::Error;
use crate::convolution::Convolution;
use crate::krylov::{LinearSystem, NodeSet, Operator, SparseInverse, dot};

/// What a column costs, some twenty convolutions of 12 ns for each node of the grid, is the same in
/// every window. A refresh costs as much as three columns, and products between columns, 0.3 ns
/// each, grow with their number: so many are watched that both are small beside the columns.
const WINDOW_COST: WindowCost = WindowCost {
    solve: 0.0,
    schur: 0.3,
    convolution: 700.0,
    most_watched: 0.05,
    multiple: 1,
};

/// Solves by preconditioned conjugate gradients with one convolution a step ("when the total nodes
/// get large and reach the computation or storage limitation", as the paper has it).
///
/// No factor is kept: beside memory in proportion to the grid, the columns
/// $X = C_{II}^{-1} C_{IP}$ of the watched nodes P and their residuals, 16 bytes for each contact
/// node and each watched one: some hundred of them by default, fewer where the memory budget or
/// [`window_size`](crate::loading::LoadingBuilder::window_size) says so.
///
/// When nodes touch, columns and solutions are carried over by the paper's recursion (eqs. 10-13,
/// for a block of nodes): all starts are warm. Schur complements take the residuals into account,
/// $b_i^T C^{-1} b_j \approx b_i^T x_j + x_i^T r_j$, whose error is the product of two: columns need
/// only the root of the tolerance.
///
/// [`RecursiveCholesky`](super::RecursiveCholesky) is faster wherever its factor fits, and
/// [`Handover`](super::Handover) chooses between the two.
#[derive(Debug, Clone)]
pub struct ConjugateGradient {
    tolerance: f64,
    max_iterations: usize,
    grid: Option<OnGrid>,
    /// Contact nodes in the order in which they touched.
    order: Vec<usize>,
    /// $C_{II}^{-1} B_I$ by place in the contact set.
    solutions: [Vec<f64>; System::RHS],
    /// Columns of the watched nodes, in the order of the window.
    columns: Vec<Column>,
}

/// What depends on the grid and its kernel.
#[derive(Debug, Clone)]
struct OnGrid {
    operator: Operator,
    inverse: SparseInverse,
    contact: NodeSet,
}

/// $x = C_{II}^{-1} C_{Ij}$ of a watched node j, and the residual of this equation.
#[derive(Debug, Clone, Default)]
struct Column {
    node: usize,
    values: Vec<f64>,
    residual: Vec<f64>,
}

impl Default for ConjugateGradient {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            max_iterations: 5000,
            grid: None,
            order: Vec::new(),
            solutions: Default::default(),
            columns: Vec::new(),
        }
    }
}

impl ConjugateGradient {
    /// An empty contact set and a relative tolerance of 10⁻¹².
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// An empty contact set and another tolerance: of the greatest residual relative to the
    /// greatest right-hand side.
    ///
    /// # Errors
    ///
    /// [`Error::OutOfRange`] for a tolerance that is not between 0 and 1, both excluded.
    pub fn with_tolerance(tolerance: f64) -> Result<Self, Error> {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(Error::OutOfRange {
                quantity: "tolerance",
                value: tolerance,
                expected: "above 0 and below 1",
            });
        }
        Ok(Self {
            tolerance,
            ..Self::default()
        })
    }

    /// Number of nodes in contact.
    #[must_use]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether no node is in contact.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Begins with the contact set `order` and the solution on it.
    pub(super) fn take_over(
        &mut self,
        system: &System,
        order: Vec<usize>,
        solution: &Solution,
    ) -> Result<(), Error> {
        system.check_nodes(&order)?;
        let mut grid = Self::on_grid(&mut self.grid, system)?;
        let mut in_contact = vec![false; system.gap().len()];
        for &node in &order {
            in_contact[node] = true;
        }
        grid.contact.assign(|node| in_contact[node]);
        grid.inverse.update(&grid.contact);
        let places = grid.contact.places();
        for (start, (values, sign)) in self
            .solutions
            .iter_mut()
            .zip([(&solution.y1, -1.0), (&solution.y2, 1.0)])
        {
            start.resize(order.len(), 0.0);
            for (&node, value) in order.iter().zip(values) {
                start[places[node] as usize] = sign * value;
            }
        }
        // The row sums begin from nothing.
        self.solutions[2].resize(order.len(), 0.0);
        self.columns.clear();
        self.order = order;
        self.grid = Some(grid);
        Ok(())
    }

    /// What depends on the grid, made at first use.
    fn on_grid(grid: &mut Option<OnGrid>, system: &System) -> Result<OnGrid, Error> {
        match grid.take() {
            Some(grid) => Ok(grid),
            None => {
                let table = system.table();
                Ok(OnGrid {
                    operator: Operator::new(Convolution::from_table(table)?),
                    inverse: SparseInverse::new(table),
                    contact: NodeSet::new(table.grid().nodes()),
                })
            }
        }
    }

    /// Solves $C_{II} x = B_I$ for one right-hand side, from the start `x`, and returns the residual.
    /// The operator then holds the displacements of x.
    fn solve_rhs(
        &self,
        grid: &mut OnGrid,
        system: &System,
        rhs: usize,
        x: &mut Vec<f64>,
    ) -> Result<Vec<f64>, Error> {
        let nodes = grid.contact.nodes().iter();
        let b: Vec<f64> = nodes.map(|&n| system.rhs_at(n as usize)[rhs]).collect();
        x.resize(b.len(), 0.0);
        self.iterate(grid, &b, x, self.tolerance)
    }

    /// Solves $C_{II} x = b$ from the start `x` to a relative tolerance, and returns the residual.
    /// The operator then holds the displacements of x.
    fn iterate(
        &self,
        grid: &mut OnGrid,
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
    ) -> Result<Vec<f64>, Error> {
        let greatest = b.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let mut equations = LinearSystem {
            operator: &mut grid.operator,
            inverse: &mut grid.inverse,
            contact: &grid.contact,
            tolerance: tolerance * greatest,
            max_iterations: self.max_iterations,
        };
        let mut residual = Vec::new();
        equations.residual(b, x, &mut residual)?;
        let outcome = equations.solve(b, x, &mut residual)?;
        if outcome.converged {
            return Ok(residual);
        }
        Err(Error::NoConvergence {
            residual: outcome.residual / greatest,
            tolerance,
            iterations: outcome.iterations,
        })
    }

    fn schur_on(
        &mut self,
        grid: &mut OnGrid,
        system: &System,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let mut earlier = std::mem::take(&mut self.columns);
        schur.resize(nodes.len());
        let table = system.table();
        let contact = grid.contact.len();
        // Columns to the root of the tolerance: see the type.
        let tolerance = 0.1 * self.tolerance.sqrt();
        // $S = C_{PP} - B^T C_{II}^{-1} B$ with B the coefficients between contact and watched.
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
            let others = grid.contact.nodes().iter();
            b.clear();
            b.extend(others.map(|&other| table.between(place, table.place(other as usize))));
            column.residual = self.iterate(grid, &b, &mut column.values, tolerance)?;
            let inside = grid.operator.displacement();
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
        for rhs in 0..System::RHS {
            let mut x = std::mem::take(&mut self.solutions[rhs]);
            let residual = self.solve_rhs(grid, system, rhs, &mut x)?;
            let inside = grid.operator.displacement();
            let reduced = schur.rhs_mut().iter_mut();
            for ((reduced, column), &node) in reduced.zip(&self.columns).zip(nodes) {
                let corrected = dot(&column.values, &residual);
                reduced[rhs] = system.rhs_at(node)[rhs] - inside[node] - corrected;
            }
            self.solutions[rhs] = x;
        }
        Ok(())
    }

    /// Carries columns and solutions over to the contact set with `touched`.
    fn grow(&mut self, grid: &mut OnGrid, touched: &Touched) {
        let mut in_contact = vec![false; grid.contact.places().len()];
        for &node in self.order.iter().chain(touched.nodes()) {
            in_contact[node] = true;
        }
        let mut contact = grid.contact.clone();
        contact.assign(|node| in_contact[node]);
        let carry = |values: &[f64], entry: &dyn Fn(usize) -> f64| {
            // $R_{TT}^T w$ = entries, then $x_I - X_T w$ on the old nodes and w on the new ones.
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
            let moved = grid.contact.nodes().iter().map(|&node| node as usize);
            let values = moved.zip(&old);
            for (node, &value) in values.chain(touched.nodes().iter().copied().zip(&w)) {
                grown[contact.places()[node] as usize] = value;
            }
            grown
        };
        let solutions = std::array::from_fn(|rhs| {
            carry(&self.solutions[rhs], &|t| {
                touched.rhs(t).map_or(0.0, |entries| entries[rhs])
            })
        });
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
        self.order.extend_from_slice(touched.nodes());
        grid.inverse.update(&contact);
        grid.contact = contact;
    }

    /// Solves for the first `count` of `order`, which need not be the contact set.
    fn solve_prefix(
        &mut self,
        grid: &mut OnGrid,
        system: &System,
        order: &[usize],
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let is_present = order.len() == self.order.len();
        let mut other;
        let at = if is_present {
            &mut *grid
        } else {
            let mut in_contact = vec![false; system.gap().len()];
            for &node in order {
                in_contact[node] = true;
            }
            other = grid.clone();
            other.contact.assign(|node| in_contact[node]);
            other.inverse.update(&other.contact);
            &mut other
        };
        let mut outputs = [&mut solution.y1, &mut solution.y2];
        for (rhs, (output, sign)) in outputs.iter_mut().zip([-1.0, 1.0]).enumerate() {
            let mut x = if is_present {
                std::mem::take(&mut self.solutions[rhs])
            } else {
                Vec::new()
            };
            self.solve_rhs(at, system, rhs, &mut x)?;
            let places = at.contact.places();
            output.clear();
            output.extend(order.iter().map(|&node| sign * x[places[node] as usize]));
            if is_present {
                self.solutions[rhs] = x;
            }
        }
        Ok(())
    }
}

impl LinearUpdater for ConjugateGradient {
    /// Nodes that were watched before start from their earlier columns.
    ///
    /// # Errors
    ///
    /// [`Error::NoConvergence`], and [`Error::FactorizationFailed`] if the kernel is not positive
    /// definite.
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        system.check_nodes(nodes)?;
        let mut grid = Self::on_grid(&mut self.grid, system)?;
        let done = self.schur_on(&mut grid, system, nodes, schur);
        self.grid = Some(grid);
        done
    }

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        if touched.watched() != self.columns.len() {
            return Err(Error::LengthMismatch {
                expected: self.columns.len(),
                found: touched.watched(),
            });
        }
        system.check_nodes(touched.nodes())?;
        let mut grid = Self::on_grid(&mut self.grid, system)?;
        self.grow(&mut grid, touched);
        self.grid = Some(grid);
        Ok(())
    }

    /// Solutions start from what they were on the nodes that stay.
    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        system.check_nodes(&[node])?;
        let position = self.order.iter().position(|&other| other == node);
        let position = position.ok_or_else(|| system.not_in_contact(node))?;
        let mut grid = Self::on_grid(&mut self.grid, system)?;
        self.order.remove(position);
        self.columns.clear();
        let place = grid.contact.places()[node] as usize;
        let known = self.solutions.iter_mut().filter(|x| place < x.len());
        known.for_each(|x| {
            x.remove(place);
        });
        let mut in_contact = vec![false; system.gap().len()];
        for &node in &self.order {
            in_contact[node] = true;
        }
        grid.contact.assign(|node| in_contact[node]);
        grid.inverse.update(&grid.contact);
        self.grid = Some(grid);
        Ok(())
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let order = touched.sequence(&self.order, count)?;
        system.check_nodes(&order)?;
        let mut grid = Self::on_grid(&mut self.grid, system)?;
        let done = self.solve_prefix(&mut grid, system, &order, solution);
        self.grid = Some(grid);
        done
    }

    fn window_cost(&self) -> WindowCost {
        WINDOW_COST
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let fixed = self
            .grid
            .as_ref()
            .map_or(0, |grid| grid.operator.bytes() + 2 * grid.inverse.bytes());
        let columns = watched.saturating_mul(2).saturating_add(8);
        contact
            .saturating_mul(columns)
            .saturating_mul(size_of::<f64>())
            .saturating_add(fixed)
    }
}
