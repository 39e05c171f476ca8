#![doc = include_str!("../README.md")]
//!
//! # The picture
//!
//! Contact area, approach, mean gap and both stiffnesses against load, as the main job draws them:
//!
#![doc = "<style>.docblock svg { max-width: 100%; height: auto; }</style>\n"]
#![doc = include_str!("../docs/images/loading_curve.svg")]

pub mod contact;
pub mod convolution;
mod elasticity;
mod error;
pub mod fixed_load;
mod grid;
pub mod io;
pub mod kernel;
mod krylov;
pub mod loading;
mod memory;
mod parallel;
mod problem;
pub mod reference;
pub mod surface;
pub mod updater;

pub use contact::{Certificate, ContactState, ContactTarget};
pub use elasticity::{composite_modulus, plane_strain_modulus};
pub use error::Error;
pub use fixed_load::{FixedLoadSolution, FixedLoadSolver};
pub use grid::Grid;
pub use kernel::{
    Boundary, Boussinesq, ContactGrowth, InfluenceKernel, KernelTable, MeanDisplacement,
    PeriodicBoussinesq, Spectral,
};
pub use loading::{ContactEvent, ContactRule, LoadingSolver, LoadingState};
pub use problem::Problem;
pub use surface::{HeightMap, SelfAffine, Surface};
