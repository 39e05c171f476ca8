//! Residuals of solutions, by a convolution in double precision.

use super::System;
use crate::Error;
use crate::convolution::Convolution;

/// Fields over the grid for the residual.
#[derive(Debug, Clone)]
pub(super) struct Fields {
    convolution: Convolution,
    spread: [Vec<f64>; System::RHS],
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
        Ok(Self {
            convolution: Convolution::from_table(system.table())?,
            spread: [field(), field(), field()],
            answer: [field(), field(), field()],
        })
    }

    /// $C_{:,I} Y$ for a solution on the given nodes.
    pub(super) fn convolve(
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
    pub(super) fn residual(&self, system: &System, nodes: &[usize]) -> [Residual; System::RHS] {
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

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let values = 2 * System::RHS * self.spread[0].len();
        self.convolution.memory() + values * size_of::<f64>()
    }
}
