//! Rough surfaces: files of instruments, what is done to a measurement before it is used, statistics, and generators.
//!
//! ```no_run
//! use asperity_surfaces::io::read_surface;
//! use asperity_surfaces::surface::Trend;
//!
//! # fn main() -> Result<(), asperity_surfaces::Error> {
//! let measured = read_surface("ground.sur")?;
//! println!("{measured}"); // format, nodes, sides, missing nodes
//! let surface = measured.fill_missing()?.topography()?.level(Trend::Plane)?;
//! println!("Sq = {} m", surface.map().rms_height());
//! println!("rms gradient = {}", surface.rms_gradient());
//! # Ok(())
//! # }
//! ```
//!
//! # Where to find it
//!
//! | question | answer |
//! |---|---|
//! | a file of my instrument | [`io::read_surface`], and [`io::ReadOptions`] for what it leaves open |
//! | bytes that are not in a file | [`io::ReadOptions::read_bytes`], [`io::ReadOptions::read_from`] |
//! | missing nodes | [`surface::fill_missing`] |
//! | level, crop, filter, resample | [`surface::Topography`] |
//! | statistics of heights and slopes, spectra, texture, profiles | [`HeightMap`], [`surface::Topography`] |
//! | generated surfaces and shapes | [`SelfAffine`], [`surface`] |
//! | my own surface | the trait [`Surface`] |
//! | what looks wrong with a surface | [`Warning`] |
//!
//! Contact of such surfaces is computed by the crate `asperity`, which exports all of this one.
//!
//! # Conventions
//!
//! * **Units**: metres; the [`io`] readers convert.
//! * **Heights** are positive towards the other body: out of the material.
//! * **Arrays** are nx × ny [`nalgebra`] matrices: element `[(ix, iy)]` is the node at `x = (ix + ½) dx`,
//!   `y = (iy + ½) dy`. x is the first index; an image `[row, column]` must be transposed.
//! * Results are the same bit for bit with any number of threads, and without the feature `rayon`.
//!
//! # Features
//!
//! | feature | default | |
//! |---|---|---|
//! | `io` | yes | files of instruments; without it only NumPy's |
//! | `rayon` | yes | threads; they change no result by a single bit |
//! | `serde` | no | grids as data of any format that serde knows |

#![cfg_attr(docsrs, feature(doc_cfg))]

#[macro_use]
mod getters;
mod error;
mod grid;
pub mod io;
#[doc(hidden)]
pub mod number;
#[doc(hidden)]
pub mod parallel;
pub mod surface;

pub use nalgebra;

pub use error::{Error, FileError};
pub use grid::Grid;
pub use surface::{HeightMap, SelfAffine, Surface, Warning};

/// Compiles and runs the code of the README.
#[cfg(all(doctest, feature = "io"))]
#[doc = include_str!("../README.md")]
struct Readme;
