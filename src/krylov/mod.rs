//! Iterations on a contact set: the influence operator, a preconditioner of two levels, one
//! of them a sparse approximation of the inverse, and conjugate gradients, all in O(grid) memory.

mod cells;
mod coarse;
mod directions;
mod lattice;
mod node_set;
mod operator;
mod pcg;
mod preconditioner;
pub(crate) mod single;
mod sparse_inverse;
mod tuning;
mod vector;

pub(crate) use cells::check_cells;
pub(crate) use directions::Directions;
pub(crate) use node_set::{Change, NodeSet};
pub(crate) use operator::Operator;
#[cfg(test)]
pub(crate) use pcg::worst;
pub(crate) use pcg::{Equation, Field, LinearSystem};
pub(crate) use preconditioner::Preconditioner;
pub(crate) use sparse_inverse::SparseInverse;
pub(crate) use tuning::SINGLE;
pub(crate) use vector::{Value, add_scaled, dot, greatest, sum, sum_over};
