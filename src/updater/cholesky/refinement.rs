//! Solutions in double precision from a factor in single precision.

use super::factor::Factor;
use crate::convolution::{Convolution, SingleConvolution};
use crate::parallel;
use crate::{Error, Problem};

/// Greatest residual of a refined solution relative to its right-hand side. A rounding error of
/// the convolution is a few 1e-15 of the greatest displacement, and the row sums, the greatest
/// right-hand side, are a few hundred times the least.
const TOLERANCE: f64 = 1e-12;
/// Residuals whose correction changes the next residual by so little that single precision tells how
/// much, to some 1e-7 of it.
const SMALL: f64 = 1e-6;
/// Refinement gains three digits or more at every step, or never arrives.
const STEPS: usize = 30;

/// A value for each right-hand side.
type Columns<T> = [T; Problem::RHS];

/// `Y = C_II⁻¹ B_I` for the right-hand sides B, and the displacements `C_:I Y` everywhere.
#[derive(Debug, Clone)]
pub(super) struct Refinement {
    convolution: Convolution,
    single: SingleConvolution,
    /// Fields that are convolved, and what a change adds to the displacements.
    spread: Columns<Vec<f64>>,
    added: Vec<f64>,
    pub(super) displacement: Columns<Vec<f64>>,
    pub(super) solution: Columns<Vec<f64>>,
    /// Whether the displacements are those of the solution.
    displaced: bool,
    /// The contact for which the solution is refined.
    revision: Option<u64>,
}

/// One column of a residual, in units that suit single precision.
#[derive(Debug, Default)]
struct Residual {
    values: Vec<f32>,
    unit: f64,
    relative: f64,
}

impl Refinement {
    pub(super) fn new(problem: &Problem) -> Self {
        let field = || vec![0.0; problem.initial_gap().len()];
        let convolution = problem.convolution();
        Self {
            single: convolution.to_single(),
            convolution,
            spread: [field(), field(), field()],
            added: field(),
            displacement: [field(), field(), field()],
            solution: Default::default(),
            displaced: true,
            revision: None,
        }
    }

    /// Starts anew from zero, which displaces nothing.
    pub(super) fn forget(&mut self) {
        self.solution.iter_mut().for_each(Vec::clear);
        for field in &mut self.displacement {
            field.fill(0.0);
        }
        self.displaced = true;
        self.revision = None;
    }

    /// Keeps the values at the first `count` nodes as a start.
    pub(super) fn truncate(&mut self, count: usize) {
        for column in &mut self.solution {
            column.truncate(count);
        }
        self.displaced = false;
        self.revision = None;
    }

    /// Solves for the first `nodes` of the contact of `revision`, of which `factor` is the factor.
    pub(super) fn refine(
        &mut self,
        problem: &Problem,
        factor: &Factor<f32>,
        nodes: &[usize],
        revision: u64,
    ) -> Result<(), Error> {
        if self.revision == Some(revision) {
            return Ok(());
        }
        self.revision = None;
        parallel::inside(|| self.iterate(problem, factor, nodes))?;
        self.revision = Some(revision);
        Ok(())
    }

    fn iterate(
        &mut self,
        problem: &Problem,
        factor: &Factor<f32>,
        nodes: &[usize],
    ) -> Result<(), Error> {
        // New nodes start from zero, and displace nothing.
        let known = self.solution[0].len();
        for column in &mut self.solution {
            column.resize(nodes.len(), 0.0);
        }
        if !self.displaced {
            self.displace(nodes)?;
        }
        let mut best = f64::INFINITY;
        for step in 0..STEPS {
            let mut residual = self.residual(problem, nodes);
            let sizes = residual.iter().map(|column| column.relative);
            let size = sizes.fold(0.0, f64::max);
            // Rounding may leave the residual a little above the tolerance; then it stops falling.
            if size <= TOLERANCE || (size <= 100.0 * TOLERANCE && size > 0.5 * best) {
                return Ok(());
            }
            if size.is_nan() || step > 3 && size > 0.5 * best {
                best = best.min(size);
                break;
            }
            best = best.min(size);
            // At first only the new nodes have a residual.
            let from = if step == 0 { known } else { 0 };
            let mut x = residual.each_mut().map(|column| &mut column.values[..]);
            factor.panels.solve(x.each_mut().map(|x| &mut **x), from);
            factor.panels.solve_transposed(x);
            let square = factor.scale * factor.scale;
            let change = residual.map(|column| {
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
                self.add(nodes, &change)?;
            } else {
                self.displace(nodes)?;
            }
        }
        Err(Error::NoConvergence {
            residual: best,
            tolerance: TOLERANCE,
            iterations: STEPS,
        })
    }

    /// Computes the displacements of the solution.
    fn displace(&mut self, nodes: &[usize]) -> Result<(), Error> {
        spread(nodes, &self.solution, &mut self.spread);
        self.displaced = false;
        for (field, displacement) in self.spread.iter().zip(&mut self.displacement) {
            self.convolution.apply(field, displacement)?;
        }
        self.displaced = true;
        Ok(())
    }

    /// Adds the displacements of a change of the solution, in single precision: for changes so small
    /// that its errors do not matter.
    fn add(&mut self, nodes: &[usize], change: &Columns<Vec<f64>>) -> Result<(), Error> {
        spread(nodes, change, &mut self.spread);
        for ((field, change), displacement) in
            self.spread.iter().zip(change).zip(&mut self.displacement)
        {
            let greatest = change.iter().map(|value| value.abs()).fold(0.0, f64::max);
            self.single.apply(field, greatest, &mut self.added)?;
            for (displacement, added) in displacement.iter_mut().zip(&self.added) {
                *displacement += added;
            }
        }
        Ok(())
    }

    /// `B_I − C_II Y` on the given nodes.
    fn residual(&self, problem: &Problem, nodes: &[usize]) -> Columns<Residual> {
        let mut residuals: Columns<Residual> = Default::default();
        let mut differences = Vec::with_capacity(nodes.len());
        for (i, (residual, displacement)) in
            residuals.iter_mut().zip(&self.displacement).enumerate()
        {
            let (mut scale, mut unit) = (0.0_f64, 0.0_f64);
            differences.clear();
            differences.extend(nodes.iter().map(|&node| {
                let rhs = problem.rhs(node)[i];
                let difference = rhs - displacement[node];
                scale = scale.max(rhs.abs());
                unit = unit.max(difference.abs());
                difference
            }));
            residual.unit = unit;
            if unit > 0.0 {
                residual.relative = unit / scale;
                let values = differences.iter().map(|value| (value / unit) as f32);
                residual.values.extend(values);
            } else {
                residual.values.resize(nodes.len(), 0.0);
            }
        }
        residuals
    }

    /// Bytes held, besides a value for each contact node and right-hand side.
    pub(super) fn bytes(&self) -> usize {
        let values = (2 * Problem::RHS + 1) * self.added.len();
        self.convolution.bytes() + self.single.bytes() + values * size_of::<f64>()
    }
}

/// Values on the given nodes as fields.
fn spread(nodes: &[usize], values: &Columns<Vec<f64>>, fields: &mut Columns<Vec<f64>>) {
    for (field, column) in fields.iter_mut().zip(values) {
        field.fill(0.0);
        for (&node, &value) in nodes.iter().zip(column) {
            field[node] = value;
        }
    }
}
