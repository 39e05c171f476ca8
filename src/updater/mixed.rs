//! The recursive Cholesky factorisation in mixed precision.

use std::time::Instant;

use super::factor::{CholeskyTimings, Factor};
use super::residual::Fields;
use super::{LinearUpdater, RecursiveCholesky, Schur, Solution, System, Touched, WindowCost};
use crate::Error;
use crate::parallel;

/// A [`RecursiveCholesky`](super::RecursiveCholesky) with its factor in single precision: half the
/// memory, 2n² bytes for n nodes, and products at twice the speed.
///
/// Solutions are refined to double precision: the residual $B_I - C_{II} Y$ comes from a
/// convolution in double precision, the correction from the factor. With them, the reduced
/// right-hand sides of the watched nodes are exact, so that
///
/// * what a state says at a refresh, its pressure, gaps, load and stiffness, is as exact as with a
///   factor in double precision;
/// * between two refreshes only the *changes* since the last one carry the error of a number in
///   single precision, some 1e-7 of them;
/// * nodes whose contact differs by less than that in approach may touch in another order;
/// * every window is verified against the conditions of contact before its states are yielded.
///
/// Refinement costs more than it saves while the factor is small. Up to
/// [`MixedCholesky::SINGLE_FROM`] nodes in contact everything is in double precision, as in a
/// [`RecursiveCholesky`](super::RecursiveCholesky), and takes up to 17 MB; then the factor is rounded.
#[derive(Debug, Clone)]
pub struct MixedCholesky {
    /// The factor as long as it is small.
    double: Option<RecursiveCholesky>,
    /// Nodes in contact from which on it is not.
    single_from: usize,
    factor: Factor<f32>,
    /// Nodes in contact, in the order of the factor.
    contact: Vec<usize>,
    /// $Y = C_{II}^{-1} B_I$, as refined last, for the nodes `refined`.
    solution: [Vec<f64>; System::RHS],
    refined: Vec<usize>,
    fields: Option<Fields>,
}

/// Greatest residual of a refined solution relative to its right-hand side. A rounding error of
/// the convolution is a few 1e-15 of the greatest displacement, and the row sums, the greatest
/// right-hand side, are a few hundred times the least.
const TOLERANCE: f64 = 1e-12;
/// Residuals whose correction changes the next residual by so little that single precision tells how
/// much, to some 1e-7 of it.
const SMALL: f64 = 1e-6;
/// Refinement gains three digits or more at every step, or never arrives.
const STEPS: usize = 30;

impl Default for MixedCholesky {
    fn default() -> Self {
        Self::new()
    }
}

impl MixedCholesky {
    /// Nodes in contact from which on single precision pays.
    pub const SINGLE_FROM: usize = 2048;

    /// An empty contact set.
    #[must_use]
    pub fn new() -> Self {
        Self::single_from(Self::SINGLE_FROM)
    }

    /// An empty contact set whose factor is in single precision from `nodes` nodes on.
    #[must_use]
    pub fn single_from(nodes: usize) -> Self {
        Self {
            double: (nodes > 0).then(RecursiveCholesky::new),
            single_from: nodes,
            factor: Factor::new(),
            contact: Vec::new(),
            solution: Default::default(),
            refined: Vec::new(),
            fields: None,
        }
    }

    /// Where the time went so far.
    #[must_use]
    pub fn timings(&self) -> CholeskyTimings {
        let double = self.double.as_ref().map(RecursiveCholesky::timings);
        double.unwrap_or(self.factor.timings)
    }

    /// Solves $C_{II} Y = B_I$ for the first `count` nodes of the committed ones and `touched`.
    fn refine(&mut self, system: &System, touched: &Touched, count: usize) -> Result<(), Error> {
        let nodes = touched.sequence(&self.contact, count)?;
        if nodes == self.refined {
            return Ok(());
        }
        parallel::inside(|| self.refine_on(system, touched, nodes))
    }

    /// The same on the given nodes.
    fn refine_on(
        &mut self,
        system: &System,
        touched: &Touched,
        nodes: Vec<usize>,
    ) -> Result<(), Error> {
        let count = nodes.len();
        let known = self.solution[0].len().min(count);
        // The displacements of a solution on fewer nodes are known already.
        let starts_from_refined = nodes.starts_with(&self.refined);
        self.refined.clear();
        for column in &mut self.solution {
            column.resize(count, 0.0);
        }
        let fields = match &mut self.fields {
            Some(fields) => fields,
            none => none.insert(Fields::new(system)?),
        };
        if !starts_from_refined {
            fields.convolve(&nodes, &self.solution)?;
        }
        let mut best = f64::INFINITY;
        for step in 0..STEPS {
            let mut residual = fields.residual(system, &nodes);
            let size = residual
                .iter()
                .map(|column| column.relative)
                .fold(0.0, f64::max);
            // Rounding may leave the residual a little above the tolerance; then it stops falling.
            if size <= TOLERANCE || (size <= 100.0 * TOLERANCE && size > 0.5 * best) {
                self.refined = nodes;
                return Ok(());
            }
            if size.is_nan() || step > 3 && size > 0.5 * best {
                best = best.min(size);
                break;
            }
            best = best.min(size);
            // At first only the new nodes have a residual.
            let from = if step == 0 { known } else { 0 };
            let corrections = residual.each_mut().map(|column| &mut column.values[..]);
            precondition(&self.factor, touched, corrections, from);
            let square = self.factor.scale * self.factor.scale;
            let change: [Vec<f64>; System::RHS] = residual.map(|column| {
                let unit = column.unit / square;
                let values = column.values.into_iter();
                values.map(|value| f64::from(value) * unit).collect()
            });
            for (column, change) in self.solution.iter_mut().zip(&change) {
                for (y, change) in column.iter_mut().zip(change) {
                    *y += change;
                }
            }
            if size <= SMALL {
                fields.add(&nodes, &change)?;
            } else {
                fields.convolve(&nodes, &self.solution)?;
            }
        }
        Err(Error::NoConvergence {
            residual: best,
            tolerance: TOLERANCE,
            iterations: STEPS,
        })
    }
}

/// x ← $(L L^T)^{-1} x$ on the committed nodes and those of `touched`, with x zero before the
/// entry `from`.
fn precondition(
    factor: &Factor<f32>,
    touched: &Touched,
    mut x: [&mut [f32]; System::RHS],
    from: usize,
) {
    let committed = x[0].len().min(factor.len());
    let Factor {
        panels,
        columns,
        scale,
        ..
    } = factor;
    if from < committed {
        panels.solve(x.each_mut().map(|x| &mut x[..committed]), from);
    }
    let pending = x[0].len() - committed;
    if pending > 0 {
        let inside: Vec<[f32; System::RHS]> = (0..committed)
            .map(|row| x.each_ref().map(|x| x[row]))
            .collect();
        let mut products = vec![[0.0; System::RHS]; touched.watched()];
        if from < committed {
            columns.subtract_products(&inside, &mut products);
        }
        let positions = &touched.positions()[..pending];
        let mut tail: Vec<[f64; System::RHS]> = positions
            .iter()
            .enumerate()
            .map(|(event, &position)| {
                std::array::from_fn(|i| {
                    f64::from(x[i][committed + event] + products[position][i]) * scale
                })
            })
            .collect();
        touched.solve(&mut tail);
        touched.solve_transposed(&mut tail);
        let terms: Vec<_> = positions
            .iter()
            .zip(&tail)
            .map(|(&position, values)| (position, values.map(|value| (value * scale) as f32)))
            .collect();
        for (event, (_, values)) in terms.iter().enumerate() {
            for (x, value) in x.iter_mut().zip(values) {
                x[committed + event] = *value;
            }
        }
        columns.subtract(&terms, x.each_mut().map(|x| &mut x[..committed]));
    }
    panels.solve_transposed(x.each_mut().map(|x| &mut x[..committed]));
}

impl LinearUpdater for MixedCholesky {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.schur(system, nodes, schur);
        }
        self.factor.scale = system.table().self_influence().sqrt();
        self.factor.eliminate(system, nodes, schur)?;
        self.refine(system, &Touched::default(), self.contact.len())?;
        for (rhs, &node) in schur.rhs_mut().iter_mut().zip(nodes) {
            *rhs = system.rhs_at(node);
            if let Some(fields) = &self.fields {
                for (value, answer) in rhs.iter_mut().zip(&fields.answer) {
                    *value -= answer[node];
                }
            }
        }
        Ok(())
    }

    fn commit(&mut self, system: &System, touched: &Touched) -> Result<(), Error> {
        let Some(double) = &mut self.double else {
            self.factor.commit(system, touched)?;
            self.contact.extend_from_slice(touched.nodes());
            return Ok(());
        };
        double.commit(system, touched)?;
        self.contact.extend_from_slice(touched.nodes());
        if self.contact.len() >= self.single_from
            && let Some(double) = self.double.take()
        {
            let scale = system.table().self_influence().sqrt();
            self.factor = double.into_factor().rounded(scale);
        }
        Ok(())
    }

    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            double.release(system, node)?;
        } else {
            self.factor.release(system, node)?;
        }
        self.contact.retain(|&other| other != node);
        // The next solution starts afresh: from zero, which displaces nothing.
        self.refined.clear();
        self.solution.iter_mut().for_each(Vec::clear);
        let answers = self.fields.iter_mut().flat_map(|fields| &mut fields.answer);
        answers.for_each(|answer| answer.fill(0.0));
        Ok(())
    }

    fn solve(
        &mut self,
        system: &System,
        touched: &Touched,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.solve(system, touched, count, solution);
        }
        let start = Instant::now();
        self.refine(system, touched, count)?;
        solution.y1.clear();
        solution
            .y1
            .extend(self.solution[0].iter().map(|value| -value));
        solution.y2.clear();
        solution.y2.extend_from_slice(&self.solution[1]);
        self.factor.timings.solve += start.elapsed();
        Ok(())
    }

    /// A refined solution reads the factor three times, and needs nine displacements more.
    fn window_cost(&self) -> WindowCost {
        if let Some(double) = &self.double {
            return double.window_cost();
        }
        WindowCost {
            solve: 0.5,
            schur: 0.005,
            convolution: 150.0,
            most_watched: 0.08,
            multiple: 96,
        }
    }

    fn is_exact(&self) -> bool {
        self.double.is_some()
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        if let Some(double) = &self.double {
            return double.bytes(contact, watched);
        }
        let fields = self.fields.as_ref().map_or(0, Fields::bytes);
        let vectors = System::RHS * (size_of::<f64>() + size_of::<f32>()) + size_of::<usize>();
        Factor::<f32>::bytes(contact, watched)
            .saturating_add(contact.saturating_mul(vectors))
            .saturating_add(fields)
    }
}
