//! The recursive Cholesky factorisation in mixed precision.

use std::time::Instant;

use super::factor::{CholeskyTimings, Factor};
use super::{LinearUpdater, Schur, Solution, System, Touched, WindowCost};
use crate::Error;
use crate::convolution::Convolution;

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
#[derive(Debug, Clone)]
pub struct MixedCholesky {
    factor: Factor<f32>,
    /// Nodes in contact, in the order of the factor.
    contact: Vec<usize>,
    /// $Y = C_{II}^{-1} B_I$, as refined last, for the nodes `refined`.
    solution: [Vec<f64>; System::RHS],
    refined: Vec<usize>,
    fields: Option<Fields>,
}

/// Fields over the grid for the residual.
#[derive(Debug, Clone)]
struct Fields {
    convolution: Convolution,
    spread: [Vec<f64>; System::RHS],
    /// $C_{:,I} Y$.
    answer: [Vec<f64>; System::RHS],
}

/// Greatest residual of a refined solution relative to its right-hand side. A rounding error of
/// the convolution is a few 1e-15 of the greatest displacement, and the row sums, the greatest
/// right-hand side, are a few hundred times the least.
const TOLERANCE: f64 = 1e-12;
/// Refinement gains three digits or more at every step, or never arrives.
const STEPS: usize = 30;

impl Default for MixedCholesky {
    fn default() -> Self {
        Self::new()
    }
}

impl MixedCholesky {
    /// An empty contact set.
    #[must_use]
    pub fn new() -> Self {
        Self {
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
        self.factor.timings
    }

    /// Solves $C_{II} Y = B_I$ for the first `count` nodes of the committed ones and `touched`.
    fn refine(&mut self, system: &System, touched: &Touched, count: usize) -> Result<(), Error> {
        if self.fields.is_none() {
            self.fields = Some(Fields::new(system)?);
        }
        let nodes = touched.sequence(&self.contact, count)?;
        if nodes == self.refined {
            return Ok(());
        }
        let known = self.solution[0].len().min(count);
        // The displacements of a solution on fewer nodes are known already.
        let starts_from_refined = nodes.starts_with(&self.refined);
        self.refined.clear();
        for column in &mut self.solution {
            column.resize(count, 0.0);
        }
        let mut best = f64::INFINITY;
        for step in 0..STEPS {
            let Some(fields) = &mut self.fields else {
                break;
            };
            if step > 0 || !starts_from_refined {
                fields.convolve(&nodes, &self.solution)?;
            }
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
            self.precondition(touched, corrections, from);
            let square = self.factor.scale * self.factor.scale;
            for (column, correction) in self.solution.iter_mut().zip(&residual) {
                for (y, change) in column.iter_mut().zip(&correction.values) {
                    *y += f64::from(*change) * correction.unit / square;
                }
            }
        }
        Err(Error::NoConvergence {
            residual: best,
            tolerance: TOLERANCE,
            iterations: STEPS,
        })
    }

    /// x ← $(L L^T)^{-1} x$ on the committed nodes and those of `touched`, with x zero before the
    /// entry `from`.
    fn precondition(&self, touched: &Touched, mut x: [&mut [f32]; System::RHS], from: usize) {
        let committed = x[0].len().min(self.factor.len());
        let Factor {
            panels,
            columns,
            scale,
            ..
        } = &self.factor;
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
}

/// One column of a residual, in units that suit single precision.
#[derive(Debug, Default)]
struct Residual {
    values: Vec<f32>,
    unit: f64,
    relative: f64,
}

impl Fields {
    fn new(system: &System) -> Result<Self, Error> {
        let field = || vec![0.0; system.gap().len()];
        Ok(Self {
            convolution: Convolution::from_table(system.table())?,
            spread: [field(), field(), field()],
            answer: [field(), field(), field()],
        })
    }

    /// $C_{:,I} Y$ for a solution on the given nodes.
    fn convolve(
        &mut self,
        nodes: &[usize],
        solution: &[Vec<f64>; System::RHS],
    ) -> Result<(), Error> {
        for (field, column) in self.spread.iter_mut().zip(solution) {
            field.fill(0.0);
            for (&node, &value) in nodes.iter().zip(column) {
                field[node] = value;
            }
        }
        let [s1, s2, s3] = &self.spread;
        let [a1, a2, a3] = &mut self.answer;
        self.convolution.apply_two([s1, s2], [a1, a2])?;
        self.convolution.apply(s3, a3)
    }

    /// $B_I - C_{II} Y$ on the given nodes.
    fn residual(&self, system: &System, nodes: &[usize]) -> [Residual; System::RHS] {
        let mut residuals: [Residual; System::RHS] = Default::default();
        for (i, residual) in residuals.iter_mut().enumerate() {
            let rhs = |node: usize| system.rhs_at(node)[i];
            let answer = &self.answer[i];
            let difference = |&node: &usize| rhs(node) - answer[node];
            residual.unit = nodes
                .iter()
                .map(difference)
                .map(f64::abs)
                .fold(0.0, f64::max);
            let scale = nodes
                .iter()
                .map(|&node| rhs(node).abs())
                .fold(0.0, f64::max);
            if residual.unit > 0.0 {
                residual.relative = residual.unit / scale;
                residual.values.extend(
                    nodes
                        .iter()
                        .map(|node| (difference(node) / residual.unit) as f32),
                );
            } else {
                residual.values.resize(nodes.len(), 0.0);
            }
        }
        residuals
    }
}

impl LinearUpdater for MixedCholesky {
    fn schur(&mut self, system: &System, nodes: &[usize], schur: &mut Schur) -> Result<(), Error> {
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
        self.factor.commit(system, touched)?;
        self.contact.extend_from_slice(touched.nodes());
        Ok(())
    }

    fn release(&mut self, system: &System, node: usize) -> Result<(), Error> {
        self.factor.release(system, node)?;
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
        WindowCost {
            solve: 0.5,
            schur: 0.005,
            convolution: 150.0,
            most_watched: 0.08,
        }
    }

    fn is_exact(&self) -> bool {
        false
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        let fields = self.fields.as_ref();
        let fields = fields.map_or(0, |fields| {
            fields.convolution.memory()
                + 2 * System::RHS * fields.spread[0].len() * size_of::<f64>()
        });
        let vectors = System::RHS * (size_of::<f64>() + size_of::<f32>()) + size_of::<usize>();
        Factor::<f32>::bytes(contact, watched)
            .saturating_add(contact.saturating_mul(vectors))
            .saturating_add(fields)
    }
}
