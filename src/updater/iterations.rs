//! Iterations on the contact of a path: approximate Schur complements, and solutions that are as exact as the path needs them.

use std::fmt::Debug;

use super::{Schur, Solution};
use crate::contact::ContactSequence;
use crate::{Error, Problem};

/// How a path uses an updater.
#[derive(Debug)]
#[doc(hidden)]
pub enum Method {
    /// For everything.
    Factor,
    /// For everything, as long as that is cheaper than iterations and fits the memory budget.
    FactorWhileItPays,
    /// Not at all: these iterations take its place.
    Iterations(Box<dyn Iterations>),
}

/// A solution, and the displacements of all nodes that it causes.
#[derive(Debug, Default)]
#[doc(hidden)]
pub struct Solved {
    pub solution: Solution,
    /// Under the pressure \[m\], and under the rate.
    pub displacement: [Vec<f64>; 2],
}

/// Iterations on a contact that grows.
#[doc(hidden)]
pub trait Iterations: Debug + Send + Sync {
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

    /// Approximates the Schur complement of nodes out of contact, and improves the displacements of these nodes under the last
    /// solution and under its rate: by what the residual of the solution tells of them.
    fn propose(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<Vec<[f64; 2]>, Error>;

    /// Solves on the whole contact, which nodes may have left since the last time, at an approach, and stays there. The rate is so exact that the solution keeps its tolerance over
    /// the span \[m\] that the approach goes on with it; an infinite span asks for a rate exact to rounding.
    fn advance(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        approach: f64,
        span: f64,
        solved: &mut Solved,
    ) -> Result<(), Error>;

    /// The displacements of all nodes when only the first `count` nodes are in contact, those of nodes that have been proposed
    /// to an error \[m\] or the tolerance, whichever is greater.
    fn probe(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        count: usize,
        approach: f64,
        error: f64,
    ) -> Result<Vec<f64>, Error>;

    /// Solves on the first `count` nodes as exactly as iterations go. The solution that the path goes on with is left as it is.
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

    /// Bytes held when `contact` nodes of a grid of `nodes` are in contact.
    fn bytes(&self, nodes: usize, contact: usize) -> usize;

    /// `Ok` if a path can do with these iterations on the cells of a problem.
    fn check_cells(&self, problem: &Problem) -> Result<(), Error>;
}
