//! The fluid, and the direction in which it is pressed through.

use nalgebra::DMatrix;

use super::Leak;
use crate::surface::Axis;
use crate::updater::LinearUpdater;
use crate::{Boundary, Error, Grid, LoadingSolver, LoadingState};

/// A fluid before one edge of the grid, pressed through the gap to the opposite one.
///
/// See the [module](super) for the equation, and for an example.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seal {
    viscosity: f64,
    pressure_drop: f64,
    along: Axis,
}

impl Seal {
    /// A fluid of the viscosity η \[Pa s\] under the pressure drop Δp \[Pa\] from the lower end of an axis to the upper one.
    ///
    /// # Errors
    ///
    /// [`Error::NotPositive`] for either.
    pub fn new(viscosity: f64, pressure_drop: f64, along: Axis) -> Result<Self, Error> {
        Ok(Self {
            viscosity: Error::require_positive("viscosity", viscosity)?,
            pressure_drop: Error::require_positive("pressure drop", pressure_drop)?,
            along,
        })
    }

    /// Viscosity \[Pa s\].
    #[must_use]
    pub fn viscosity(&self) -> f64 {
        self.viscosity
    }

    /// Pressure drop \[Pa\].
    #[must_use]
    pub fn pressure_drop(&self) -> f64 {
        self.pressure_drop
    }

    /// Where the fluid is pressed along.
    #[must_use]
    pub fn along(&self) -> Axis {
        self.along
    }

    /// The conductivity g³/12η \[m³/(Pa s)\] of a gap.
    pub(super) fn conductivity(&self, gap: f64) -> Result<f64, Error> {
        // Two factors of the cube beside the viscosity: the cube alone may be too small.
        Error::require_positive(
            "conductivity of the greatest gap",
            gap * gap / 12.0 / self.viscosity * gap,
        )
    }

    /// The leak through a gap \[m\], where nothing flows through nodes in contact. The sides are open to each other on a periodic
    /// boundary, and closed on a free one.
    ///
    /// A gap that is not positive is closed as well, and so is one below 10⁻¹² of the greatest. It takes some 1 s and 220 MB on
    /// 512 × 512 nodes, 7 s and 1 GB on 1024 × 1024; above that memory is proportional to the grid, as far as iterations converge.
    ///
    /// # Errors
    ///
    /// [`Error::GridMismatch`] for a field of another shape; [`Error::FieldNotFinite`]; [`Error::OutOfRange`] for nodes out of contact that
    /// overlap by more than 10⁻⁴ of the greatest gap, for cells more than 10⁶ times as long as wide, and for leak rates
    /// that over- or underflow; [`Error::NotPositive`] for such a conductivity; [`Error::NoConvergence`].
    pub fn leak(
        &self,
        gap: &DMatrix<f64>,
        contact_map: &DMatrix<bool>,
        on: (&Grid, Boundary),
    ) -> Result<Leak, Error> {
        Leak::new(self, gap, contact_map, on)
    }

    /// The leak at any state of a path up to the present one.
    ///
    /// # Errors
    ///
    /// Those of [`LoadingSolver::gap_at`] and of [`Self::leak`].
    pub fn leak_at<U: LinearUpdater>(
        &self,
        path: &mut LoadingSolver<U>,
        state: &LoadingState,
    ) -> Result<Leak, Error> {
        let gap = path.gap_at(state)?;
        let contact_map = path.contact_map_at(state)?;
        let on = (&path.grid(), path.problem().boundary());
        self.leak(&gap, &contact_map, on)
    }
}
