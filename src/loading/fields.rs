//! Fields over the whole grid, and the displacement that pressure causes.

use crate::Error;
use crate::convolution::Convolution;
use crate::updater::Solution;

/// The convolution with its buffers, reused at every refresh.
#[derive(Debug)]
pub(super) struct Fields {
    convolution: Convolution,
    pressure: [Vec<f64>; 2],
    displacement: [Vec<f64>; 2],
    /// The contact and the solution that the displacements belong to, if to any.
    known: Option<(Vec<usize>, Solution)>,
}

impl Fields {
    pub(super) fn new(convolution: Convolution, nodes: usize) -> Self {
        let field = || [vec![0.0; nodes], vec![0.0; nodes]];
        Self {
            convolution,
            pressure: field(),
            displacement: field(),
            known: None,
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        4 * self.pressure[0].len() * size_of::<f64>() + self.convolution.bytes()
    }

    /// $C_{:,I}\, y_1$ and $C_{:,I}\, y_2$ of a solution on the contact nodes.
    pub(super) fn displacements(
        &mut self,
        contact: &[usize],
        solution: &Solution,
    ) -> Result<[&[f64]; 2], Error> {
        let known = self.known.as_ref();
        if known.is_some_and(|(nodes, values)| nodes == contact && values == solution) {
            let [u1, u2] = &self.displacement;
            return Ok([u1, u2]);
        }
        self.known = None;
        for (field, values) in self.pressure.iter_mut().zip([&solution.y1, &solution.y2]) {
            field.fill(0.0);
            for (&node, &value) in contact.iter().zip(values) {
                field[node] = value;
            }
        }
        let [p1, p2] = &self.pressure;
        let [u1, u2] = &mut self.displacement;
        self.convolution.apply_two([p1, p2], [u1, u2])?;
        self.known = Some((contact.to_vec(), solution.clone()));
        Ok([u1, u2])
    }

    /// The displacement that a pressure field causes.
    pub(super) fn displacement(&mut self, pressure: &[f64]) -> Result<&[f64], Error> {
        self.known = None;
        self.convolution
            .apply(pressure, &mut self.displacement[0])?;
        Ok(&self.displacement[0])
    }
}
