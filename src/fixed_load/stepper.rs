//! From state to state.

use super::active_set::ActiveSet;
use super::continuation::Continuation;
use super::hardness::{Round, Yielded};
use super::hierarchy::Hierarchy;
use super::iterate::Criteria;
use super::level::{Level, Prescribed};
use super::plateau::Plateau;
use super::settings::Settings;
use super::solution::{FixedLoadSolution, SolverEffort};
use super::tangent::Tangent;
use super::tuning::{DECIDED, LOOSEST_COUNT, LOOSEST_DECIDED};
use crate::contact::ContactState;
use crate::hardness::Hardness;
use crate::parallel::inside;
use crate::{Error, Grid};

/// Solves for one state after the other: from the last one if it is near, else from coarser grids.
#[derive(Debug)]
pub(super) struct Stepper<'a> {
    settings: &'a Settings,
    /// Greatest error of a solution: that of the settings, or less where nodes are counted.
    tolerance: f64,
    /// The same at present: less where that does not decide which nodes yield.
    present_tolerance: f64,
    hierarchy: &'a mut Hierarchy,
    hardness: Option<&'a Hardness>,
    continuation: Continuation,
    /// The state that the finest grid holds, if it holds one.
    last: Option<ContactState>,
    /// The nodes that have yielded there; none without a hardness.
    yielded: Vec<bool>,
    /// Steps of conjugate gradients on the finest grid towards the next state, in vain or not.
    iterations: usize,
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
        let continuation = Continuation::default();
        let tolerance = settings.tolerance;
        let (last, yielded, iterations) = (None, Vec::new(), 0);
        Self {
            settings,
            tolerance,
            present_tolerance: tolerance,
            hierarchy,
            hardness,
            continuation,
            last,
            yielded,
            iterations,
        }
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
        let has_hardness = solution.contact.plastic.is_some();
        let yielded = has_hardness.then(|| solution.fields.yielded_map.as_slice());
        if !matches_hardness(solution, yielded, hardness) {
            return Ok(Self::new(settings, hierarchy, hardness));
        }
        let iterate = &mut finest.iterate;
        iterate.pressure.copy_from_slice(solution.fields.pressure.as_slice());
        iterate.approach = solution.contact.approach;
        let gaps = finest.gap.iter().zip(&solution.fields.displacement);
        for (total_gap, (gap, displacement)) in iterate.total_gap.iter_mut().zip(gaps) {
            *total_gap = gap + displacement;
        }
        let mut stepper = Self::new(settings, hierarchy, hardness);
        stepper.yielded = yielded.unwrap_or_default().to_vec();
        let tangent = Tangent::of(&mut stepper.hierarchy.finest, solution)?;
        stepper.continuation = Continuation::new(tangent);
        stepper.last = Some(solution.contact);
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
        self.tolerance
    }

    /// No looser tolerance from now on than one that tells how many nodes are in contact.
    pub(super) fn count_nodes(&mut self) {
        self.tolerance = self.tolerance.min(LOOSEST_COUNT);
        self.present_tolerance = self.tolerance;
    }

    /// Contact under the load `load` \[N\].
    pub(super) fn step_to_load(&mut self, load: f64) -> Result<FixedLoadSolution, Error> {
        let load = Error::require_positive("load", load)?;
        let cell = self.finest().cell_response();
        let sum = load / self.finest().grid.cell_area();
        cell.check(cell.displacement(sum))?;
        if let Some(hardness) = self.hardness {
            hardness.check(load, &self.finest().grid)?;
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

    /// Whether an approach has to be found by loads: where the mean displacement is arbitrary, nodes may yield in an
    /// elastic solution at an approach of mean planes that do not in the end.
    pub(super) fn finds_approach(&self) -> bool {
        self.hardness.is_some() && self.finest().gauge.is_some()
    }

    /// Greatest error of the gaps of a state that was found under its load.
    pub(super) fn gap_error(&self, state: &ContactState) -> f64 {
        let sum = state.load / self.finest().grid.cell_area();
        self.criteria(Prescribed::Sum(sum)).gap_error(state.approach)
    }

    /// When a solution on the finest grid is good enough.
    fn criteria(&self, prescribed: Prescribed) -> Criteria {
        Criteria {
            tolerance: self.present_tolerance,
            floor: self.finest().least_length(prescribed),
            length: f64::INFINITY,
            max_iterations: self.settings.max_iterations,
            verify: true,
        }
    }

    /// Solves on the finest grid from its iterate: see [`ActiveSet::solve`].
    fn solve(&mut self, prescribed: Prescribed, prediction: bool) -> Result<(), Error> {
        let criteria = self.criteria(prescribed);
        let finest = &mut self.hierarchy.finest;
        let solved = inside(|| ActiveSet::new(finest, prescribed, criteria).solve(prediction));
        if let Ok(iterations) | Err(Error::NoConvergence { iterations, .. }) = &solved {
            self.iterations += iterations;
        }
        solved.map(drop)
    }

    /// The same from coarser grids.
    fn solve_afresh(&mut self, prescribed: Prescribed) -> Result<(), Error> {
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
        self.iterations = 0;
        if let Some(hardness) = self.hardness {
            let found = self.yield_to(hardness, prescribed, sum);
            self.present_tolerance = self.tolerance;
            self.yielded = found?;
            return self.solution(load);
        }
        // After an error the finest grid holds no state.
        let is_near = self.last.take().is_some() && Continuation::reaches(self.finest(), sum);
        if is_near {
            self.continuation.predict(&mut self.hierarchy.finest, sum);
            match self.solve(prescribed, true) {
                // A state is no good start where the next one is nothing like it.
                Err(Error::NoConvergence { .. }) => self.solve_afresh(prescribed)?,
                solved => solved?,
            }
        } else {
            self.solve_afresh(prescribed)?;
        }
        self.solution(load)
    }

    /// Contact with a hardness: which nodes have yielded. Nodes that yield and recover in turns within a loose
    /// tolerance do not within a stricter one.
    fn yield_to(
        &mut self,
        hardness: &'a Hardness,
        prescribed: Prescribed,
        sum: f64,
    ) -> Result<Vec<bool>, Error> {
        let mut open = None;
        loop {
            let decision = self.yield_within_tolerance(hardness, prescribed, sum);
            match (decision, open) {
                (Ok(Decision::Made(yielded)), _) => return Ok(yielded),
                (Ok(Decision::Open { residual }), _)
                    if self.present_tolerance > LOOSEST_DECIDED =>
                {
                    open = open.or(Some(residual));
                    self.present_tolerance *= DECIDED;
                }
                (Ok(Decision::Open { residual }), None)
                | (Ok(Decision::Open { .. }) | Err(Error::NoConvergence { .. }), Some(residual)) => {
                    return Err(Error::NoConvergence {
                        residual,
                        tolerance: self.tolerance,
                        iterations: self.iterations,
                    });
                }
                (Err(error), _) => return Err(error),
            }
        }
    }

    /// The same within the present tolerance.
    fn yield_within_tolerance(
        &mut self,
        hardness: &'a Hardness,
        prescribed: Prescribed,
        sum: f64,
    ) -> Result<Decision, Error> {
        if let Some(mut yielded) = self.yielded_before(hardness, prescribed, sum)? {
            match self.rounds(&mut yielded, prescribed, false) {
                Ok(None) => return self.made(yielded),
                Ok(Some(_)) | Err(Error::NoConvergence { .. }) => {
                    yielded.abandon(&mut self.hierarchy.finest);
                }
                Err(error) => {
                    yielded.abandon(&mut self.hierarchy.finest);
                    return Err(error);
                }
            }
        }
        let mut yielded = Yielded::none(hardness, &self.hierarchy.finest, prescribed);
        let rounds = self.solve_afresh(prescribed);
        match rounds.and_then(|()| self.rounds(&mut yielded, prescribed, true)) {
            Ok(None) => self.made(yielded),
            Ok(Some(residual)) => {
                yielded.abandon(&mut self.hierarchy.finest);
                Ok(Decision::Open { residual })
            }
            Err(error) => {
                yielded.abandon(&mut self.hierarchy.finest);
                Err(error)
            }
        }
    }

    fn made(&mut self, yielded: Yielded<'_>) -> Result<Decision, Error> {
        Ok(Decision::Made(yielded.finish(&mut self.hierarchy.finest)?))
    }

    /// The nodes that had yielded at the last state, with its pressures moved to the sum `sum` on the finest grid.
    /// `None` if there is no such state near, or if load or approach fall: then nodes that had yielded may be elastic.
    fn yielded_before(
        &mut self,
        hardness: &'a Hardness,
        prescribed: Prescribed,
        sum: f64,
    ) -> Result<Option<Yielded<'a>>, Error> {
        // After an error the finest grid holds no state.
        let (last, earlier) = (self.last.take(), std::mem::take(&mut self.yielded));
        let grows = last.is_some_and(|last| match prescribed {
            Prescribed::Sum(sum) => sum * self.finest().grid.cell_area() >= last.load,
            Prescribed::Approach(approach) => approach >= last.approach,
        });
        if !(grows && Continuation::reaches(self.finest(), sum)) {
            return Ok(None);
        }
        self.continuation.predict(&mut self.hierarchy.finest, sum);
        let finest = &mut self.hierarchy.finest;
        Yielded::resume(hardness, finest, prescribed, &earlier).map(Some)
    }

    /// Elastic solutions of the nodes that have not yielded, until no more does; the first one may be there. Returns a
    /// residual if the tolerance does not decide which nodes yield.
    fn rounds(
        &mut self,
        yielded: &mut Yielded<'_>,
        prescribed: Prescribed,
        mut is_solved: bool,
    ) -> Result<Option<f64>, Error> {
        loop {
            let criteria = self.criteria(prescribed);
            let finest = &mut self.hierarchy.finest;
            if is_solved {
                let allowed = criteria.gap_error(finest.iterate.approach);
                match yielded.revise(finest, allowed)? {
                    Round::Settled => match prescribed {
                        Prescribed::Sum(sum) if yielded.exhaust(finest, sum)? => {}
                        _ => return Ok(None),
                    },
                    Round::Changed => {}
                    Round::Undecided => return Ok(Some(f64::INFINITY)),
                }
            }
            let rest = match prescribed {
                Prescribed::Sum(sum) => match yielded.rest(sum) {
                    Some(rest) => Prescribed::Sum(rest),
                    None => {
                        let overlap = yielded.begin_plateau(finest);
                        let approach = finest.iterate.approach;
                        let is_one = overlap <= criteria.gap_error(approach);
                        return Ok((!is_one).then(|| overlap / approach));
                    }
                },
                approach @ Prescribed::Approach(_) => approach,
            };
            is_solved = true;
            if let Prescribed::Approach(approach) = rest
                && finest.gap.iter().all(|gap| *gap >= criteria.deepest(approach))
            {
                // All that is in contact has yielded, or touches and carries nothing.
                finest.iterate.pressure.fill(0.0);
                finest.iterate.total_gap.copy_from_slice(&finest.gap);
                finest.iterate.approach = approach;
                continue;
            }
            rest.scale(&mut finest.iterate.pressure);
            self.solve(rest, false)?;
        }
    }

    /// The plateaus on which the nodes in contact of a solution, or those of them that have yielded, carry their
    /// hardness and no other anything.
    pub(super) fn plateaus_of(
        &mut self,
        solution: &FixedLoadSolution,
    ) -> Result<Vec<Plateau>, Error> {
        let (Some(hardness), Some(_)) = (self.hardness, &solution.contact.plastic) else {
            return Ok(Vec::new());
        };
        let finest = &mut self.hierarchy.finest;
        let mut all = Vec::new();
        for set in [&solution.fields.yielded_map, &solution.fields.contact_map] {
            all.extend(Plateau::of(hardness, finest, set.as_slice().to_vec())?);
        }
        Ok(all)
    }

    /// The load of a plateau \[N\].
    pub(super) fn load_of(&self, plateau: &Plateau) -> f64 {
        plateau.sum * self.finest().grid.cell_area()
    }

    /// Contact at an approach on a plateau.
    pub(super) fn rest_on(
        &mut self,
        plateau: Plateau,
        approach: f64,
    ) -> Result<FixedLoadSolution, Error> {
        let load = self.load_of(&plateau);
        let finest = &mut self.hierarchy.finest;
        finest.iterate.pressure = plateau.pressure;
        finest.iterate.approach = approach;
        finest.refresh()?;
        self.yielded = plateau.yielded;
        self.iterations = 0;
        self.solution(Some(load))
    }

    /// The solution that the finest grid holds.
    fn solution(&mut self, load: Option<f64>) -> Result<FixedLoadSolution, Error> {
        let (convolutions, coarse_convolutions) = self.hierarchy.take_convolutions();
        let effort = SolverEffort {
            iterations: self.iterations,
            stiffness_iterations: 0,
            convolutions,
            coarse_convolutions,
        };
        let finest = &mut self.hierarchy.finest;
        let yielded = self.hardness.map(|hardness| (hardness.values(), &self.yielded[..]));
        let mut solution = FixedLoadSolution::of(finest, load, effort, yielded);
        if self.settings.stiffness {
            let tangent = &mut self.continuation.tangent;
            tangent.complete(finest, self.settings, &mut solution)?;
        }
        solution.check_finite(&finest.grid)?;
        self.last = Some(solution.contact);
        Ok(solution)
    }
}

/// Which nodes have yielded.
enum Decision {
    Made(Vec<bool>),
    /// Nodes yield and recover in turns, or overlap on a plateau by so much of the approach.
    Open {
        residual: f64,
    },
}

/// Whether a solution, in which nodes may have yielded, can be one with a hardness.
fn matches_hardness(
    solution: &FixedLoadSolution,
    yielded: Option<&[bool]>,
    hardness: Option<&Hardness>,
) -> bool {
    let (Some(yielded), Some(hardness)) = (yielded, hardness) else {
        return yielded.is_none() && hardness.is_none();
    };
    let nodes = yielded.iter().zip(&solution.fields.pressure).zip(hardness.values());
    yielded.len() == solution.fields.pressure.len()
        && nodes.into_iter().all(|((has_yielded, p), h)| !has_yielded || p == h)
}

/// `Ok` if this can be a solution on `grid`: its fields are public.
fn check(solution: &FixedLoadSolution, grid: &Grid) -> Result<(), Error> {
    for field in [&solution.fields.pressure, &solution.fields.displacement] {
        grid.check_shape(field.shape())?;
    }
    solution.check_finite(grid)?;
    let state = &solution.contact;
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
