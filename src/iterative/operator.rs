//! The influence matrix as an operator: pressures on a contact set to displacements everywhere.

use super::ContactSet;
use crate::Error;
use crate::convolution::Convolution;

/// A convolution with its buffers, which counts how often it is used.
#[derive(Debug, Clone)]
pub(crate) struct Operator {
    convolution: Convolution,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
    convolutions: usize,
}

impl Operator {
    pub(crate) fn new(convolution: Convolution) -> Self {
        let nodes = convolution.grid().nodes();
        Self {
            convolution,
            pressure: vec![0.0; nodes],
            displacement: vec![0.0; nodes],
            convolutions: 0,
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        self.convolution.memory() + 2 * size_of_val(&self.pressure[..])
    }

    /// Convolutions since this was last asked.
    pub(crate) fn take_convolutions(&mut self) -> usize {
        std::mem::take(&mut self.convolutions)
    }

    /// Displacement of every node under the pressures of a contact set.
    pub(crate) fn apply(&mut self, contact: &ContactSet, values: &[f64]) -> Result<&[f64], Error> {
        self.pressure.fill(0.0);
        contact.scatter(values, &mut self.pressure);
        self.convolutions += 1;
        self.convolution
            .apply(&self.pressure, &mut self.displacement)?;
        Ok(&self.displacement)
    }

    /// Displacement of every node under a pressure field.
    pub(crate) fn apply_field(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        self.convolutions += 1;
        self.convolution.apply(pressure, &mut self.displacement)?;
        Ok(&self.displacement)
    }
}
