//! Paths on nodes in a row, whose numbers can be worked out by hand: see [`row`](crate::row).

use super::run::LoadingRun;
use super::solver::LoadingSolver;
use crate::contact::ContactSequence;
use crate::updater::{
    Dense, LinearUpdater, Schur, Solution, SolveRequest, Touched, UpdaterProfile,
};
use crate::{Error, Problem, row};

/// The rooms of a path that has not begun.
pub(super) fn run<U: LinearUpdater>(gaps: &[f64], updater: U) -> Result<LoadingRun<U>, Error> {
    let (surface, kernel) = (row::surface(gaps)?, row::kernel(gaps.len())?);
    let builder = LoadingSolver::builder(&surface, &kernel).updater(updater);
    Ok(builder.build()?.run)
}

/// The rooms of a path with nodes in contact, solved at an approach.
pub(super) fn solved(
    gaps: &[f64],
    contact: &[usize],
    approach: f64,
) -> Result<LoadingRun<Dense>, Error> {
    let mut run = run(gaps, Dense)?;
    for &node in contact {
        run.contact.push(node)?;
    }
    run.front.place_at(approach);
    run.solve_field(approach, f64::INFINITY)?;
    Ok(run)
}

/// An updater that gives one answer to all questions, and says of itself that it is not exact.
pub(super) struct Given {
    pub(super) pressure: Vec<f64>,
    pub(super) rate: Vec<f64>,
}

impl LinearUpdater for Given {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        Dense.watch(problem, contact, nodes, schur)
    }

    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &Touched) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        _: &Problem,
        _: &ContactSequence,
        _: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        solution.pressure.clone_from(&self.pressure);
        solution.rate.clone_from(&self.rate);
        Ok(())
    }

    fn profile(&self) -> UpdaterProfile {
        UpdaterProfile {
            exact: false,
            ..Dense.profile()
        }
    }
}

/// Dense solutions of an updater that says of itself that it leaves a millionth of the approach.
pub(super) struct Inexact;

impl LinearUpdater for Inexact {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        Dense.watch(problem, contact, nodes, schur)
    }

    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &Touched) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        Dense.solve(problem, contact, request, solution)
    }

    fn truncate(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
        Ok(())
    }

    fn profile(&self) -> UpdaterProfile {
        UpdaterProfile {
            exact: false,
            tolerance: 1e-6,
            ..Dense.profile()
        }
    }
}
