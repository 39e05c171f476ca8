//! What touches: heights of the rigid rough surface.
//!
//! * [`HeightMap`]: heights given node by node, measured or computed elsewhere.
//! * [`SelfAffine`]: random surfaces with a prescribed power spectrum.
//! * [`Paraboloid`], [`EllipticParaboloid`], [`Cylinder`], [`Cone`], [`FlatPunch`], [`Wave`],
//!   [`BiWave`]: shapes whose contact has a closed-form solution.
//! * [`Topography`]: heights with their lengths, which can be levelled, cropped, filtered, resampled
//!   and described by statistics; [`level_measured`] and [`fill_missing`] come before it.
//! * [`Sum`]: the composite roughness of two surfaces.
//! * [`Warning`]: what looks wrong with a surface.
//!
//! Only differences of height matter for contact. Heights are positive towards the half-space: the
//! highest node touches first.

mod fourier;
mod height_map;
mod missing;
mod placement;
mod self_affine;
mod shapes;
mod statistics;
mod sum;
mod topography;
mod turns;
mod warning;
mod waves;

pub use height_map::HeightMap;
pub use missing::{count_missing, fill_missing};
pub use placement::Axis;
pub use self_affine::{Amplitude, SelfAffine, Spectrum};
pub use shapes::{Cone, Cylinder, EllipticParaboloid, FlatPunch, Paraboloid};
pub use statistics::{
    ArealParameters, CoreParameters, Estimate, MaterialRatio, ProfileParameters, RadialBins,
    SelfAffineFit, SpectralBin, SpectralMoments,
};
pub use sum::Sum;
pub use topography::{
    Filter, FittedTrend, Interpolation, Topography, Trend, Window, level_measured,
};
pub use warning::Warning;
pub use waves::{BiWave, Wave};

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::{Error, Grid};

/// Relative slack of cut-off wavelengths, so that a wave or a node at one is within it however it was rounded.
const SLACK: f64 = 1e-12;

/// A rough surface: heights \[m\] on the nodes of any grid, positive towards the half-space.
pub trait Surface {
    /// Heights on `grid`, as an nx × ny matrix: element `[(ix, iy)]` belongs to node (ix, iy).
    ///
    /// x is the first index; an image `[row, column]` must be transposed.
    ///
    /// # Errors
    ///
    /// Whatever keeps the surface from being represented on this grid.
    fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error>;

    /// The composite roughness h₁ + h₂ of this surface and another.
    fn plus<B: Surface>(self, other: B) -> Sum<Self, B>
    where
        Self: Sized,
    {
        Sum { first: self, second: other }
    }
}

/// Pointers to a surface are that surface.
macro_rules! forward {
    ($($pointer:ty),*) => {$(
        impl<S: Surface + ?Sized> Surface for $pointer {
            fn heights(&self, grid: &Grid) -> Result<DMatrix<f64>, Error> {
                (**self).heights(grid)
            }
        }
    )*};
}
forward!(&S, Box<S>, Arc<S>);
