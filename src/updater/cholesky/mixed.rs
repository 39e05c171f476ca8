//! The recursive Cholesky factorisation in mixed precision.

use std::time::Instant;

use super::RecursiveCholesky;
use super::factor::{CholeskyTimings, Factor};
use super::refinement::Refinement;
use crate::contact::ContactSequence;
use crate::updater::{LinearUpdater, Schur, Solution, Touched, UpdaterProfile, WindowCost};
use crate::{Error, Problem};

/// A [`RecursiveCholesky`] with its factor in single precision: half the memory, 2n² bytes for n nodes,
/// and products at twice the speed.
///
/// Solutions are refined to double precision: the residual `B_I − C_II Y` comes from a convolution in
/// double precision, the correction from the factor. Hence
///
/// * pressures, gaps, load and stiffness at the end of a window are as exact as with a factor in double
///   precision;
/// * between two such ends only the *changes* carry the error of a number in single precision, some 1e-7
///   of them;
/// * nodes whose contact differs by less than that in approach may touch in another order;
/// * every window is verified against the conditions of contact before its states are yielded.
///
/// Refinement costs more than it saves while the factor is small. Up to [`MixedCholesky::SINGLE_FROM`]
/// nodes in contact everything is in double precision, as in a [`RecursiveCholesky`], and takes up to
/// 17 MB; then the factor is rounded.
#[derive(Debug, Clone)]
pub struct MixedCholesky {
    /// The factor as long as it is small.
    double: Option<RecursiveCholesky>,
    /// Nodes in contact from which on it is not.
    single_from: usize,
    factor: Factor<f32>,
    refinement: Option<Refinement>,
}

impl Default for MixedCholesky {
    fn default() -> Self {
        Self::new()
    }
}

impl MixedCholesky {
    /// Nodes in contact from which on single precision pays.
    pub const SINGLE_FROM: usize = 2048;

    /// No node in contact.
    #[must_use]
    pub fn new() -> Self {
        Self::single_from(Self::SINGLE_FROM)
    }

    /// No node in contact; the factor is in single precision from `nodes` nodes on.
    #[must_use]
    pub fn single_from(nodes: usize) -> Self {
        Self {
            double: (nodes > 0).then(RecursiveCholesky::new),
            single_from: nodes,
            factor: Factor::new(),
            refinement: None,
        }
    }

    /// Where the time went so far.
    #[must_use]
    pub fn timings(&self) -> CholeskyTimings {
        let double = self.double.as_ref().map(RecursiveCholesky::timings);
        double.unwrap_or(self.factor.timings)
    }

    /// The refined solution on the whole contact.
    fn refined(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
    ) -> Result<&Refinement, Error> {
        let refinement = self
            .refinement
            .get_or_insert_with(|| Refinement::new(problem));
        refinement.refine(problem, &self.factor, contact.order(), contact.revision())?;
        Ok(refinement)
    }
}

impl LinearUpdater for MixedCholesky {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.watch(problem, contact, nodes, schur);
        }
        self.factor.scale = problem.table().self_influence().sqrt();
        self.factor.eliminate(problem, contact, nodes, schur)?;
        let [_, _, explained] = &self.refined(problem, contact)?.displacement;
        for (sum, &node) in schur.row_sums_mut().iter_mut().zip(nodes) {
            *sum = problem.row_sums()[node] - explained[node];
        }
        Ok(())
    }

    fn join(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        touched: &Touched,
    ) -> Result<(), Error> {
        let Some(double) = &mut self.double else {
            return self.factor.join(problem, contact, touched);
        };
        double.join(problem, contact, touched)?;
        if contact.len() >= self.single_from
            && let Some(double) = self.double.take()
        {
            let scale = problem.table().self_influence().sqrt();
            self.factor = double.factor.rounded(scale);
        }
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.solve(problem, contact, count, solution);
        }
        let start = Instant::now();
        let [minus_y1, y2, _] = if count < contact.len() {
            // What is known of the whole contact stays as it is.
            let mut prefix = self.refined(problem, contact)?.clone();
            prefix.truncate(count);
            let nodes = &contact.order()[..count];
            prefix.refine(problem, &self.factor, nodes, contact.revision())?;
            prefix.solution
        } else {
            self.refined(problem, contact)?.solution.clone()
        };
        solution.y1 = minus_y1.iter().map(|value| -value).collect();
        solution.y2 = y2;
        self.factor.timings.solve += start.elapsed();
        Ok(())
    }

    fn truncate(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.truncate(problem, contact);
        }
        self.factor.truncate(contact.len());
        if let Some(refinement) = &mut self.refinement {
            refinement.truncate(contact.len());
        }
        Ok(())
    }

    fn release(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        node: usize,
        position: usize,
    ) -> Result<(), Error> {
        if let Some(double) = &mut self.double {
            return double.release(problem, contact, node, position);
        }
        self.factor.release(contact, position)?;
        if let Some(refinement) = &mut self.refinement {
            refinement.forget();
        }
        Ok(())
    }

    /// A refined solution reads the factor three times, and needs nine displacements more.
    fn profile(&self) -> UpdaterProfile {
        if let Some(double) = &self.double {
            return double.profile();
        }
        UpdaterProfile {
            exact: false,
            cost: WindowCost {
                solve: 0.5,
                schur: 0.005,
                convolution: 150.0,
                most_watched: 0.08,
                multiple: 96,
            },
        }
    }

    fn bytes(&self, contact: usize, watched: usize) -> usize {
        if let Some(double) = &self.double {
            return double.bytes(contact, watched);
        }
        let fields = self.refinement.as_ref().map_or(0, Refinement::bytes);
        let vectors = Problem::RHS * (size_of::<f64>() + size_of::<f32>());
        Factor::<f32>::bytes(contact, watched)
            .saturating_add(contact.saturating_mul(vectors))
            .saturating_add(fields)
    }
}
