//! Paths on nodes in a row, whose numbers can be worked out by hand: see [`row`](crate::test_chain).

use super::run::LoadingRun;
use super::solver::LoadingSolver;
use crate::contact::ContactSequence;
use crate::updater::{
    Dense, LinearUpdater, Schur, Solution, SolveRequest, WindowFactor, UpdaterProfile,
};
use crate::{Error, Problem, row};

/// The rooms of a path that has not begun.
pub(super) fn run<U: LinearUpdater>(gaps: &[f64], updater: U) -> Result<LoadingRun<U>, Error> {
    let (surface, kernel) = (test_chain::surface(gaps)?, test_chain::kernel(gaps.len())?);
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

/// A dense updater whose answers are changed on their way.
pub(super) struct Altered {
    complement: Box<dyn Fn(&mut Schur)>,
    solution: Box<dyn Fn(&mut Solution)>,
    profile: UpdaterProfile,
}

impl Altered {
    /// Nothing is changed; it is not exact, and leaves `tolerance`.
    pub(super) fn inexact(tolerance: f64) -> Self {
        Self {
            complement: Box::new(|_| {}),
            solution: Box::new(|_| {}),
            profile: UpdaterProfile {
                exact: false,
                tolerance,
                ..Dense.profile()
            },
        }
    }

    /// One answer to all questions, which says of itself that it is not exact.
    pub(super) fn given(pressure: Vec<f64>, rate: Vec<f64>) -> Self {
        Self {
            solution: Box::new(move |solution| {
                solution.pressure.clone_from(&pressure);
                solution.rate.clone_from(&rate);
            }),
            ..Self::inexact(Dense.profile().tolerance)
        }
    }

    /// Other solutions, which claim to be exact.
    pub(super) fn solutions(solution: impl Fn(&mut Solution) + 'static) -> Self {
        Self {
            solution: Box::new(solution),
            profile: Dense.profile(),
            ..Self::inexact(0.0)
        }
    }

    /// Other Schur complements, which do not claim to be exact.
    pub(super) fn estimates(tolerance: f64, complement: impl Fn(&mut Schur) + 'static) -> Self {
        Self {
            complement: Box::new(complement),
            ..Self::inexact(tolerance)
        }
    }

    /// Other Schur complements, which claim to be exact.
    pub(super) fn complements(complement: impl Fn(&mut Schur) + 'static) -> Self {
        Self {
            complement: Box::new(complement),
            profile: Dense.profile(),
            ..Self::inexact(0.0)
        }
    }
}

impl LinearUpdater for Altered {
    fn watch(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        nodes: &[usize],
        schur: &mut Schur,
    ) -> Result<(), Error> {
        Dense.watch(problem, contact, nodes, schur)?;
        (self.complement)(schur);
        Ok(())
    }

    fn join(&mut self, _: &Problem, _: &ContactSequence, _: &WindowFactor) -> Result<(), Error> {
        Ok(())
    }

    fn solve(
        &mut self,
        problem: &Problem,
        contact: &ContactSequence,
        request: SolveRequest,
        solution: &mut Solution,
    ) -> Result<(), Error> {
        Dense.solve(problem, contact, request, solution)?;
        (self.solution)(solution);
        Ok(())
    }

    fn truncate(&mut self, _: &Problem, _: &ContactSequence) -> Result<(), Error> {
        Ok(())
    }

    fn profile(&self) -> UpdaterProfile {
        self.profile
    }
}
