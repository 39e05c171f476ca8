//! Residuals of solutions, by a convolution in double precision.

use super::System;
use crate::Error;
use crate::convolution::{Convolution, SingleConvolution};

/// Fields over the grid for the residual.
#[derive(Debug, Clone)]
pub(super) struct Fields {
    convolution: Convolution,
    single: SingleConvolution,
    spread: [Vec<f64>; System::RHS],
    added: Vec<f64>,
    /// $C_{:,I} Y$.
    pub(super) answer: [Vec<f64>; System::RHS],
}

/// One column of a residual, in units that suit single precision.
#[derive(Debug, Default)]
pub(super) struct Residual {
    pub(super) values: Vec<f32>,
    pub(super) unit: f64,
    pub(super) relative: f64,
}

impl Fields {
    pub(super) fn new(system: &System) -> Result<Self, Error> {
        let field = || vec![0.0; system.gap().len()];
        let convolution = Convolution::from_table(system.table())?;
        Ok(Self {
            single: convolution.to_single(),
            convolution,
            spread: [field(), field(), field()],
            added: field(),
            answer: [field(), field(), field()],
        })
    }

    /// $C_{:,I} Y$ for a solution on the given nodes.
    pub(super) fn convolve(
        &mut self,
        nodes: &[usize],
        solution: &[Vec<f64>; System::RHS],
    ) -> Result<(), Error> {
        self.spread(nodes, solution);
        let [s1, s2, s3] = &self.spread;
        let [a1, a2, a3] = &mut self.answer;
        self.convolution.apply_two([s1, s2], [a1, a2])?;
        self.convolution.apply(s3, a3)
    }

    /// Adds what a change of the solution adds, in single precision: for changes so small that its
    /// errors do not matter.
    pub(super) fn add(
        &mut self,
        nodes: &[usize],
        change: &[Vec<f64>; System::RHS],
    ) -> Result<(), Error> {
        self.spread(nodes, change);
        for ((field, change), answer) in self.spread.iter().zip(change).zip(&mut self.answer) {
            let greatest = change.iter().map(|value| value.abs()).fold(0.0, f64::max);
            self.single.apply(field, greatest, &mut self.added)?;
            for (answer, added) in answer.iter_mut().zip(&self.added) {
                *answer += added;
            }
        }
        Ok(())
    }

    /// Values on the given nodes as fields.
    fn spread(&mut self, nodes: &[usize], values: &[Vec<f64>; System::RHS]) {
        for (field, column) in self.spread.iter_mut().zip(values) {
            field.fill(0.0);
            for (&node, &value) in nodes.iter().zip(column) {
                field[node] = value;
            }
        }
    }

    /// $B_I - C_{II} Y$ on the given nodes.
    pub(super) fn residual(&self, system: &System, nodes: &[usize]) -> [Residual; System::RHS] {
        let mut residuals: [Residual; System::RHS] = Default::default();
        let mut differences = Vec::with_capacity(nodes.len());
        for (i, (residual, answer)) in residuals.iter_mut().zip(&self.answer).enumerate() {
            let (mut scale, mut unit) = (0.0_f64, 0.0_f64);
            differences.clear();
            differences.extend(nodes.iter().map(|&node| {
                let rhs = system.rhs_at(node)[i];
                let difference = rhs - answer[node];
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

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let values = (2 * System::RHS + 1) * self.added.len();
        self.convolution.bytes() + self.single.bytes() + values * size_of::<f64>()
    }
}
