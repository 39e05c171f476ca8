//! Iterations on the contact of a path: approximate Schur complements, and solutions that are as exact as the path
//! needs them.

use std::fmt::Debug;

use super::{Kept, Schur, Solution};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// A solution, and the displacements of all nodes that it causes.
#[derive(Debug, Default)]
pub(crate) struct Solved {
    pub(crate) solution: Solution,
    /// Under the pressure \[m\], and under its rate.
    pub(crate) displacement: [Vec<f64>; 2],
}

/// What nodes that have yielded displace.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Beside<'a> {
    /// Under a pressure of 1 on each of them \[m/Pa\], and under their hardness \[m\].
    pub(crate) unit: &'a [f64],
    pub(crate) load: &'a [f64],
    /// The hardness of all nodes, if that is one.
    pub(crate) hardness: Option<f64>,
    /// The row sum of all nodes of the surface, if that is one.
    pub(crate) row_sum: Option<f64>,
}

/// A state behind the last solution, when nodes may have joined and others yielded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Behind<'a> {
    /// Of the nodes that have not yielded: the displacement under the others is in its gap.
    pub(crate) problem: &'a Problem,
    /// Those in contact: first the ones that were there before, in the same order.
    pub(crate) contact: &'a ContactSequence,
    /// Nodes that have yielded since, and their pressure.
    pub(crate) yielded: &'a [(usize, f64)],
    /// What that displaces: nothing if it is empty.
    pub(crate) load: &'a [f64],
    pub(crate) approach: f64,
}

impl<'a> Behind<'a> {
    /// A contact at an approach, where no node has yielded since.
    #[must_use]
    pub(crate) fn on(problem: &'a Problem, contact: &'a ContactSequence, approach: f64) -> Self {
        Self { problem, contact, yielded: &[], load: &[], approach }
    }
}

/// What iterations say of proposed nodes.
#[derive(Debug, Default)]
pub(crate) struct Proposal {
    /// Displacement under the solution and under its rate of each node out of contact; pressure and rate of each in
    /// contact.
    pub(crate) lines: Vec<[f64; 2]>,
    /// What a pressure on a node out of contact, or a gap of one in it, adds to sums over all nodes: of gaps out of
    /// contact, of plastic depths, and of these times the hardness.
    pub(crate) sums: Vec<[f64; SUMS]>,
}

/// Sums over all nodes: of gaps out of contact, of plastic depths, and of these times the hardness.
pub(crate) const SUMS: usize = 3;

/// Iterations on a contact that grows.
pub(crate) trait Iterations: Debug + Send + Sync {
    /// Greatest gap in contact that a solution leaves, relative to the approach.
    fn tolerance(&self) -> f64;

    /// Goes on from a contact and the solution on it.
    fn take_over(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        solution: &Solution,
    ) -> Result<(), Error>;

    /// All on which later answers depend besides problem and contact, as plain numbers, at the end of a window of a path
    /// on which nodes may yield or not; `None` if these iterations cannot be restored from there.
    fn keep(&self, problem: &Problem, contact: &ContactSequence, may_yield: bool) -> Option<Kept> {
        let _ = (problem, contact, may_yield);
        None
    }

    /// Goes on from such numbers, bit for bit. Returns whether it does: other iterations may have kept them.
    fn restore(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        kept: &Kept,
    ) -> Result<bool, Error> {
        let _ = (problem, contact, kept);
        Ok(false)
    }

    /// Approximates the matrix M of [`LinearUpdater::watch_both`](super::LinearUpdater::watch_both) of nodes out of
    /// contact and nodes in it, which may yield, and improves what the last solution and its rate say of them: by what
    /// the residual of the solution tells. Without yielded nodes `beside` and nodes in contact it is a Schur
    /// complement.
    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: [&[usize]; 2],
        beside: Option<&Beside<'_>>,
        schur: &mut Schur,
    ) -> Result<Proposal, Error>;

    /// How the contact answers the nodes that were proposed last, nearly: for each of them nodes in contact near it,
    /// and what a unit pressure takes off them. Nothing if the iterations cannot tell: then no window is made where
    /// nodes may leave.
    fn answers(&self) -> Vec<(&[u32], &[f64])> {
        Vec::new()
    }

    /// Solves on the whole contact, which nodes may have left since the last time, and stays there. The rate is so
    /// exact that the solution keeps its tolerance over the span \[m\] that the approach goes on with it; an infinite
    /// span asks for a rate exact to rounding.
    fn advance(&mut self, behind: &Behind<'_>, span: f64, solved: &mut Solved)
    -> Result<(), Error>;

    /// Pressures, and displacements of all nodes, at a state between the last two solutions: those of nodes that have
    /// been proposed to an error of gaps \[m\] or the tolerance, whichever is greater. No rates.
    fn probe(&mut self, behind: &Behind<'_>, error: f64) -> Result<Solved, Error>;

    /// Solves on the first `count` nodes as exactly as iterations go. The solution that the path goes on with is left
    /// as it is.
    fn solve_apart(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        solution: &mut Solution,
    ) -> Result<(), Error>;

    /// Goes back to a contact that has been cut: to the solution before, if that was on it.
    fn cut(&mut self, problem: &Problem, contact: &ContactSequence) -> Result<(), Error>;

    /// Number of convolutions so far, as far as it is counted.
    fn convolutions(&self) -> usize {
        0
    }

    /// Bytes held when `contact` nodes of a grid of `nodes` are in contact.
    fn bytes(&self, nodes: usize, contact: usize) -> usize;

    /// `Ok` if a path can do with these iterations on the cells of a problem.
    fn check_cells(&self, problem: &Problem) -> Result<(), Error>;
}
