//! The solver.

use nalgebra::DMatrix;

use super::continuation::Continuation;
use super::hierarchy::{Blocks, coarse_target};
use super::iterate::{Criteria, Effort};
use super::level::{Level, Target};
use super::solution::{FixedLoadCertificate, FixedLoadSolution, FixedLoadState};
use super::sweep::LoadSweep;
use super::tangent::Tangent;
use super::target::ContactTarget;
use crate::krylov::{dot, sum, sum_over};
use crate::parallel::inside;
use crate::{Boundary, Error, Grid, InfluenceKernel, Surface};

/// Tolerance on the coarser grids, whose solutions are but starts, relative to the approach ...
const COARSE_TOLERANCE: f64 = 1e-2;
/// ... or to so many rms heights: long waves that are wrong by more are costly on the finest grid.
const COARSE_RMS_HEIGHTS: f64 = 10.0;

/// Solves for contact under a given load or approach: see the [module](super).
#[derive(Debug, Clone)]
pub struct FixedLoadSolver<S, K> {
    pub(super) surface: S,
    pub(super) kernel: K,
    pub(super) grid: Grid,
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    pub(super) stiffness: bool,
    pub(super) rms_height: f64,
    /// Finest first.
    pub(super) levels: Vec<Level>,
}

impl<S: Surface, K: InfluenceKernel> FixedLoadSolver<S, K> {
    /// The surface.
    pub fn surface(&self) -> &S {
        &self.surface
    }

    /// The kernel.
    pub fn kernel(&self) -> &K {
        &self.kernel
    }

    /// The grid of both.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// Bytes held at present, on all grids.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.levels.iter().map(Level::bytes).sum()
    }

    /// Contact under the load `load` \[N\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the load; [`Error::NoConvergence`] with the best residual;
    /// [`Error::FactorizationFailed`] if the kernel is not positive definite on the contact.
    pub fn solve(&mut self, load: f64) -> Result<FixedLoadSolution, Error> {
        let load = Error::require_positive("load", load)?;
        let target = Target::Sum(load / self.grid.cell_area());
        self.start_cold(target, 0)?;
        self.finish(target, Some(load), false, &mut Tangent::default())
    }

    /// Contact under the load `load` \[N\], from a solution for another load.
    ///
    /// The start is the pressure that follows from the exact tangent,
    /// [`pressure_rate`](FixedLoadSolution::pressure_rate): it saves the coarser grids and some
    /// iterations. Without a stiffness the pressure is scaled. If the load is more than a quarter
    /// larger or a fifth smaller the solution is of no use, and this is [`Self::solve`].
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the solution lives on another grid, and those of [`Self::solve`].
    pub fn solve_from(
        &mut self,
        solution: &FixedLoadSolution,
        load: f64,
    ) -> Result<FixedLoadSolution, Error> {
        let load = Error::require_positive("load", load)?;
        self.grid.check_shape(solution.pressure.shape())?;
        self.grid.check_shape(solution.displacement.shape())?;
        let fine = &mut self.levels[0];
        fine.iterate
            .pressure
            .copy_from_slice(solution.pressure.as_slice());
        fine.iterate.approach = solution.state.approach;
        let gaps = fine.gap.iter().zip(&solution.displacement);
        for (closure, (gap, displacement)) in fine.iterate.closure.iter_mut().zip(gaps) {
            *closure = gap + displacement;
        }
        let mut tangent = Tangent::default();
        if !solution.pressure_rate.is_empty() {
            self.grid.check_shape(solution.pressure_rate.shape())?;
            tangent = Tangent::of(fine, solution)?;
        }
        self.next_load(&mut Continuation::new(tangent), load, true)
    }

    /// Contact under the load `load` \[N\], from the state of the finest grid if that is one and
    /// near.
    pub(super) fn next_load(
        &mut self,
        continuation: &mut Continuation,
        load: f64,
        is_state: bool,
    ) -> Result<FixedLoadSolution, Error> {
        let load = Error::require_positive("load", load)?;
        let sum = load / self.grid.cell_area();
        let near = is_state && Continuation::reaches(&self.levels[0], sum);
        if near {
            continuation.predict(&mut self.levels[0], sum);
        } else {
            *continuation = Continuation::default();
            self.start_cold(Target::Sum(sum), 0)?;
        }
        self.finish(
            Target::Sum(sum),
            Some(load),
            near,
            &mut continuation.tangent,
        )
    }

    /// Contact at each of `targets` in turn, plain numbers being loads, every state the start of the
    /// next: see [`Self::solve_from`].
    pub fn sweep<I>(&mut self, targets: I) -> LoadSweep<'_, S, K, I::IntoIter>
    where
        I: IntoIterator,
        I::Item: Into<ContactTarget>,
    {
        LoadSweep::new(self, targets.into_iter())
    }

    /// Contact at a target: a load, an approach, a contact area or a mean gap. For the latter two
    /// the load is found by solving for several, each from the one before.
    ///
    /// # Errors
    ///
    /// Those of [`Self::solve`] and [`Self::solve_approach`]; [`Error::OutOfRange`] for an area
    /// fraction or a mean gap that cannot be.
    pub fn solve_target(
        &mut self,
        target: impl Into<ContactTarget>,
    ) -> Result<FixedLoadSolution, Error> {
        self.next_target(&mut Continuation::default(), target.into(), None)
    }

    /// Contact at a target, from the `last` solution, which the finest grid holds.
    pub(super) fn next_target(
        &mut self,
        continuation: &mut Continuation,
        target: ContactTarget,
        last: Option<&FixedLoadSolution>,
    ) -> Result<FixedLoadSolution, Error> {
        match target {
            ContactTarget::Load(load) => self.next_load(continuation, load, last.is_some()),
            ContactTarget::Approach(approach) => {
                self.next_approach(continuation, approach, last.is_some())
            }
            ContactTarget::AreaFraction(fraction) => {
                let sought = self.nodes_of(fraction)?;
                self.search(continuation, sought, last)
            }
            ContactTarget::MeanGap(mean_gap) => {
                let sought = self.mean_gap_of(mean_gap)?;
                self.search(continuation, sought, last)
            }
        }
    }

    /// Contact at the approach `approach` \[m\] from first touch; of the mean planes if the
    /// half-space is periodic, where it determines the load only below the mean initial gap.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the approach, [`Error::ApproachNotReached`] if no load or every
    /// large one goes with it on a periodic half-space, and those of [`Self::solve`].
    pub fn solve_approach(&mut self, approach: f64) -> Result<FixedLoadSolution, Error> {
        self.next_approach(&mut Continuation::default(), approach, false)
    }

    /// Contact at an approach, from the state of the finest grid if that is one and near.
    fn next_approach(
        &mut self,
        continuation: &mut Continuation,
        approach: f64,
        is_state: bool,
    ) -> Result<FixedLoadSolution, Error> {
        let approach = Error::require_positive("approach", approach)?;
        let Level { boundary, gap, .. } = &self.levels[0];
        if *boundary == Boundary::Periodic {
            let mean_gap = sum(gap) / gap.len() as f64;
            if approach >= mean_gap {
                return Err(Error::ApproachNotReached { approach, mean_gap });
            }
        }
        let target = Target::Approach(approach);
        let sum = continuation.sum_at(&self.levels[0], approach);
        let near = is_state && Continuation::reaches(&self.levels[0], sum);
        if near {
            continuation.predict(&mut self.levels[0], sum);
        } else {
            *continuation = Continuation::default();
            self.start_cold(target, 0)?;
        }
        self.finish(target, None, near, &mut continuation.tangent)
    }

    /// Fills the start of `level` from the grids coarser than it.
    fn start_cold(&mut self, target: Target, level: usize) -> Result<(), Error> {
        let grid = self.levels[level].grid;
        if level + 1 < self.levels.len() {
            let coarse_grid = self.levels[level + 1].grid;
            let coarse_target = coarse_target(target, &grid, &coarse_grid);
            self.start_cold(coarse_target, level + 1)?;
            let criteria = Criteria {
                tolerance: COARSE_TOLERANCE.max(self.tolerance),
                floor: self.levels[level + 1].least_length(coarse_target),
                length: if self.rms_height > 0.0 {
                    COARSE_RMS_HEIGHTS * self.rms_height
                } else {
                    f64::INFINITY
                },
                max_iterations: self.max_iterations,
                verify: false,
            };
            // A start that is not quite what was asked for is a start.
            let coarse = &mut self.levels[level + 1];
            match inside(|| coarse.solve(coarse_target, criteria, false)) {
                Ok(_) | Err(Error::NoConvergence { .. }) => {}
                Err(error) => return Err(error),
            }
            let (fine, coarse) = self.levels.split_at_mut(level + 1);
            Blocks::new(&grid, &coarse_grid, fine[level].boundary).prolong(
                &coarse[0].iterate.pressure,
                &mut fine[level].iterate.pressure,
            );
        } else {
            let start = if let Target::Sum(_) = target {
                1.0
            } else {
                0.0
            };
            self.levels[level].iterate.pressure.fill(start);
        }
        if let Target::Sum(target) = target {
            let pressure = &mut self.levels[level].iterate.pressure;
            let factor = target / sum(pressure);
            for value in pressure {
                *value *= factor;
            }
        }
        Ok(())
    }

    /// Solves on the finest grid from the start there.
    fn finish(
        &mut self,
        target: Target,
        load: Option<f64>,
        prediction: bool,
        tangent: &mut Tangent,
    ) -> Result<FixedLoadSolution, Error> {
        let criteria = Criteria {
            tolerance: self.tolerance,
            floor: self.levels[0].least_length(target),
            length: f64::INFINITY,
            max_iterations: self.max_iterations,
            verify: true,
        };
        let fine = &mut self.levels[0];
        let effort = inside(|| fine.solve(target, criteria, prediction))?;
        let length = criteria.scale(fine.iterate.approach);
        let mut solution = self.solution(effort, load, length);
        if self.stiffness {
            self.tangent(&mut solution, tangent)?;
        }
        Ok(solution)
    }

    /// Puts everything together but the stiffnesses, with errors of gaps in units of `length`.
    fn solution(
        &mut self,
        effort: Effort,
        load_asked: Option<f64>,
        length: f64,
    ) -> FixedLoadSolution {
        let (nx, ny) = self.grid.shape();
        let nodes = self.grid.nodes();
        let fine = &mut self.levels[0];
        let pressure = DMatrix::from_column_slice(nx, ny, &fine.iterate.pressure);
        let approach = fine.iterate.approach;
        let closure = &fine.iterate.closure;
        let gap = DMatrix::from_iterator(nx, ny, closure.iter().map(|c| c - approach));
        let displacement =
            DMatrix::from_iterator(nx, ny, closure.iter().zip(&fine.gap).map(|(c, g)| c - g));
        let is_contact = pressure.map(|p| p > 0.0);

        let (p, gaps) = (pressure.as_slice(), gap.as_slice());
        // Nodes in contact have no gap but the tolerance: left out, full contact is exact.
        let outside = |node: usize, value: f64| if p[node] > 0.0 { 0.0 } else { value };
        let mean_gap = sum_over(nodes, |node| outside(node, gaps[node])) / nodes as f64;
        let cell_area = self.grid.cell_area();
        let total = sum(p);
        let load = load_asked.unwrap_or(cell_area * total);
        let contact_nodes = p.iter().filter(|p| **p > 0.0).count();
        let least_gap = gaps
            .iter()
            .zip(p)
            .filter(|(_, p)| **p == 0.0)
            .fold(f64::INFINITY, |least, (gap, _)| least.min(*gap));
        let greatest_contact_gap = gaps
            .iter()
            .zip(p)
            .filter(|(_, p)| **p > 0.0)
            .fold(0.0_f64, |most, (gap, _)| most.max(gap.abs()));
        let certificate = FixedLoadCertificate {
            complementarity: sum_over(nodes, |node| p[node] * gaps[node].abs()) / (total * length),
            least_gap: least_gap / length,
            greatest_contact_gap: greatest_contact_gap / length,
            load_error: (cell_area * total - load) / load,
        };
        let state = FixedLoadState {
            contact_nodes,
            approach,
            load,
            contact_area: contact_nodes as f64 * cell_area,
            contact_area_fraction: contact_nodes as f64 / nodes as f64,
            mean_gap,
            contact_stiffness: None,
            interfacial_stiffness: None,
            energy: 0.5 * cell_area * dot(p, displacement.as_slice()),
            max_pressure: pressure.max(),
        };
        let convolutions = self.levels[0].operator.take_convolutions();
        let coarse = self.levels[1..].iter_mut().map(|level| {
            level.operator.take_convolutions() as f64 * level.grid.nodes() as f64 / nodes as f64
        });
        let coarse_convolutions = coarse.sum();
        FixedLoadSolution {
            state,
            pressure,
            gap,
            displacement,
            contact: is_contact,
            pressure_rate: DMatrix::zeros(0, 0),
            certificate,
            iterations: effort.iterations,
            stiffness_iterations: 0,
            convolutions,
            coarse_convolutions,
        }
    }
}
