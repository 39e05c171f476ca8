//! The solver.

use super::hierarchy::Hierarchy;
#[cfg(test)]
use super::level::Level;
use super::search::solve_target;
use super::settings::Settings;
use super::solution::FixedLoadSolution;
use super::stepper::Stepper;
use super::sweep::LoadSweep;
use super::tangent::Tangent;
use crate::contact::ContactTarget;
use crate::hardness::Hardness;
use crate::{Error, Grid};

/// Solves for contact under a given load or approach: see the [module](super).
///
/// ```
/// use asperity::surface::Paraboloid;
/// use asperity::{Boussinesq, FixedLoadSolver, Grid};
///
/// # fn main() -> Result<(), asperity::Error> {
/// let surface = Paraboloid::new(0.1)?;
/// let half_space = Boussinesq::new(Grid::square(64, 1e-3)?, 100e9)?;
/// let mut solver = FixedLoadSolver::builder(&surface, &half_space)
///     .tolerance(1e-10)
///     .build()?;
/// let solution = solver.solve(1.0)?;
/// assert!(solution.certificate.greatest_contact_gap <= 1e-10);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct FixedLoadSolver {
    settings: Settings,
    hierarchy: Hierarchy,
    /// The greatest pressures, if they have an end.
    hardness: Option<Hardness>,
}

impl FixedLoadSolver {
    pub(super) fn with(
        settings: Settings,
        hierarchy: Hierarchy,
        hardness: Option<Hardness>,
    ) -> Self {
        Self { settings, hierarchy, hardness }
    }

    /// The grid of surface and kernel.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.hierarchy.finest.grid
    }

    /// Bytes held at present, on all grids.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.hierarchy.bytes()
    }

    /// Contact under the load `load` \[N\].
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the load; [`Error::OutOfRange`] for one so far from the others that numbers overflow;
    /// [`Error::BeyondHardness`] for one that the hardness cannot bear; [`Error::NoConvergence`] with the best residual;
    /// [`Error::FactorizationFailed`] if the kernel is not positive definite on the contact; [`Error::MemoryBudget`] if
    /// more nodes are in contact than fit.
    pub fn solve(&mut self, load: f64) -> Result<FixedLoadSolution, Error> {
        self.stepper().step_to_load(load)
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
    /// [`Error::GridMismatch`] or [`Error::OutOfRange`] if the solution lives on another grid;
    /// [`Error::FieldNotFinite`] and [`Error::OutOfRange`] if it is not finite; and those of
    /// [`Self::solve`].
    pub fn solve_from(
        &mut self,
        solution: &FixedLoadSolution,
        load: f64,
    ) -> Result<FixedLoadSolution, Error> {
        Stepper::at(&self.settings, &mut self.hierarchy, self.hardness.as_ref(), solution)?
            .step_to_load(load)
    }

    /// Contact at the approach `approach` \[m\] from first touch; of the mean planes if the
    /// half-space is periodic and its mean displacement arbitrary, where it determines the load only
    /// below the mean initial gap. With a hardness the load is found there by solving for several.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for the approach, [`Error::ApproachNotReached`] if no load or every
    /// large one goes with it on such a half-space, and those of [`Self::solve`].
    pub fn solve_approach(&mut self, approach: f64) -> Result<FixedLoadSolution, Error> {
        self.solve_target(ContactTarget::Approach(approach))
    }

    /// Contact at a target: a load, an approach, a contact area or a mean gap. For the latter two
    /// the load is found by solving for several, each from the one before.
    ///
    /// # Errors
    ///
    /// Those of [`Self::solve`] and [`Self::solve_approach`]; [`Error::OutOfRange`] for an area fraction or a mean gap
    /// that cannot be; [`SurfaceError::LessThanOneNode`](crate::SurfaceError::LessThanOneNode); [`Error::NoConvergence`] if the load is not found, as on an
    /// ill-conditioned user-defined kernel where a loose tolerance leaves the mean gap uncertain.
    pub fn solve_target(&mut self, target: ContactTarget) -> Result<FixedLoadSolution, Error> {
        solve_target(&mut self.stepper(), target)
    }

    /// Contact at each of `targets` in turn, every state the start of the next: see [`Self::solve_from`]. Loads
    /// become targets by `loads.map(ContactTarget::Load)`.
    pub fn sweep<I>(&mut self, targets: I) -> LoadSweep<'_, I::IntoIter>
    where
        I: IntoIterator<Item = ContactTarget>,
    {
        LoadSweep::new(self.stepper(), targets.into_iter())
    }

    /// Adds the stiffnesses and the rate of pressure to a solution of this solver that was computed
    /// [without](super::FixedLoadBuilder::stiffness).
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] if the solution lives on another grid, [`Error::NotPositive`] if no node
    /// of it is in contact, [`Error::NoConvergence`], [`Error::FactorizationFailed`] if the kernel is
    /// not positive definite, and [`Error::MemoryBudget`] if more nodes are in contact than fit.
    pub fn add_stiffness(&mut self, solution: &mut FixedLoadSolution) -> Result<(), Error> {
        let fields = &solution.fields;
        // They are public.
        for shape in
            [fields.contact_map.shape(), fields.yielded_map.shape(), fields.pressure.shape()]
        {
            self.grid().check_shape(shape)?;
        }
        self.hierarchy.take_convolutions();
        let finest = &mut self.hierarchy.finest;
        Tangent::default().complete(finest, &self.settings, solution)
    }

    /// Adds the stiffnesses on unloading to a solution of this solver in which nodes have yielded:
    /// [`contact_unloading_stiffness`](crate::contact::PlasticState::contact_unloading_stiffness) and
    /// [`interfacial_unloading_stiffness`](crate::contact::PlasticState::interfacial_unloading_stiffness). Others
    /// unload as they load.
    ///
    /// # Errors
    ///
    /// Those of [`Self::add_stiffness`].
    pub fn add_unloading_stiffness(
        &mut self,
        solution: &mut FixedLoadSolution,
    ) -> Result<(), Error> {
        self.grid().check_shape(solution.fields.contact_map.shape())?;
        self.hierarchy.take_convolutions();
        let finest = &mut self.hierarchy.finest;
        Tangent::default().add_unloading(finest, &self.settings, solution)
    }

    fn stepper(&mut self) -> Stepper<'_> {
        Stepper::new(&self.settings, &mut self.hierarchy, self.hardness.as_ref())
    }
}

#[cfg(test)]
impl FixedLoadSolver {
    /// The contact problem on the finest grid, for tests of what works on it.
    pub(super) fn into_finest(self) -> Level {
        self.hierarchy.finest
    }
}
