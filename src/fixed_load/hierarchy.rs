//! Nested grids: the start on a grid comes from the next coarser one.

use super::active_set::ActiveSet;
use super::budget::MemoryBudget;
use super::iterate::Criteria;
use super::level::{Level, Prescribed};
use super::settings::Settings;
use super::tuning::{COARSE_RMS_HEIGHTS, COARSE_TOLERANCE, COARSEST};
use crate::convolution::Convolution;
use crate::kernel::Blocks;
use crate::parallel::inside;
use crate::{Error, Problem};

/// The contact problem on the grid of the caller and on coarser ones.
#[derive(Debug, Clone)]
pub(super) struct Hierarchy {
    pub(super) finest: Level,
    /// Finest first.
    coarser: Vec<Coarser>,
}

/// A grid, and the blocks of nodes of the next finer one that are its nodes.
#[derive(Debug, Clone)]
struct Coarser {
    level: Level,
    blocks: Blocks,
}

impl Hierarchy {
    /// All grids of a problem, only its own unless `nested`.
    ///
    /// # Errors
    ///
    /// Those of [`Convolution::from_table`] and [`Grid::new`](crate::Grid::new).
    pub(super) fn new(
        problem: &Problem,
        nested: bool,
        memory: MemoryBudget,
    ) -> Result<Self, Error> {
        let rms_height = problem.rms_height();
        let gap = problem.initial_gap().to_vec();
        let convolution = problem.convolution();
        let finest = Level::new(problem.table(), convolution, gap, rms_height, memory);
        let mut coarser: Vec<Coarser> = Vec::new();
        let mut table = std::borrow::Cow::Borrowed(problem.table());
        loop {
            let fine = coarser.last().map_or(&finest, |coarse| &coarse.level);
            let (nx, ny) = fine.grid.shape();
            if !nested || nx.max(ny) <= COARSEST {
                return Ok(Self { finest, coarser });
            }
            let (coarse, blocks) = table.coarsened()?;
            let gap = blocks.restrict(&fine.gap);
            let convolution = Convolution::from_table(&coarse)?;
            coarser.push(Coarser {
                level: Level::new(&coarse, convolution, gap, rms_height, memory),
                blocks,
            });
            table = std::borrow::Cow::Owned(coarse);
        }
    }

    /// Fills the start of the finest grid, without a state near what is prescribed, from the coarsest
    /// grid upwards.
    ///
    /// # Errors
    ///
    /// [`Error::FactorizationFailed`] if the kernel is not positive definite, and
    /// [`Error::MemoryBudget`].
    pub(super) fn start(
        &mut self,
        prescribed: Prescribed,
        settings: &Settings,
    ) -> Result<(), Error> {
        let cell = self.finest.grid.cell_area();
        let Some(coarsest) = self.coarser.last_mut() else {
            start_uniformly(&mut self.finest, prescribed);
            return Ok(());
        };
        let level = &mut coarsest.level;
        start_uniformly(level, prescribed.on_cells(cell, level.grid.cell_area()));
        for index in (0..self.coarser.len()).rev() {
            let (finer, coarse) = self.coarser.split_at_mut(index);
            let Coarser { level, blocks } = &mut coarse[0];
            let fine = finer.last_mut().map_or(&mut self.finest, |f| &mut f.level);
            solve_roughly(level, prescribed.on_cells(cell, level.grid.cell_area()), settings)?;
            blocks.prolong(&level.iterate.pressure, &mut fine.iterate.pressure);
            let fine_cell = fine.grid.cell_area();
            prescribed.on_cells(cell, fine_cell).scale(&mut fine.iterate.pressure);
        }
        Ok(())
    }

    /// Convolutions since this was last asked: on the finest grid, and on coarser ones, each of these
    /// counted as its part of the nodes of the finest.
    pub(super) fn take_convolutions(&mut self) -> (usize, f64) {
        let nodes = self.finest.grid.nodes() as f64;
        let mut coarser = 0.0;
        for Coarser { level, .. } in &mut self.coarser {
            let part = level.grid.nodes() as f64 / nodes;
            coarser += level.operator.take_convolutions() as f64 * part;
        }
        (self.finest.operator.take_convolutions(), coarser)
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        let coarser = self.coarser.iter().map(|coarse| coarse.level.bytes());
        self.finest.bytes() + coarser.sum::<usize>()
    }
}

/// Uniform pressure of the sum that is prescribed, none if it is an approach.
fn start_uniformly(level: &mut Level, prescribed: Prescribed) {
    let pressure = &mut level.iterate.pressure;
    let value = match prescribed {
        Prescribed::Sum(target) => target / pressure.len() as f64,
        Prescribed::Approach(_) => 0.0,
    };
    pressure.fill(value);
}

/// Solves well enough for a start on the next finer grid, and where that takes too many iterations
/// leaves what they have come to. A kernel may be positive definite on the finest grid and not on this one: then
/// its start is uniform.
fn solve_roughly(
    level: &mut Level,
    prescribed: Prescribed,
    settings: &Settings,
) -> Result<(), Error> {
    let rms_height = level.scale.rms_height();
    let criteria = Criteria {
        tolerance: COARSE_TOLERANCE.max(settings.tolerance),
        floor: level.least_length(prescribed),
        length: if rms_height > 0.0 { COARSE_RMS_HEIGHTS * rms_height } else { f64::INFINITY },
        max_iterations: settings.max_iterations,
        verify: false,
    };
    match inside(|| ActiveSet::new(level, prescribed, criteria).solve(false)) {
        Ok(_) | Err(Error::NoConvergence { .. }) => Ok(()),
        Err(Error::FactorizationFailed { .. }) => {
            start_uniformly(level, prescribed);
            Ok(())
        }
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Paraboloid;
    use crate::{Boundary, Boussinesq, Grid};

    /// A convolution on a grid of a quarter of the nodes is a quarter of one, and each counts once.
    #[test]
    fn convolutions_count_by_their_nodes() -> Result<(), Error> {
        let grid = Grid::square(64, 1.0)?;
        let problem = Problem::new(&Paraboloid::new(1.0)?, &Boussinesq::new(grid, 1.0)?)?;
        let memory = MemoryBudget::new(usize::MAX, &grid, Boundary::Free, true)?;
        let mut hierarchy = Hierarchy::new(&problem, true, memory)?;
        assert_eq!(hierarchy.coarser.len(), 2);
        for _ in 0..3 {
            hierarchy.finest.refresh()?;
        }
        for level in [0, 1, 1] {
            hierarchy.coarser[level].level.refresh()?;
        }
        assert_eq!(hierarchy.take_convolutions(), (3, 1.0 / 4.0 + 2.0 / 16.0));
        assert_eq!(hierarchy.take_convolutions(), (0, 0.0));
        Ok(())
    }

    /// Whatever a solution on a coarser grid has come to, the start on the finer one has the sum.
    #[test]
    fn starts_have_the_sum() {
        let prescribed = Prescribed::Sum(6.0);
        for (mut pressure, expected) in [
            ([1.0, 2.0, 0.0], [2.0, 4.0, 0.0]),
            ([0.0; 3], [2.0; 3]),
            ([f64::NAN, 1.0, 1.0], [2.0; 3]),
            // The sum is infinite.
            ([1e308; 3], [2.0; 3]),
        ] {
            prescribed.scale(&mut pressure);
            assert_eq!(pressure, expected);
        }
        let mut pressure = [1.0, 2.0, 0.0];
        Prescribed::Approach(1.0).scale(&mut pressure);
        assert_eq!(pressure, [1.0, 2.0, 0.0]);
    }
}
