//! The operator of a contact and its preconditioner.

use std::borrow::Cow;

use crate::contact::ContactSequence;
#[cfg(test)]
use crate::krylov::worst;
use crate::krylov::{
    Directions, Equation, Field, LinearSystem, NodeSet, Operator, Preconditioner, SINGLE, dot,
};
use crate::{Error, Problem};

/// The influence matrix of a contact set, and what approximates its inverse.
#[derive(Debug, Clone)]
pub(super) struct Solver {
    operator: Operator,
    preconditioner: Preconditioner,
    set: NodeSet,
}

impl Solver {
    pub(super) fn new(problem: &Problem) -> Self {
        Self {
            operator: Operator::new(problem.convolution()),
            preconditioner: Preconditioner::new(problem.table()),
            set: NodeSet::new(problem.grid().nodes()),
        }
    }

    /// Number of convolutions so far.
    pub(super) fn convolutions(&self) -> usize {
        self.operator.convolutions()
    }

    /// The contact set.
    pub(super) fn set(&self) -> &NodeSet {
        &self.set
    }

    /// Makes the set the first `count` nodes of a contact.
    pub(super) fn choose(&mut self, contact: &ContactSequence, count: usize) {
        let mut is_in = vec![false; self.set.places().len()];
        for &node in &contact.order()[..count] {
            is_in[node] = true;
        }
        if self.set.assign(|node| is_in[node]) {
            self.preconditioner.update(&self.set);
        }
    }

    /// The contact that the coarse matrix of the preconditioner was computed for.
    pub(super) fn coarse_nodes(&self) -> &[u32] {
        self.preconditioner.coarse_nodes()
    }

    /// Makes the set a whole contact, with the coarse matrix of another set as long as that serves.
    pub(super) fn recall(&mut self, contact: &ContactSequence, coarse: &NodeSet) {
        self.set.assign(|node| contact.contains(node));
        self.preconditioner.recall(coarse, &self.set);
    }

    /// The search directions on the set with these values.
    pub(super) fn recall_directions(
        &mut self,
        values: impl Iterator<Item = Vec<f32>>,
        marks: [usize; 2],
    ) -> Result<Directions, Error> {
        Directions::recall(&mut self.operator, &self.set, values, marks)
    }

    /// `Ok` if displacements, where they are known, are those of the pressures of their field, to an error.
    pub(super) fn check(&mut self, field: &Field, most: f64) -> Result<(), Error> {
        if !field.is_known() {
            return Ok(());
        }
        let expected = self.operator.apply_field(&field.pressure)?;
        let pairs = expected.iter().zip(&field.displacement);
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, |worst: f64, error| {
            // NaN is none either.
            if worst.is_nan() || error <= worst { worst } else { error }
        });
        let is_theirs = worst <= most;
        let quantity = "error of the displacements where a window ends";
        Error::require(quantity, worst, is_theirs, "that of a solution")?;
        Ok(())
    }

    /// Computes the displacements of a field, unless they are known.
    pub(super) fn complete(&mut self, field: &mut Field) -> Result<(), Error> {
        if !field.is_known() {
            field.displacement = self.operator.apply_field(&field.pressure)?.to_vec();
            field.drift = 0.0;
        }
        Ok(())
    }

    /// A field with other pressures, on any nodes; what the change displaces comes to displacements that are known, in
    /// single precision.
    pub(super) fn moved(&mut self, field: &Field, pressure: Vec<f64>) -> Result<Field, Error> {
        if !field.is_known() {
            return Ok(Field::of(pressure));
        }
        let mut changed = NodeSet::new(pressure.len());
        changed.assign(|node| pressure[node] != field.pressure[node]);
        let mut change = Vec::new();
        changed.fill(&mut change, |_, node| pressure[node] - field.pressure[node]);
        let mut displacement = field.displacement.clone();
        let most = self.operator.add(&changed, &change, &mut displacement)?;
        let norm = self.operator.noise() * dot(&change, &change).sqrt();
        let drift = field.drift.hypot((SINGLE * most).hypot(SINGLE * norm));
        Ok(Field { pressure, displacement, drift })
    }

    /// Solves an equation: see [`LinearSystem::solve`].
    pub(super) fn solve<F: Fn(usize) -> f64 + Sync + Send>(
        &mut self,
        equation: &Equation<F>,
        start: Vec<f64>,
        base: Cow<'_, Field>,
        directions: &mut Directions,
    ) -> Result<Field, Error> {
        let mut system = LinearSystem {
            operator: &mut self.operator,
            preconditioner: &mut self.preconditioner,
            contact: &self.set,
        };
        let (field, _) = system.solve(equation, start, base, directions)?;
        Ok(field)
    }
}

#[cfg(test)]
mod tests;
