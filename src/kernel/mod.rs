//! How the elastic body answers: influence coefficients.
//!
//! | kernel | boundary | a cell's displacement |
//! |---|---|---|
//! | [`Boussinesq`] | free | exact for uniform pressure on each cell |
//! | [`PeriodicBoussinesq`] | periodic | exact for uniform pressure on each cell |
//! | [`SemiPeriodicBoussinesq`] | periodic in one direction | exact for uniform pressure on each cell |
//! | [`Spectral`] | periodic | the waves of the grid only, as in spectral codes |
//! | [`Layered`] | either | coats, thin and graded bodies: a [`LayeredBody`] |
//! | [`KernelTable`] | either | given by coefficients, or by a symbol |
//!
//! A body of your own implements [`InfluenceKernel`]; [`check()`] tests what it promises.

mod boundary;
mod boussinesq;
mod check;
mod gauge;
mod gauss;
mod growth;
mod influence;
mod layered;
mod layering;
mod mean;
mod origin;
mod periodic;
mod table;

pub use boundary::Boundary;
pub use boussinesq::Boussinesq;
pub use check::{KernelReport, check};
pub(crate) use gauge::Gauge;
pub(crate) use gauss::FOUR;
pub use growth::ContactGrowth;
pub use influence::InfluenceKernel;
pub(crate) use layered::Below;
pub use layered::{Base, Layer, Layered, LayeredBody};
pub use layering::{Layering, Theory};
pub use mean::MeanDisplacement;
pub use origin::KernelOrigin;
pub use periodic::{PeriodicBoussinesq, SemiPeriodicBoussinesq, Spectral};
pub(crate) use periodic::{check_periodic_cells, sinc};
pub(crate) use table::Blocks;
pub use table::KernelTable;
