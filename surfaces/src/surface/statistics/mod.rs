//! Statistics of a map: what its roughness is described by.
//!
//! Heights are in [`HeightMap`](super::HeightMap), whose statistics need no lengths; what needs them is here, as
//! methods of [`Topography`](super::Topography):
//!
//! * texture by ISO 25178-2: skewness, developed area, autocorrelation, core and peaks of the material ratio curve;
//! * from differences between nodes, for any map: slopes, gradient, Laplacian, curvature;
//! * from the waves of a periodic map, or of one that a window was put on: the same, spectral moments, power spectral
//!   densities, a fit of a self-affine spectrum, and the pressure of full contact.

mod areal;
mod differences;
mod fit;
#[cfg(test)]
mod foreign_tests;
mod full_contact;
mod material_ratio;
mod moments;
mod power;
mod profile;
#[cfg(test)]
mod tests;

pub use self::areal::ArealParameters;
pub use self::fit::{Estimate, SelfAffineFit};
pub use self::material_ratio::{CoreParameters, MaterialRatio};
pub use self::moments::SpectralMoments;
pub use self::power::{RadialBins, SpectralBin};
pub use self::profile::ProfileParameters;
