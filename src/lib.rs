//! The exact elastic loading of rough surfaces: the whole path from first touch to full contact, one state for each
//! node that joins.
//!
//! A rigid rough surface is pressed without friction into an elastic half-space. Between two events, at which a node
//! touches, everything is linear in the approach, so that the path is found by linear algebra alone: no load steps, and
//! tangent stiffnesses with every state.
//!
//! ```
//! use asperity::{Boussinesq, Grid, LoadingSolver, SelfAffine};
//!
//! # fn main() -> Result<(), asperity::Error> {
//! let half_space = Boussinesq::new(Grid::square(32, 1.25e-3)?, 115e9)?;
//! let mut path = LoadingSolver::builder(&SelfAffine::zhang2020(1), &half_space)
//!     .max_mean_pressure(100e6)
//!     .build()?;
//! for state in path.by_ref() {
//!     let state = state?;
//!     println!("{} nodes carry {} N", state.contact_nodes, state.load);
//! }
//! let pressure = path.pressure()?; // at exactly 100 MPa
//! # assert!(pressure.max() > 100e6);
//! # Ok(())
//! # }
//! ```
//!
//! # Where to find it
//!
//! | question | answer |
//! |---|---|
//! | the path, all of it | [`LoadingSolver`], an iterator of [`LoadingState`]; read it with [`loading::History`] |
//! | one load, or a sweep of loads | [`FixedLoadSolver`] |
//! | patches, percolation, leakage, distributions | [`patches`] |
//! | a file of my instrument | [`io::read_surface`], [`surface::Topography`] |
//! | my surface as numbers | [`HeightMap`], the trait [`Surface`] |
//! | keep a path, and go on from it | [`record`] |
//! | generated surfaces and shapes | [`SelfAffine`], [`surface`] |
//! | which half-space | [`Boussinesq`] for a measured or finite body, where the edge is real; [`PeriodicBoussinesq`] for a piece of a larger surface; [`Spectral`] to compare with tamaas and ContactMechanics; [`KernelTable`] for layers |
//! | my own body | the trait [`InfluenceKernel`], and [`kernel::check()`] |
//! | memory and time | [`updater`], and the trait [`LinearUpdater`] |
//! | closed forms to compare with | [`reference`](mod@reference) |
//!
//! Grids, heights, files, statistics and generators ([`surface`], [`io`]) are a crate of their own, `asperity-surfaces`, for
//! those who need no solver. All of it is exported here; its errors ([`SurfaceError`]) are [`Error::Surface`].
//!
//! # Conventions
//!
//! * **Units**: any coherent set; the documentation gives SI. `E* = E / (1 − ν²)` against a rigid body, or
//!   `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂` ([`composite_modulus`]); no factor 2.
//! * **Heights** are positive towards the half-space: the highest node touches first. Only differences count. Two rough
//!   bodies are one with the sum of their heights ([`Surface::plus`]).
//! * **Pressure** is positive in compression and never negative. **Displacement** is positive into the half-space,
//!   **gap** positive where the surfaces are apart.
//! * **Approach** δ is measured from first touch: 0 there, and growing.
//! * **State n** is the instant at which the n-th node touches; its own pressure is still zero. Stiffnesses are
//!   derivatives on further loading: `contact_stiffness` is dW/dδ (`None` where no distant point stays put, as under a
//!   periodic half-space), `interfacial_stiffness` is −dW/d(mean gap).
//! * **Area** is counted in cells, and a fraction of the nominal area runs from 0 to 1.
//! * **Arrays** are nx × ny [`nalgebra`] matrices: element `[(ix, iy)]` is the node at `x = (ix + ½) dx`,
//!   `y = (iy + ½) dy`. x is the first index; an image `[row, column]` must be transposed.
//! * **Boundary**: the kernel's. What surrounds the grid is never assumed.
//!
//! # What a path costs
//!
//! With a factor, n nodes in contact take 4n² bytes and n³/3 floating-point operations at the speed of a matrix
//! product; nodes out of contact cost little. Where that is more than iterations would take, from some 8000 nodes in
//! contact on a grid of 256 × 256, the path goes on without: memory is in proportion to the grid then, and states
//! between the exact ones carry an estimate of their error ([`loading`]). Results are the same bit for bit with any
//! number of threads, and without the feature `rayon`.
//!
//! # Limits of the model
//!
//! Elastic, frictionless, without adhesion, small slopes; unloading retraces loading. Compare the greatest pressure with
//! the hardness.

pub mod contact;
pub mod convolution;
mod doubt;
mod elasticity;
mod error;
pub mod fixed_load;
pub mod kernel;
mod krylov;
pub mod loading;
mod memory;
pub mod patches;
mod problem;
pub mod record;
pub mod reference;
#[cfg(test)]
mod row;
mod scale;
pub mod updater;

pub(crate) use asperity_surfaces::parallel;
pub use asperity_surfaces::{
    Error as SurfaceError, FileError, Grid, HeightMap, SelfAffine, Surface, io, nalgebra, surface,
};

pub use contact::{Certificate, ContactState, ContactTarget};
pub use doubt::Doubt;
pub use elasticity::{composite_modulus, plane_strain_modulus};
pub use error::{Error, KernelError, UpdaterError};
pub use fixed_load::{FixedLoadSolution, FixedLoadSolver};
pub use kernel::{
    Boundary, Boussinesq, ContactGrowth, InfluenceKernel, KernelTable, MeanDisplacement,
    PeriodicBoussinesq, Spectral,
};
pub use loading::{ContactEvent, ContactRule, LoadingSolver, LoadingState};
pub use problem::Problem;
pub use updater::{LinearUpdater, RecursiveCholesky};

/// Compiles and runs the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The same of the page that leads from a file to its contact.
#[cfg(all(doctest, feature = "io"))]
#[doc = include_str!("../docs/from_file_to_contact.md")]
struct FromFileToContact;
