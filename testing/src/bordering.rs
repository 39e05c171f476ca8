//! A user-defined updater.

use asperity::contact::ContactSequence;
use asperity::updater::{LinearUpdater, Schur, Solution, WindowFactor};
use asperity::{Error, Problem};
use nalgebra::{DMatrix, DVector};

/// An explicit inverse, bordered by one node at a time (paper, eqs. 7-13). It cannot let nodes go: for that it has what
/// the trait has.
#[derive(Debug, Default)]
pub struct Bordering {
    inverse: DMatrix<f64>,
}

impl Bordering {
    fn influence(problem: &Problem, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
            problem.coefficient(rows[i], columns[j]).unwrap()
        })
    }

    /// Borders the inverse for the nodes of `order` that it does not have yet.
    fn grow(&mut self, problem: &Problem, order: &[usize]) {
        for n in self.inverse.nrows()..order.len() {
            let (contact, node) = (&order[..n], order[n]);
            let c = Self::influence(problem, contact, &[node]).column(0).into_owned();
            let x = &self.inverse * &c;
            let pivot = problem.coefficient(node, node).unwrap() - c.dot(&x);
            let mut inverse = DMatrix::zeros(n + 1, n + 1);
            inverse
                .view_mut((0, 0), (n, n))
                .copy_from(&(&self.inverse + &x * x.transpose() / pivot));
            for (k, value) in x.iter().enumerate() {
                inverse[(k, n)] = -value / pivot;
                inverse[(n, k)] = -value / pivot;
            }
            inverse[(n, n)] = 1.0 / pivot;
            self.inverse = inverse;
        }
    }
}

impl LinearUpdater for Bordering {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        let order = contact.order();
        let coupling = Self::influence(problem, order, nodes);
        let eliminated = coupling.transpose() * &self.inverse;
        let complement = Self::influence(problem, nodes, nodes) - &eliminated * &coupling;
        schur.resize(nodes.len())?;
        let sums = problem.row_sums();
        for (i, &node) in nodes.iter().enumerate() {
            let inside = eliminated.row(i);
            let explained: f64 = inside.iter().zip(order).map(|(e, &k)| e * sums[k]).sum();
            schur.row_sums_mut()[i] = sums[node] - explained;
        }
        let mut matrix = schur.matrix_mut();
        for j in 0..nodes.len() {
            for i in 0..nodes.len() {
                // Nobody may look at the upper triangle.
                matrix[(i, j)] = if i >= j { complement[(i, j)] } else { f64::NAN };
            }
        }
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &WindowFactor,
    ) -> Result<(), Error> {
        assert_eq!(self.inverse.nrows() + touched.len(), contact.len());
        self.grow(problem, contact.order());
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        let order = &contact.order()[..count];
        let mut prefix = Self::default();
        let inverse = if count == self.inverse.nrows() {
            &self.inverse
        } else {
            prefix.grow(problem, order);
            &prefix.inverse
        };
        let gap = order.iter().map(|&node| problem.initial_gap()[node]);
        let overlap = DVector::from_iterator(count, gap.map(|gap| approach - gap));
        solution.pressure = (inverse * overlap).data.into();
        solution.rate = inverse.column_sum().data.into();
        Ok(())
    }
}
