//! Elastic contact of rough surfaces by the boundary element method: the exact loading path from first touch to full
//! contact, event by event, and single loads.
//!
//! A rigid rough surface is pressed without friction into an elastic half-space. The surface is a grid of rectangular
//! cells with a uniform pressure on each. An event is the instant at which one more node of the grid touches. Between
//! two events all quantities are linear in the approach, so that linear algebra alone gives the path, without load
//! steps, and every state has its exact tangent stiffnesses.
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
//!     let contact = state?.contact;
//!     println!("{} nodes carry {} N", contact.contact_nodes, contact.load);
//! }
//! let pressure = path.fields()?.pressure; // at exactly 100 MPa
//! # assert!(pressure.max() > 100e6);
//! # Ok(())
//! # }
//! ```
//!
//! # Where to find it
//!
//! | task | items |
//! |---|---|
//! | follow the loading path | [`loading`]: [`LoadingSolver`], an iterator of [`LoadingState`]; [`History`](loading::History) reads it at any load |
//! | solve for one load, or for a sweep of loads | [`fixed_load`]: [`FixedLoadSolver`] |
//! | contact patches, percolation and sealing, distributions | [`patches`] |
//! | how much leaks through the gap | [`leak`] |
//! | contact conductance, tables for finite elements | [`joint`] |
//! | read the file of an instrument | [`io::read_surface`], [`surface::Topography`] |
//! | use heights from a matrix or a formula | [`HeightMap`], the trait [`Surface`] |
//! | generate surfaces and simple shapes | [`SelfAffine`], [`surface`] |
//! | save a path and continue it | [`record`] |
//! | the modulus of two bodies, typical materials | [`composite_modulus`], [`material`] |
//! | surfaces that stick: pull-off force, both branches | [`adhesion`] |
//! | shear a joint: partial slip, stiffness, dissipation | [`slip`] |
//! | viscoelastic bodies: creep, relaxation, cycles | [`creep`] |
//! | stress below the surface: where it is greatest, the load of first yield | [`stress`] |
//! | superpose increments of a path | [`bed`] |
//! | choose the half-space | [`kernel`]: [`Boussinesq`] for a body of finite size, whose edge is real; [`PeriodicBoussinesq`] for a piece of a larger surface, [`SemiPeriodicBoussinesq`] for one that repeats along one side; [`Spectral`] to compare with tamaas and ContactMechanics; [`Layered`] for coats, thin and graded bodies |
//! | write a kernel | the trait [`InfluenceKernel`], and [`kernel::check()`] |
//! | limit memory and time | [`updater`], and the trait [`LinearUpdater`] |
//! | displacements of given pressures | [`convolution`] |
//! | states, what a path may end at, fields, certificates | [`contact`] |
//! | what looks wrong and is allowed | [`Warning`] |
//! | compare with closed forms | [`reference`](mod@reference) |
//!
//! Grids, heights, files, statistics and generators ([`surface`], [`io`]) are a crate of their own,
//! `asperity-surfaces`, for those who need no solver. All of it is exported here; its errors ([`SurfaceError`]) are
//! [`Error::Surface`].
//!
//! # Conventions
//!
//! * **Units**: any coherent system; the documentation uses SI. `E* = E / (1 − ν²)` against a rigid body, or
//!   `1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂` ([`composite_modulus`]); no factor 2.
//! * **Heights** are positive towards the half-space: the highest node touches first. Only differences of heights
//!   matter. Two rough bodies are equivalent to one body with the sum of their heights ([`Surface::plus`]).
//! * **Pressure** is positive in compression; without adhesion it is never negative. **Displacement** is positive into the half-space,
//!   **gap** positive where the surfaces are apart.
//! * **Approach** δ is measured from first touch, where it is 0, and grows with the load; on a periodic half-space it is
//!   that of the mean planes. Surfaces that stick are pulled apart at negative ones.
//! * **State n** is the n-th event: where no node leaves or yields, the instant at which the n-th node touches; the
//!   pressure on that node is still zero. Stiffnesses
//!   are derivatives on further loading: `contact_stiffness` is dW/dδ (`None` on a periodic half-space, which has no
//!   distant point at rest), `interfacial_stiffness` is −dW/d(mean gap).
//! * **Area** is counted in cells. A fraction of the nominal area runs from 0 to 1.
//! * **Arrays** are nx × ny [`nalgebra`] matrices: element `[(ix, iy)]` is the node at `x = (ix + ½) dx`,
//!   `y = (iy + ½) dy`. x is the first index; an image `[row, column]` must be transposed.
//! * **Boundary**: the kernel says what surrounds the grid ([`Boundary`]). There is no default.
//!
//! # What a path costs
//!
//! A *kernel* gives the displacement of a node under a unit pressure on another, an *updater* solves with the matrix of
//! the nodes in contact, from a *factor* of it or by iterations. *The paper* is X. Zhang, Y. Zhang, Z. Jin, Friction 8
//! (2020) 970–981; `docs` is a folder of the repository.
//!
//! A Cholesky factor of n nodes in contact takes 4n² bytes and n³/3 floating-point operations at the speed of a matrix
//! product; nodes out of contact cost little. When the rest of the path is cheaper with iterations, from some 6800
//! nodes in contact on a grid of 256 × 256, the path continues without a factor. Memory is then proportional to the
//! grid, and states between two exact solutions carry an estimate of their error ([`loading`]). Results are bit for bit
//! the same with any number of threads, and without the feature `rayon`.
//!
//! # Features
//!
//! | feature | default | |
//! |---|---|---|
//! | `io` | yes | files of instruments, and records of paths on disk; without it surfaces are read from NumPy files only |
//! | `rayon` | yes | threads; they change no result by a single bit |
//! | `serde` | with `io` | grids, states, certificates, solutions and records of loading as data of any format that serde knows |
//!
//! # Limits of the model
//!
//! Contact is frictionless, without adhesion unless that is asked for ([`adhesion`]), and slopes are small. It is
//! elastic unless a hardness is given ([`LoadingBuilder::hardness`](loading::LoadingBuilder::hardness)): compare the
//! greatest pressure with it. With a hardness or adhesion unloading does not retrace loading.

#![warn(missing_debug_implementations)]
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod adhesion;
pub mod bed;
mod cell_response;
mod clock;
pub mod contact;
pub mod convolution;
pub mod creep;
mod elasticity;
mod error;
pub mod fixed_load;
mod hardness;
pub mod joint;
pub mod kernel;
mod krylov;
pub mod leak;
pub mod loading;
pub mod material;
mod memory;
pub mod patches;
mod problem;
pub mod record;
pub mod reference;
#[cfg(test)]
mod send_and_sync;
pub mod slip;
pub mod stress;
#[cfg(test)]
mod test_chain;
mod tied_events;
pub mod updater;
mod warning;

#[doc(hidden)]
pub use asperity_surfaces::number;
pub(crate) use asperity_surfaces::parallel;
pub use asperity_surfaces::{
    Error as SurfaceError, FileError, Grid, HeightMap, SelfAffine, Surface, io, nalgebra, surface,
};

pub use contact::{Certificate, ContactState, ContactTarget};
pub use elasticity::{composite_modulus, plane_strain_modulus};
pub use error::{
    AdhesionError, BedError, CreepError, Error, JointError, KernelError, SlipError, StressError,
    UpdaterError,
};
pub use fixed_load::{FixedLoadSolution, FixedLoadSolver};
pub use kernel::{
    Boundary, Boussinesq, ContactGrowth, InfluenceKernel, KernelTable, Layered, MeanDisplacement,
    PeriodicBoussinesq, SemiPeriodicBoussinesq, Spectral,
};
pub use loading::{ContactEvent, ContactRule, LoadingPath, LoadingSolver, LoadingState};
pub use problem::Problem;
pub use updater::{LinearUpdater, RecursiveCholesky};
pub use warning::Warning;

/// Compiles and runs the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The same of the page that the package has instead.
#[cfg(doctest)]
#[doc = include_str!("../docs/crate.md")]
struct CratePage;

/// The same of the page that leads from a file to its contact.
#[cfg(all(doctest, feature = "io"))]
#[doc = include_str!("../docs/from_file_to_contact.md")]
struct FromFileToContact;
