//! The influence matrix as an operator: pressures on a contact set to displacements everywhere.

use super::{NodeSet, add_scaled, greatest, sum};
use crate::Error;
use crate::convolution::{Convolution, SingleConvolution};

/// A convolution with its buffers, which counts how often it is used.
///
/// Steps of an iteration go through single precision, fields and all, in half the time: what they add to a
/// residual is wrong by some 10⁻⁷ of what they add, so that a residual may fall by five digits before it has
/// to be computed afresh in double precision.
#[derive(Debug, Clone)]
pub(crate) struct Operator {
    convolution: Convolution,
    single: SingleConvolution,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
    single_pressure: Vec<f32>,
    /// Uniform displacement per unit of the sum of pressures.
    uniform: f64,
    convolutions: usize,
}

impl Operator {
    pub(crate) fn new(convolution: Convolution) -> Self {
        let nodes = convolution.grid().nodes();
        Self {
            single: convolution.to_single(),
            convolution,
            pressure: vec![0.0; nodes],
            displacement: vec![0.0; nodes],
            single_pressure: vec![0.0; nodes],
            uniform: 0.0,
            convolutions: 0,
        }
    }

    /// Bytes held.
    pub(crate) fn bytes(&self) -> usize {
        let fields = 2 * size_of_val(&self.pressure[..]) + size_of_val(&self.single_pressure[..]);
        self.convolution.bytes() + self.single.bytes() + fields
    }

    /// Convolutions, of either precision, since this was last asked.
    pub(crate) fn take_convolutions(&mut self) -> usize {
        std::mem::take(&mut self.convolutions)
    }

    /// The same without asking: the count goes on.
    pub(crate) fn convolutions(&self) -> usize {
        self.convolutions
    }

    /// Adds a uniform displacement, `uniform` per unit of the sum of pressures, to that of the kernel:
    /// a change of gauge.
    pub(crate) fn set_uniform(&mut self, uniform: f64) {
        self.uniform = uniform;
    }

    /// The unit of displacements from [`Self::step`] \[m\].
    pub(crate) fn unit(&self) -> f64 {
        self.single.unit()
    }

    /// What single precision makes of displacements: see [`SingleConvolution::noise`].
    pub(crate) fn noise(&self) -> f64 {
        self.single.noise()
    }

    /// Displacement of every node under the pressures of a contact set, which should be of the order of 1, in single
    /// precision and in units of [`Self::unit`].
    pub(crate) fn step(
        &mut self,
        contact: &NodeSet,
        values: &[f32],
        displacement: &mut Vec<f32>,
    ) -> Result<(), Error> {
        contact.spread(values, &mut self.single_pressure);
        self.convolutions += 1;
        displacement.resize(self.single_pressure.len(), 0.0);
        self.single.apply(&self.single_pressure, displacement)?;
        if self.uniform != 0.0 {
            let everywhere = (self.uniform * sum(values) / self.unit()) as f32;
            displacement.iter_mut().for_each(|u| *u += everywhere);
        }
        Ok(())
    }

    /// Adds to `u` the displacements under any pressures of a contact set, in single precision, and returns the
    /// greatest that it has added.
    pub(crate) fn add(
        &mut self,
        contact: &NodeSet,
        values: &[f64],
        u: &mut [f64],
    ) -> Result<f64, Error> {
        let most = greatest(values.len(), 0.0, |i| values[i].abs());
        if most == 0.0 {
            return Ok(0.0);
        }
        let scaled: Vec<f32> = values.iter().map(|value| (value / most) as f32).collect();
        let mut change = Vec::new();
        self.step(contact, &scaled, &mut change)?;
        let unit = most * self.unit();
        add_scaled(u, unit, &change);
        Ok(unit * greatest(change.len(), 0.0, |i| f64::from(change[i].abs())))
    }

    /// Displacement of every node under the pressures of a contact set.
    pub(crate) fn apply(&mut self, contact: &NodeSet, values: &[f64]) -> Result<&[f64], Error> {
        contact.spread(values, &mut self.pressure);
        self.convolve(None, sum(values))
    }

    /// Displacement of every node under a pressure field.
    pub(crate) fn apply_field(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        self.convolve(Some(pressure), sum(pressure))
    }

    /// Convolves a field, the operator's own if none is given, of the sum `total`.
    fn convolve(&mut self, pressure: Option<&[f64]>, total: f64) -> Result<&[f64], Error> {
        self.convolutions += 1;
        let pressure = pressure.unwrap_or(&self.pressure);
        self.convolution.apply(pressure, &mut self.displacement)?;
        self.shift(total);
        Ok(&self.displacement)
    }

    /// Adds the uniform displacement under pressures of the sum `total`.
    fn shift(&mut self, total: f64) {
        if self.uniform != 0.0 {
            let everywhere = self.uniform * total;
            for value in &mut self.displacement {
                *value += everywhere;
            }
        }
    }
}
