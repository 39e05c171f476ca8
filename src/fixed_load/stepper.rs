//! From state to state.

use super::active_set::ActiveSet;
use super::continuation::Continuation;
use super::hardness::Yielded;
use super::hierarchy::{Hierarchy, scale};
use super::iterate::Criteria;
use super::level::{Level, Prescribed};
use super::settings::Settings;
use super::solution::{FixedLoadSolution, SolverEffort};
use super::tangent::Tangent;
use crate::contact::ContactState;
use crate::hardness::Hardness;
use crate::parallel::inside;
use crate::{Error, Grid};

/// Solves for one state after the other: from the last one if it is near, else from coarser grids.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    settings: &'a Settings,
    hierarchy: &'a mut Hierarchy,
    hardness: Option<&'a Hardness>,
    continuation: Continuation,
    /// The state that the finest grid holds, if it holds one.
    last: Option<ContactState>,
}

impl<'a> Stepper<'a> {
    /// Knows no state yet.
    pub(super) fn new(
        settings: &'a Settings,
        hierarchy: &'a mut Hierarchy,
        hardness: Option<&'a Hardness>,
    ) -> Self {
        // What was spent before, if that ended with an error, is no part of the next solution.
        hierarchy.take_convolutions();
        Self { settings, hierarchy, hardness, continuation: Continuation::default(), last: None }
    }

    /// Begins at a solution.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`], [`Error::OutOfRange`] and [`Error::FieldNotFinite`] if that is no
    /// solution on this grid.
    pub(super) fn at(
        settings: &'a Settings,
        hierarchy: &'a mut Hierarchy,
        hardness: Option<&'a Hardness>,
        solution: &FixedLoadSolution,
    ) -> Result<Self, Error> {
        let finest = &mut hierarchy.finest;
        check(solution, &finest.grid)?;
        if hardness.is_some() || solution.plastic.is_some() {
            // Nodes that have yielded may not have at the next load.
            return Ok(Self::new(settings, hierarchy, hardness));
        }
        let iterate = &mut finest.iterate;
        iterate.pressure.copy_from_slice(solution.pressure.as_slice());
        iterate.approach = solution.state.approach;
        let gaps = finest.gap.iter().zip(&solution.displacement);
        for (total_gap, (gap, displacement)) in iterate.total_gap.iter_mut().zip(gaps) {
            *total_gap = gap + displacement;
        }
        let mut stepper = Self::new(settings, hierarchy, None);
        let tangent = Tangent::of(&mut stepper.hierarchy.finest, solution)?;
        stepper.continuation = Continuation::new(tangent);
        stepper.last = Some(solution.state);
        Ok(stepper)
    }

    /// The last state.
    pub(super) fn last(&self) -> Option<&ContactState> {
        self.last.as_ref()
    }

    /// The contact problem on the finest grid.
    pub(super) fn finest(&self) -> &Level {
        &self.hierarchy.finest
    }

    /// Greatest error of a solution.
    pub(super) fn tolerance(&self) -> f64 {
        self.settings.tolerance
    }

    /// Contact under the load `load` \[N\].
    pub(super) fn step_to_load(&mut self, load: f64) -> Result<FixedLoadSolution, Error> {
        let load = Error::require_positive("load", load)?;
        let cell = self.finest().cell_response();
        let sum = load / self.finest().grid.cell_area();
        cell.check(cell.displacement(sum))?;
        if self.greatest_load().is_some_and(|greatest| load >= greatest) {
            return Err(Error::OutOfRange {
                quantity: "load",
                value: load,
                expected: "below the hardness times the nominal area, where all nodes yield",
            });
        }
        self.to(Prescribed::Sum(sum), sum, Some(load))
    }

    /// The load that no state has \[N\], if there is a hardness.
    pub(super) fn greatest_load(&self) -> Option<f64> {
        self.hardness.map(|hardness| hardness.greatest_load(&self.finest().grid))
    }

    /// Contact at the approach `approach` \[m\].
    pub(super) fn step_to_approach(&mut self, approach: f64) -> Result<FixedLoadSolution, Error> {
        let approach = Error::require_positive("approach", approach)?;
        let finest = self.finest();
        finest.cell_response().check(approach)?;
        if finest.gauge.is_some() {
            let mean_gap = finest.mean_initial_gap();
            if approach >= mean_gap {
                return Err(Error::ApproachNotReached { approach, mean_gap });
            }
        }
        let sum = self.continuation.sum_at(finest, approach);
        self.to(Prescribed::Approach(approach), sum, None)
    }

    /// Whether an approach has to be found by loads: where the mean displacement is arbitrary, nodes may yield in an elastic solution
    /// at an approach of mean planes that do not in the end.
    pub(super) fn finds_approach(&self) -> bool {
        self.hardness.is_some() && self.finest().gauge.is_some()
    }

    /// Greatest error of the gaps of a state that was found under its load.
    pub(super) fn gap_error(&self, state: &ContactState) -> f64 {
        let sum = state.load / self.finest().grid.cell_area();
        let criteria = self.criteria(Prescribed::Sum(sum));
        criteria.tolerance * criteria.scale(state.approach)
    }

    /// When a solution on the finest grid is good enough.
    fn criteria(&self, prescribed: Prescribed) -> Criteria {
        Criteria {
            tolerance: self.settings.tolerance,
            floor: self.finest().least_length(prescribed),
            length: f64::INFINITY,
            max_iterations: self.settings.max_iterations,
            verify: true,
        }
    }

    /// Solves on the finest grid from its iterate, and returns the number of iterations: see [`ActiveSet::solve`].
    fn solve(&mut self, prescribed: Prescribed, prediction: bool) -> Result<usize, Error> {
        let criteria = self.criteria(prescribed);
        let finest = &mut self.hierarchy.finest;
        inside(|| ActiveSet::new(finest, prescribed, criteria).solve(prediction))
    }

    /// The same from coarser grids.
    fn solve_afresh(&mut self, prescribed: Prescribed) -> Result<usize, Error> {
        self.continuation = Continuation::default();
        self.hierarchy.start(prescribed, self.settings)?;
        self.solve(prescribed, false)
    }

    /// Contact where something is `prescribed` and the sum of pressures is about `sum`.
    fn to(
        &mut self,
        prescribed: Prescribed,
        sum: f64,
        load: Option<f64>,
    ) -> Result<FixedLoadSolution, Error> {
        if let Some(hardness) = self.hardness {
            let (iterations, yielded) = self.yield_to(hardness, prescribed)?;
            return self.solution(load, iterations, Some(&yielded));
        }
        // After an error the finest grid holds no state.
        let is_near = self.last.take().is_some() && Continuation::reaches(self.finest(), sum);
        let iterations = if is_near {
            self.continuation.predict(&mut self.hierarchy.finest, sum);
            match self.solve(prescribed, true) {
                // A state is no good start where the next one is nothing like it.
                Err(Error::NoConvergence { iterations, .. }) => {
                    iterations + self.solve_afresh(prescribed)?
                }
                solved => solved?,
            }
        } else {
            self.solve_afresh(prescribed)?
        };
        self.solution(load, iterations, None)
    }

    /// Contact with a hardness: the number of iterations, and which nodes have yielded.
    fn yield_to(
        &mut self,
        hardness: &Hardness,
        prescribed: Prescribed,
    ) -> Result<(usize, Vec<bool>), Error> {
        self.last = None;
        let mut yielded = Yielded::none(hardness, &self.hierarchy.finest, prescribed);
        match self.rounds(&mut yielded, prescribed) {
            Ok(iterations) => Ok((iterations, yielded.finish(&mut self.hierarchy.finest)?)),
            Err(error) => {
                yielded.abandon(&mut self.hierarchy.finest);
                Err(error)
            }
        }
    }

    /// Elastic solutions, until no more node yields.
    fn rounds(
        &mut self,
        yielded: &mut Yielded<'_>,
        prescribed: Prescribed,
    ) -> Result<usize, Error> {
        let mut iterations = self.solve_afresh(prescribed)?;
        while yielded.grow(&mut self.hierarchy.finest)? && !yielded.is_everywhere() {
            let rest = match prescribed {
                Prescribed::Sum(sum) => Prescribed::Sum(sum - yielded.sum()),
                approach @ Prescribed::Approach(_) => approach,
            };
            let finest = &mut self.hierarchy.finest;
            if let Prescribed::Approach(approach) = rest
                && finest.gap.iter().all(|gap| *gap >= approach)
            {
                // All that is in contact has yielded.
                finest.iterate.pressure.fill(0.0);
                break;
            }
            scale(&mut finest.iterate.pressure, rest);
            iterations += self.solve(rest, false)?;
        }
        Ok(iterations)
    }

    /// The solution that the finest grid holds, after so many iterations.
    fn solution(
        &mut self,
        load: Option<f64>,
        iterations: usize,
        yielded: Option<&[bool]>,
    ) -> Result<FixedLoadSolution, Error> {
        let (convolutions, coarse_convolutions) = self.hierarchy.take_convolutions();
        let effort =
            SolverEffort { iterations, stiffness_iterations: 0, convolutions, coarse_convolutions };
        let finest = &mut self.hierarchy.finest;
        let mut solution = FixedLoadSolution::of(finest, load, effort, yielded);
        if self.settings.stiffness {
            let tangent = &mut self.continuation.tangent;
            tangent.complete(finest, self.settings, &mut solution)?;
        }
        solution.check_finite(&finest.grid)?;
        self.last = Some(solution.state);
        Ok(solution)
    }
}

/// `Ok` if this can be a solution on `grid`: its fields are public.
fn check(solution: &FixedLoadSolution, grid: &Grid) -> Result<(), Error> {
    for field in [&solution.pressure, &solution.displacement] {
        grid.check_shape(field.shape())?;
    }
    solution.check_finite(grid)?;
    let state = &solution.state;
    // The shape may be the same on a grid of other cells.
    if state.contact_area != state.contact_nodes as f64 * grid.cell_area() {
        return Err(Error::OutOfRange {
            quantity: "contact area of a solution to start from",
            value: state.contact_area,
            expected: "its number of nodes in contact times the area of a cell of this grid",
        });
    }
    Ok(())
}
